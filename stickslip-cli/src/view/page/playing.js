// Playing: the next frame when it is due and there.

const byId = (id) => document.getElementById(id);
const [PLAY, PAUSE] = ["▶\uFE0E", "❚❚"];

export class Playing {
    // `state` says which frame is wanted; `count()` of how many; `fetch(frame)` gets one, `show(frame)` shows it.
    constructor(state, { count, fetch, show, stage }) {
        Object.assign(this, { state, count, fetch, show, stage });
        state.playing = false;
        byId("play").onclick = () => (state.playing ? this.stop() : this.start());
    }

    async start() {
        const { state, stage } = this;
        if (state.playing || this.count() < 2) return;
        state.playing = true;
        byId("play").textContent = PAUSE;
        if (state.frame >= this.count() - 1) await this.show(0);
        let due = performance.now();
        while (state.playing) {
            due = Math.max(due + 1000 / Number(byId("rate").value), performance.now());
            const last = state.frame;
            const next = this.#after(last);
            if (next === undefined) break;
            await this.fetch(next).catch(() => {});
            await new Promise((resolve) => setTimeout(resolve, Math.max(0, due - performance.now())));
            if (!state.playing || state.frame !== last) continue;
            stage.move();
            await this.show(next);
            // The picture is drawn before the next one is made.
            await new Promise((resolve) => requestAnimationFrame(resolve));
        }
        this.stop();
    }

    #after(frame) {
        if (frame + 1 < this.count()) return frame + 1;
        return byId("loop").checked ? 0 : undefined;
    }

    stop() {
        this.state.playing = false;
        byId("play").textContent = PLAY;
        this.stage.ask();
    }
}
