// The controls of colour and of cuts, and the bar that says what colours mean.

import { number, scaled, ticks, withUnit } from "stickslip/colors";

const byId = (id) => document.getElementById(id);
const STEPS = 1000;

export class ColorPanel {
    // `onQuantity()` when colour is to stand for something else, `onLook()` when only the colours change.
    constructor(index, { onQuantity, onLook, has }) {
        this.onLook = onLook;
        this.has = has;
        this.seen = new Map();
        this.take(index);
        for (const { name } of index.maps) byId("map").append(new Option(name, name));
        byId("quantity").onchange = () => {
            this.mapChosen = false;
            if (this.mode === "typed") byId("range").value = "seen";
            onQuantity();
        };
        byId("map").onchange = () => {
            this.mapChosen = true;
            onLook();
        };
        byId("range").onchange = () => onLook();
        for (const id of ["low", "high"]) {
            byId(id).onchange = () => {
                byId("range").value = "typed";
                onLook();
            };
        }
    }

    take(index) {
        this.index = index;
        const select = byId("quantity");
        const chosen = select.value;
        const offered = index.quantities.filter(({ id }) => this.has(id));
        const options = offered.map(({ id, label }) => new Option(label, id));
        select.replaceChildren(new Option("body", ""), ...options);
        select.value = offered.some(({ id }) => id === chosen) ? chosen : "";
        byId("left-out").textContent = index.left_out;
    }

    // What colour stands for; `undefined` for the bodies themselves.
    get quantity() {
        return this.index.quantities.find(({ id }) => id === byId("quantity").value);
    }

    get mode() {
        return byId("range").value;
    }

    set(id) {
        byId("quantity").value = id;
    }

    // The range of a column's colours and the colours themselves, by what the reader chose.
    look(column) {
        const { quantity } = this;
        byId("colorbar").hidden = !quantity;
        for (const id of ["map", "range", "low", "high"]) byId(id).disabled = !quantity;
        byId("unit").textContent = quantity ? quantity.unit : "";
        if (!quantity) return undefined;
        const seen = this.seen.get(quantity.id) ?? [Infinity, -Infinity];
        seen[0] = Math.min(seen[0], column.low);
        seen[1] = Math.max(seen[1], column.high);
        this.seen.set(quantity.id, seen);
        let range =
            this.mode === "typed" ? ["low", "high"].map((id) => Number(byId(id).value.replace(",", "."))) : undefined;
        if (!range || !(range[1] > range[0])) {
            if (range) byId("range").value = "seen";
            const ends = { frame: [column.low, column.high], inner: this.mode === "inner" && column.inner() };
            range = around(ends[this.mode] ?? seen, quantity.middle);
            [byId("low").value, byId("high").value] = range.map((value) => number(value, 5));
        }
        if (!this.mapChosen) byId("map").value = range[0] < 0 || quantity.middle !== null ? "blue-red" : "viridis";
        const map = this.index.maps.find(({ name }) => name === byId("map").value);
        return { range, colors: map.colors, quantity };
    }

    // Draws the bar beside the picture.
    bar(pixels, { range: [low, high], quantity }) {
        const scale = scaled(quantity.unit, Math.max(Math.abs(low), Math.abs(high)));
        byId("colorbar-title").textContent = scale.unit ? `${quantity.label} [${scale.unit}]` : quantity.label;
        const canvas = byId("colorbar").querySelector("canvas");
        const context = canvas.getContext("2d");
        const image = context.createImageData(16, 256);
        for (let y = 0; y < 256; y++) {
            for (let x = 0; x < 16; x++)
                image.data.set(pixels.subarray(4 * (255 - y), 4 * (255 - y) + 4), 4 * (16 * y + x));
        }
        context.putImageData(image, 0, 0);
        const marks = ticks(low / scale.factor, high / scale.factor).map((value) => {
            const mark = document.createElement("span");
            mark.textContent = number(value);
            mark.style.top = `${100 * (1 - (value * scale.factor - low) / (high - low))}%`;
            return mark;
        });
        byId("ticks").replaceChildren(...marks);
    }
}

// A range with the special value in its middle: zero where values have both signs.
function around([low, high], middle) {
    const center = middle ?? (low < 0 ? 0 : null);
    if (center === null) return high > 0 ? [Math.min(low, 0), high] : [0, 1];
    const half = Math.max(Math.abs(high - center), Math.abs(low - center)) || 1;
    return [center - half, center + half];
}

export class CutPanel {
    // Sliders for the part of each axis that is drawn, in the box of the first frame.
    constructor(dimension, onChange) {
        this.box = undefined;
        this.sliders = ["x", "y", "z"].slice(0, dimension).map((axis) => {
            const row = document.createElement("div");
            row.className = "cut";
            const words = document.createElement("output");
            row.append(axis);
            const ends = ["from", "to"].map((word, end) => {
                const slider = document.createElement("input");
                Object.assign(slider, { type: "range", min: 0, max: STEPS, value: end * STEPS });
                slider.setAttribute("aria-label", `${axis} ${word}`);
                slider.oninput = () => {
                    words.textContent = this.#words(axis);
                    onChange();
                };
                row.append(slider);
                return slider;
            });
            row.append(words);
            byId("cuts").append(row);
            return ends;
        });
    }

    // Between which values of each axis particles are drawn [m].
    get cuts() {
        return [0, 1, 2].map((axis) => {
            const ends = this.sliders[axis];
            if (!ends || !this.box) return { low: -Infinity, high: Infinity };
            const [first, last] = ends.map((slider) => Number(slider.value));
            const value = (step) => this.box.low[axis] + ((this.box.high[axis] - this.box.low[axis]) * step) / STEPS;
            return { low: first === 0 ? -Infinity : value(first), high: last === STEPS ? Infinity : value(last) };
        });
    }

    #words(axis) {
        const { low, high } = this.cuts[["x", "y", "z"].indexOf(axis)];
        const ends = [low > -Infinity && `from ${withUnit(low, "m")}`, high < Infinity && `to ${withUnit(high, "m")}`];
        return ends.filter(Boolean).join(" ");
    }
}
