// Velocities of an even selection of the particles in sight, as arrows over the picture.

import { Arrows } from "stickslip/arrows";

const MOST = 700; // arrows
const LONGEST = 0.08; // of the diagonal of everything
const WEAKEST = 0.02; // of the fastest
const COLOR = 0x17202a;
const COMPONENTS = ["velocity.x", "velocity.y", "velocity.z"];

export class Velocities {
    constructor(stage, source, frames) {
        this.drawn = new Arrows(stage);
        this.frames = frames;
        this.areThere = COMPONENTS.every((id) => source.has(`/column/0/${id}`));
    }

    clear() {
        this.drawn.clear();
    }

    // Draws those of the particles of a list in a frame, and gives the speed that the longest arrow stands for [m/s].
    // `isShown()` says whether the frame is still the one that is shown; `size` is that of the box of everything [m].
    async show(frame, { places, list, size, isShown }) {
        const columns = await Promise.all(COMPONENTS.map((id) => this.frames.column(frame, id)));
        if (!isShown()) return undefined;
        const step = Math.max(1, Math.floor(list.length / MOST));
        const chosen = [];
        for (let i = 0; i < list.length; i += step) {
            const along = columns.map(({ values }) => values[list[i]]);
            chosen.push({ particle: list[i], along, speed: Math.hypot(...along) });
        }
        const fastest = chosen.reduce((most, { speed }) => (speed > most ? speed : most), 0);
        const scale = (LONGEST * size) / fastest;
        const vectors = chosen
            .filter(({ speed }) => speed > WEAKEST * fastest)
            .map(({ particle, along }) => ({
                at: places.position(particle),
                along: along.map((part) => scale * part),
            }));
        this.drawn.clear();
        this.drawn.arrows(vectors, COLOR);
        return fastest;
    }
}
