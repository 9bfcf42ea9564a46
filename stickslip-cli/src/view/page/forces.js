// Forces between bodies over the picture: chains from centre to centre through the contact, and arrows at the contact.

import { Arrows } from "stickslip/arrows";

// Half the width of the widest chain and the length of the longest arrow, as shares of the diagonal of everything.
const [WIDEST, LONGEST] = [0.008, 0.12];
const WEAKEST = 0.004;
const [CHAINS, ARROWS] = [0x9c1c3c, 0x1d3557];

export class Forces {
    constructor(stage) {
        this.drawn = new Arrows(stage);
    }

    clear() {
        this.drawn.clear();
    }

    // Draws what `told` says of the contacts; `size` is that of the box in which everything lies [m].
    show(told, places, { chains, arrows, shown, rigid, size }) {
        const { drawn } = this;
        drawn.clear();
        const centers = places.centers();
        const inSight = told.contacts.filter(({ a, b }) => shown(a) || shown(b));
        const links = [];
        for (const { a, b, normal, at } of chains ? inSight : []) {
            const share = normal / told.largest;
            if (!(share > WEAKEST)) continue;
            for (const body of [a, b]) {
                // The middle of a wall is nowhere near the force.
                if (rigid[body] || !centers.has(body)) continue;
                const from = drawn.local(centers.get(body));
                links.push({ from, to: drawn.local(at), width: Math.sqrt(share) * WIDEST * size });
            }
        }
        drawn.sticks(links, CHAINS);
        const vectors = [];
        for (const { force, at } of arrows ? inSight : []) {
            const strength = Math.hypot(...force);
            const share = strength / told.largest;
            if (!(share > WEAKEST)) continue;
            const scale = (Math.sqrt(share) * LONGEST * size) / strength;
            vectors.push({ at, along: force.map((part) => scale * part) });
        }
        drawn.arrows(vectors, ARROWS);
    }
}
