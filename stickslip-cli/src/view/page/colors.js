// Colours of values and of bodies, and numbers as a reader wants them.

const PREFIXES = [
    [1e9, "G"],
    [1e6, "M"],
    [1e3, "k"],
    [1, ""],
    [1e-3, "m"],
    [1e-6, "µ"],
    [1e-9, "n"],
];

// The prefix of a unit in which numbers up to `size` read well: its factor, and the unit with it.
export function scaled(unit, size) {
    const takes = unit !== "" && !unit.includes("^") && !unit.startsWith("kg") && size > 0 && Number.isFinite(size);
    const [factor, prefix] = (takes && PREFIXES.find(([factor]) => size >= 0.9999 * factor)) || [1, ""];
    return { factor, unit: prefix + unit };
}

export function number(value, digits = 4) {
    if (!Number.isFinite(value)) return "none";
    if (value === 0) return "0";
    const size = Math.abs(value);
    const text = size >= 1e5 || size < 1e-3 ? value.toExponential(digits - 1) : value.toPrecision(digits);
    return text
        .replace(/(\.\d*?)0+($|e)/, "$1$2")
        .replace(/\.($|e)/, "$1")
        .replace("e+", "e");
}

export function withUnit(value, unit) {
    const scale = scaled(unit, Math.abs(value));
    return `${number(value / scale.factor)} ${scale.unit}`.trim();
}

// The largest of 1, 2, 5, 10 and so on up to a size.
export function roundBelow(size) {
    const power = 10 ** Math.floor(Math.log10(size) + 1e-9);
    return power * [5, 2, 1].find((step) => step * power <= size * 1.0001);
}

// Round numbers between two ends, some five of them.
export function ticks(low, high) {
    const rough = (high - low) / 5;
    if (!(rough > 0)) return [low];
    const power = 10 ** Math.floor(Math.log10(rough));
    const step = power * [1, 2, 2.5, 5, 10].find((step) => step * power >= rough * 0.999);
    const found = [];
    for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; i++) found.push(i * step);
    return found;
}

// Pixels of a colour map, 256 of them in RGBA, from hexadecimal colours at even distances.
export function mapPixels(colors) {
    const known = colors.map((color) => [0, 2, 4].map((at) => parseInt(color.slice(at, at + 2), 16)));
    const pixels = new Uint8Array(4 * 256);
    for (let i = 0; i < 256; i++) {
        const place = (i / 255) * (known.length - 1);
        const [low, share] = [Math.min(Math.floor(place), known.length - 2), place % 1];
        const t = place === known.length - 1 ? 1 : share;
        for (let k = 0; k < 3; k++) pixels[4 * i + k] = known[low][k] * (1 - t) + known[low + 1][k] * t;
        pixels[4 * i + 3] = 255;
    }
    return pixels;
}

export function css([red, green, blue]) {
    return `rgb(${[red, green, blue].map((part) => Math.round(255 * part)).join(" ")})`;
}
