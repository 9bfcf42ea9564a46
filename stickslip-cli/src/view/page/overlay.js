// What is drawn over the picture without being part of it: axes, a scale bar, and a ring around the picked particle.

import { Vector3 } from "three";
import { roundBelow, withUnit } from "stickslip/colors";

const AXES = [
    ["x", "#c0392b"],
    ["y", "#2f8555"],
    ["z", "#1f5fa8"],
];
// Pixels: an axis, the longest scale bar, and the ring's radius.
const [ARM, BAR, RING] = [28, 130, 9];
const MARGIN = 44;
const FONT = '12px system-ui, "DejaVu Sans", sans-serif';

export class Overlay {
    // `picked()` is the place of the picked particle [m], if there is one to be seen.
    constructor(canvas, stage, picked) {
        Object.assign(this, { canvas, stage, picked });
    }

    // Draws anew, as the camera stands now.
    draw() {
        const { canvas, stage } = this;
        const [width, height] = stage.size;
        const ratio = Math.min(window.devicePixelRatio, 2);
        [canvas.width, canvas.height] = [ratio * width, ratio * height];
        const context = canvas.getContext("2d");
        context.scale(ratio, ratio);
        Object.assign(context, { font: FONT, lineWidth: 2, lineCap: "round", textBaseline: "middle" });
        context.textAlign = "center";
        stage.camera.updateMatrixWorld();
        this.#axes(context, height - MARGIN);
        this.#scale(context, height - 18);
        this.#ring(context);
    }

    // Those that point away from the eye first.
    #axes(context, below) {
        const { stage } = this;
        const seen = AXES.slice(0, stage.plane ? 2 : 3).map(([name, color], axis) => {
            const along = new Vector3().setComponent(axis, 1).transformDirection(stage.camera.matrixWorldInverse);
            return { name, color, along };
        });
        seen.sort((a, b) => a.along.z - b.along.z);
        for (const { name, color, along } of seen) {
            const tip = [MARGIN + ARM * along.x, below - ARM * along.y];
            context.strokeStyle = context.fillStyle = color;
            context.beginPath();
            context.moveTo(MARGIN, below);
            context.lineTo(...tip);
            context.stroke();
            // An axis that points at the eye has its letter beside it.
            const off = Math.hypot(along.x, along.y) < 0.2 ? [9, -9] : [10 * along.x, -10 * along.y];
            halo(context, name, tip[0] + off[0], tip[1] + off[1]);
        }
    }

    // In space it holds at the distance of what is looked at.
    #scale(context, at) {
        const { stage } = this;
        const length = roundBelow(BAR * stage.metresPerPixel);
        const pixels = length / stage.metresPerPixel;
        if (!(pixels > 1)) return;
        const left = 2 * MARGIN + 24;
        context.strokeStyle = context.fillStyle = "#22262b";
        context.beginPath();
        for (const x of [left, left + pixels]) {
            context.moveTo(x, at - 4);
            context.lineTo(x, at + 4);
        }
        context.moveTo(left, at);
        context.lineTo(left + pixels, at);
        context.stroke();
        halo(context, withUnit(length, "m"), left + 0.5 * pixels, at - 12);
    }

    #ring(context) {
        const place = this.picked();
        const at = place && this.stage.onScreen(place);
        if (!at) return;
        for (const [color, width] of [
            ["#ffffff", 4],
            ["#111111", 2],
        ]) {
            [context.strokeStyle, context.lineWidth] = [color, width];
            context.beginPath();
            context.arc(...at, RING, 0, 2 * Math.PI);
            context.stroke();
        }
    }
}

// Text that is legible over any colour.
function halo(context, text, x, y) {
    const { strokeStyle, lineWidth } = context;
    [context.strokeStyle, context.lineWidth] = ["#ffffffd0", 4];
    context.lineJoin = "round";
    context.strokeText(text, x, y);
    context.fillText(text, x, y);
    [context.strokeStyle, context.lineWidth] = [strokeStyle, lineWidth];
}
