// Where the page gets its data: from the server that it came from, or from what stands in the page itself.

export class Source {
    constructor() {
        this.embedded = new Map();
        for (const element of document.querySelectorAll("script[data-route]")) {
            this.embedded.set(element.dataset.route, element);
        }
    }

    // Whether a server stands behind it, which may have more to say later.
    get isLive() {
        return this.embedded.size === 0;
    }

    has(route) {
        return this.isLive || this.embedded.has(route);
    }

    async buffer(route) {
        return this.isLive ? this.#fetched(route) : this.#unpacked(route);
    }

    async json(route) {
        return JSON.parse(new TextDecoder().decode(await this.buffer(route)));
    }

    async #fetched(route) {
        const response = await fetch(route);
        if (!response.ok) throw new Error(await response.text());
        return response.arrayBuffer();
    }

    async #unpacked(route) {
        const element = this.embedded.get(route);
        if (!element) throw new Error(`this file does not hold ${route}`);
        const letters = atob(element.textContent);
        const packed = Uint8Array.from(letters, (letter) => letter.charCodeAt(0));
        const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
        return new Response(stream).arrayBuffer();
    }
}
