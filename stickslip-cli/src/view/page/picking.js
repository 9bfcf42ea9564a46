// Which particle is under the pointer: of those that are drawn there, the one nearest to the eye.

import { Matrix4 } from "three";

const REACH = 7; // pixels around the pointer in which a particle is taken

export function pick(cloud, x, y) {
    const { places, list, stage } = cloud;
    if (!places) return -1;
    const [width, height] = stage.size;
    const { camera, origin } = stage;
    camera.updateMatrixWorld();
    const m = new Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse).elements;
    const low = places.low.map((value, axis) => value - origin[axis]);
    const unit = places.extent.map((value) => value / 65535);
    const side = (camera.projectionMatrix.elements[5] * 0.5 * height * places.largest) / 16383;
    let [best, depth, off] = [-1, Infinity, Infinity];
    for (const i of list) {
        const data = places.data;
        const px = low[0] + unit[0] * data[4 * i];
        const py = low[1] + unit[1] * data[4 * i + 1];
        const pz = low[2] + unit[2] * data[4 * i + 2];
        const w = m[3] * px + m[7] * py + m[11] * pz + m[15];
        const dx = (0.5 + (0.5 * (m[0] * px + m[4] * py + m[8] * pz + m[12])) / w) * width - x;
        if (dx > 60 || dx < -60) continue;
        const dy = (0.5 - (0.5 * (m[1] * px + m[5] * py + m[9] * pz + m[13])) / w) * height - y;
        const radius = Math.max((0.74 * side * (data[4 * i + 3] >> 2)) / w, 1);
        const distance = Math.hypot(dx, dy);
        if (distance > radius + REACH || w < 0) continue;
        // Inside a ball, the nearest to the eye; beside all of them, the one least far off.
        const [far, z] = [Math.max(distance - radius, 0), stage.plane ? distance : w];
        if (far < off || (far === off && z < depth)) [best, depth, off] = [i, z, far];
    }
    return best;
}
