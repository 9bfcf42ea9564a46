// Forces between bodies over the picture: chains from centre to centre through the contact, and arrows at the contact.

import { CylinderGeometry, Group, InstancedMesh, Matrix4, MeshBasicMaterial, Quaternion, Vector3 } from "three";

// Half the width of the widest chain and the length of the longest arrow, as shares of the diagonal of everything.
const [WIDEST, LONGEST] = [0.008, 0.12];
const WEAKEST = 0.004;
const UP = new Vector3(0, 1, 0);

export class Forces {
    constructor(stage) {
        this.stage = stage;
        this.group = new Group();
        this.group.renderOrder = 2;
        stage.scene.add(this.group);
        this.shaft = new CylinderGeometry(1, 1, 1, 8, 1).translate(0, 0.5, 0);
        this.head = new CylinderGeometry(0, 1, 1, 8, 1).translate(0, 0.5, 0);
    }

    clear() {
        for (const mesh of this.group.children) mesh.dispose();
        this.group.clear();
    }

    // Draws what `told` says of the contacts; `size` is that of the box in which everything lies [m].
    show(told, places, { chains, arrows, shown, rigid, size }) {
        this.clear();
        const local = (x) => new Vector3(...x.map((value, axis) => value - this.stage.origin[axis]));
        const centers = places.centers();
        const inSight = told.contacts.filter(({ a, b }) => shown(a) || shown(b));
        if (chains) {
            const links = [];
            for (const { a, b, normal, at } of inSight) {
                const share = normal / told.largest;
                if (!(share > WEAKEST)) continue;
                for (const body of [a, b]) {
                    // The middle of a wall is nowhere near the force.
                    if (rigid[body] || !centers.has(body)) continue;
                    links.push({
                        from: local(centers.get(body)),
                        to: local(at),
                        width: Math.sqrt(share) * WIDEST * size,
                    });
                }
            }
            this.#add(this.shaft, links, 0x9c1c3c);
        }
        if (arrows) {
            const heads = [];
            const shafts = [];
            for (const { force, at } of inSight) {
                const share = Math.hypot(...force) / told.largest;
                if (!(share > WEAKEST)) continue;
                const along = new Vector3(...force).normalize();
                const length = Math.sqrt(share) * LONGEST * size;
                const [from, to] = [local(at), local(at).addScaledVector(along, length)];
                const neck = from.clone().lerp(to, 0.7);
                shafts.push({ from, to: neck, width: 0.025 * length });
                heads.push({ from: neck, to, width: 0.09 * length });
            }
            this.#add(this.shaft, shafts, 0x1d3557);
            this.#add(this.head, heads, 0x1d3557);
        }
    }

    #add(geometry, pieces, color) {
        if (pieces.length === 0) return;
        const material = new MeshBasicMaterial({ color, depthTest: false, transparent: true, opacity: 0.85 });
        const mesh = new InstancedMesh(geometry, material, pieces.length);
        const [matrix, turn, along] = [new Matrix4(), new Quaternion(), new Vector3()];
        pieces.forEach(({ from, to, width }, i) => {
            along.subVectors(to, from);
            const length = along.length();
            turn.setFromUnitVectors(UP, along.normalize());
            matrix.compose(from, turn, new Vector3(width, length, width));
            mesh.setMatrixAt(i, matrix);
        });
        mesh.frustumCulled = false;
        mesh.renderOrder = 2;
        this.group.add(mesh);
    }
}
