// The list of bodies: which are drawn, and which one is looked at. Only the rows in sight are elements of the page, so
// ten thousand bodies are as quick as ten.

import { css } from "stickslip/colors";

const ROW = 22; // pixels

export class BodyList {
    // `onChange()` when other bodies are drawn, `onChoose(body)` when the reader wants one through time.
    constructor(index, { onChange, onChoose }) {
        this.onChange = onChange;
        this.onChoose = onChoose;
        this.hidden = new Set();
        this.chosen = -1;
        this.box = document.getElementById("bodies");
        this.inner = this.box.firstElementChild;
        this.search = document.getElementById("search");
        this.search.addEventListener("input", () => this.find());
        this.box.addEventListener("scroll", () => this.#draw());
        new ResizeObserver(() => this.#draw()).observe(this.box);
        document.getElementById("all").onclick = () => this.#set(true);
        document.getElementById("none").onclick = () => this.#set(false);
        this.take(index);
    }

    take(index) {
        this.index = index;
        this.find();
    }

    isShown(body) {
        return !this.hidden.has(body);
    }

    choose(body) {
        this.chosen = body;
        const row = this.found.indexOf(body);
        const top = row * ROW;
        const inside = top >= this.box.scrollTop && top + ROW <= this.box.scrollTop + this.box.clientHeight;
        if (row >= 0 && !inside) this.box.scrollTop = top - 0.4 * this.box.clientHeight;
        this.#draw();
    }

    find() {
        const wanted = this.search.value.trim().toLowerCase();
        const { bodies } = this.index;
        this.found = bodies.map((_, body) => body).filter((body) => bodies[body].toLowerCase().includes(wanted));
        document.getElementById("body-count").textContent =
            this.found.length === bodies.length ? `(${bodies.length})` : `(${this.found.length} of ${bodies.length})`;
        this.inner.style.height = `${ROW * this.found.length}px`;
        this.#draw();
    }

    // Those that the search has found.
    #set(shown) {
        for (const body of this.found) {
            if (shown) this.hidden.delete(body);
            else this.hidden.add(body);
        }
        this.#draw();
        this.onChange();
    }

    #draw() {
        const first = Math.max(0, Math.floor(this.box.scrollTop / ROW) - 2);
        const last = Math.ceil((this.box.scrollTop + this.box.clientHeight) / ROW) + 2;
        this.inner.replaceChildren(...this.found.slice(first, last).map((body, i) => this.#row(body, first + i)));
    }

    #row(body, place) {
        const { bodies, body_colors: colors, rigid } = this.index;
        const row = document.createElement("div");
        row.className = body === this.chosen ? "body chosen" : "body";
        row.style.top = `${ROW * place}px`;
        const box = document.createElement("input");
        box.type = "checkbox";
        box.checked = this.isShown(body);
        box.setAttribute("aria-label", `show ${bodies[body]}`);
        box.onchange = () => {
            if (box.checked) this.hidden.delete(body);
            else this.hidden.add(body);
            this.onChange();
        };
        const patch = document.createElement("i");
        patch.style.background = css(colors[body % colors.length]);
        const name = document.createElement("a");
        name.textContent = bodies[body];
        name.title = `${bodies[body]}: through time`;
        name.onclick = () => this.onChoose(body);
        row.append(box, patch, name);
        if (rigid[body]) {
            const note = document.createElement("small");
            note.textContent = "rigid";
            row.append(note);
        }
        return row;
    }
}
