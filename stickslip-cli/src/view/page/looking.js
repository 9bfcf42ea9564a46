// What the reader looks at closely: a particle or a body, what it has now, and what it had through time.

import { number, withUnit } from "stickslip/colors";
import { pick } from "stickslip/picking";

const byId = (id) => document.getElementById(id);

export class Looking {
    // `parts` are those of the page; `index()` is the newest list of what there is.
    constructor(parts, index) {
        Object.assign(this, parts);
        this.newest = index;
        this.group = "velocity";
        this.picked = undefined;
    }

    // Where the picked particle is [m], if it is in the frame that is shown, and its body is.
    place() {
        const { state, picked, bodies } = this;
        if (!picked || !state.places || !bodies.isShown(picked.body)) return undefined;
        const place = state.places.find(picked.body, picked.number);
        return place < 0 ? undefined : state.places.position(place);
    }

    // Says what the picked particle has in the frame that is shown.
    tell() {
        const { state, panel } = this;
        const box = byId("picked");
        box.hidden = !this.picked;
        this.stage.ask();
        if (!this.picked) return;
        const index = this.newest();
        const { body, number: particle } = this.picked;
        const heading = document.createElement("h3");
        heading.textContent = index.bodies[body];
        const list = document.createElement("dl");
        const row = (name, value) => {
            const [term, definition] = [document.createElement("dt"), document.createElement("dd")];
            [term.textContent, definition.textContent] = [name, value];
            list.append(term, definition);
        };
        const place = state.places.find(body, particle);
        row("particle", String(particle));
        if (place < 0) {
            row("", "not in this frame");
        } else {
            const x = state.places.position(place).slice(0, index.dimension);
            row("position", `${x.map((value) => number(value, 5)).join(", ")} m`);
            if (state.column) row(panel.quantity.label, withUnit(state.column.values[place], panel.quantity.unit));
            if (state.places.sidesKnown) row("size", withUnit(state.places.side(place), "m"));
        }
        const close = document.createElement("button");
        Object.assign(close, { className: "close", textContent: "×", title: "Close (Esc)" });
        close.onclick = () => this.drop();
        box.replaceChildren(heading, close, list, this.#buttons(body, particle));
    }

    #buttons(body, particle) {
        const [ofBody, ofParticle] = ["Body through time", "Particle through time"].map((text) => {
            const button = document.createElement("button");
            button.textContent = text;
            return button;
        });
        ofBody.onclick = () => this.atBody(body);
        ofParticle.onclick = () => this.atParticle(body, particle);
        ofParticle.disabled = !this.panel.quantity;
        ofParticle.title = this.panel.quantity ? "" : "choose a colour other than body first";
        const buttons = document.createElement("div");
        buttons.className = "row";
        buttons.append(ofBody, ofParticle);
        return buttons;
    }

    drop() {
        this.picked = undefined;
        this.bodies.choose(-1);
        this.tell();
    }

    // Picks what is at a place of the canvas.
    pickAt(x, y) {
        const { state } = this;
        const particle = pick(this.cloud, x, y);
        if (particle < 0) {
            this.drop();
            return undefined;
        }
        const { body } = state.places.run(particle);
        this.picked = { body, number: state.places.number(particle) };
        this.tell();
        this.atBody(body);
        return this.picked;
    }

    async atBody(body) {
        this.bodies.choose(body);
        try {
            const table = await this.source.json(`/body/${body}`);
            const name = this.newest().bodies[body];
            this.charts.onGroup = (group) => {
                this.group = group;
                this.charts.body(name, table, group);
            };
            this.charts.body(name, table, this.group);
        } catch (error) {
            byId("message").textContent = error.message;
        }
    }

    async atParticle(body, particle) {
        const { quantity } = this.panel;
        byId("message").textContent = "reading all frames ...";
        try {
            const history = this.source.isLive
                ? await this.source.json(`/particle/${body}/${particle}/${quantity.id}`)
                : await this.#throughFrames(body, particle, quantity.id);
            byId("message").textContent = "";
            this.charts.particle(`${this.newest().bodies[body]}, particle ${particle}`, history, quantity);
        } catch (error) {
            byId("message").textContent = error.message;
        }
    }

    // The same from frames that stand in the page.
    async #throughFrames(body, particle, id) {
        const history = { time: [], value: [] };
        for (const [frame, time] of this.newest().times.entries()) {
            const place = (await this.frames.places(frame)).find(body, particle);
            if (place < 0) continue;
            history.time.push(time);
            history.value.push((await this.frames.column(frame, id)).values[place]);
        }
        return history;
    }
}
