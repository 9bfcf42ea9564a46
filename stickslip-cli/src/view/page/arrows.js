// Sticks and arrows over the picture, many in one mesh.

import { CylinderGeometry, Group, InstancedMesh, Matrix4, MeshBasicMaterial, Quaternion, Vector3 } from "three";

// Shares of an arrow's length: half the width of its shaft and of its head, and where the head begins.
const [SHAFT, HEAD, NECK] = [0.025, 0.09, 0.7];
const UP = new Vector3(0, 1, 0);

export class Arrows {
    constructor(stage) {
        this.stage = stage;
        this.group = new Group();
        stage.scene.add(this.group);
        this.stick = new CylinderGeometry(1, 1, 1, 8, 1).translate(0, 0.5, 0);
        this.cone = new CylinderGeometry(0, 1, 1, 8, 1).translate(0, 0.5, 0);
    }

    clear() {
        for (const mesh of this.group.children) {
            mesh.material.dispose();
            mesh.dispose();
        }
        this.group.clear();
    }

    // A place [m] as a point of the scene that is drawn.
    local(place) {
        return new Vector3(...place.map((value, axis) => value - this.stage.origin[axis]));
    }

    // From a place [m] along a vector whose length is that of the arrow [m].
    arrows(list, color) {
        const [shafts, heads] = [[], []];
        for (const { at, along } of list) {
            const from = this.local(at);
            const vector = new Vector3(...along);
            const [length, to] = [vector.length(), from.clone().add(vector)];
            const neck = from.clone().lerp(to, NECK);
            shafts.push({ from, to: neck, width: SHAFT * length });
            heads.push({ from: neck, to, width: HEAD * length });
        }
        this.#add(this.stick, shafts, color);
        this.#add(this.cone, heads, color);
    }

    // From a point of the scene to another, with half of a width.
    sticks(list, color) {
        this.#add(this.stick, list, color);
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
