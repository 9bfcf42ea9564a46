// Charts beside the picture, with the time that is shown as a line in each: a click goes to another time.

import uPlot from "uplot";
import { number, scaled, withUnit } from "stickslip/colors";

const HEIGHT = 164; // pixels
const FONT = "11px system-ui";
const COLORS = ["#1f5fa8", "#c0562b", "#2f8555", "#7d4f9e", "#b08a1e", "#9c1c3c", "#c2699a", "#258a94", "#000000"];
const ENERGIES = [
    "kinetic",
    "strain",
    "potential",
    "friction",
    "adhesion",
    "plastic",
    "damping",
    "external_work",
    "total",
];
const MOMENTA = ["px", "py", "pz"];
// What a body has through time, in groups that share an axis.
const OF_BODY = {
    velocity: ["m/s", "vx", "vy", "vz"],
    position: ["m", "x", "y", "z"],
    spin: ["rad/s", "wx", "wy", "wz"],
    energy: ["J", "kinetic", "strain"],
};
// What is held by a metre of depth in the plane.
const BY_DEPTH = { J: "J/m", "kg m/s": "kg m/s per m" };

export class Charts {
    constructor(box, { onTime, dimension }) {
        this.box = box;
        this.onTime = onTime;
        this.dimension = dimension;
        this.figures = new Map();
        this.time = 0;
        new ResizeObserver(() => this.#resize()).observe(box);
    }

    energy(table) {
        const moving = ENERGIES.filter((name) => table[name]?.some((value) => value !== 0));
        this.#put(
            "energy",
            "Energy",
            "J",
            table.time,
            moving.map((name) => [name.replace("_", " "), table[name], COLORS[ENERGIES.indexOf(name)]]),
        );
        const shown = this.dimension === 2 ? MOMENTA.slice(0, 2) : MOMENTA;
        this.#put(
            "momentum",
            "Momentum",
            "kg m/s",
            table.time,
            shown.map((name) => [name, table[name]]),
        );
    }

    // A body's table; `group` is a key of OF_BODY.
    body(name, table, group) {
        const [unit, ...columns] = OF_BODY[group];
        const moving = columns.filter((column) => table[column]?.some((value) => value !== 0));
        const chosen = moving.length > 0 ? moving : columns.slice(0, 1);
        this.#put(
            "history",
            name,
            unit,
            table.time,
            chosen.map((column) => [column, table[column]]),
            group,
        );
    }

    particle(name, { time, value }, quantity) {
        this.#put("history", name, quantity.unit, time, [[quantity.label, value]]);
    }

    // The time that the picture shows.
    at(time) {
        this.time = time;
        for (const { plot, now } of this.figures.values()) if (plot) this.#mark(plot, now);
    }

    // `onGroup(group)` is called when the reader wants another group of a body's columns.
    #put(id, title, unit, time, series, group) {
        let figure = this.figures.get(id);
        if (!figure) {
            const element = document.createElement("figure");
            element.dataset.chart = id;
            this.box.append(element);
            figure = { element, hidden: new Set() };
            this.figures.set(id, figure);
            // The others make room for it.
            this.#resize();
        }
        figure.plot?.destroy();
        figure.element.replaceChildren();
        const size = Math.max(...series.flatMap(([, values]) => values.map(Math.abs)).filter(Number.isFinite), 0);
        const scale = scaled((this.dimension === 2 && BY_DEPTH[unit]) || unit, size);
        const clock = scaled("s", Math.abs(time.at(-1) ?? 0));
        const [readout, now] = ["readout", "now"].map((className) => {
            return Object.assign(document.createElement("div"), { className, hidden: true });
        });
        const caption = document.createElement("figcaption");
        caption.textContent = scale.unit ? `${title} [${scale.unit}]` : title;
        if (group) caption.append(this.#groups(group));
        figure.element.append(caption);
        const options = {
            width: this.#width(),
            height: HEIGHT,
            legend: { live: false },
            pxAlign: 0,
            cursor: { points: { show: false }, drag: { x: false, y: false } },
            scales: { x: { time: false } },
            axes: [
                { ...axis(26, clock.factor), label: `time [${clock.unit}]`, labelSize: 17, labelFont: FONT },
                axis(52, 1),
            ],
            series: [
                {},
                ...series.map(([label, , color], i) => ({
                    label,
                    show: !figure.hidden.has(label),
                    stroke: color ?? COLORS[i % COLORS.length],
                    width: 1.5,
                    points: { show: time.length < 3 },
                })),
            ],
            hooks: {
                draw: [(plot) => this.#mark(plot, now)],
                setCursor: [(plot) => tell(plot, readout, scale.unit)],
                setSeries: [(plot) => remember(plot, figure.hidden)],
            },
        };
        const data = [time, ...series.map(([, values]) => values.map((value) => value / scale.factor))];
        figure.plot = new uPlot(options, data, figure.element);
        figure.now = now;
        figure.plot.over.append(now, readout);
        figure.plot.over.addEventListener("click", (event) => this.onTime(figure.plot.posToVal(event.offsetX, "x")));
    }

    #groups(group) {
        const select = document.createElement("select");
        select.setAttribute("aria-label", "what of the body");
        for (const name of Object.keys(OF_BODY)) select.append(new Option(name, name, false, name === group));
        select.onchange = () => this.onGroup?.(select.value);
        return select;
    }

    // An element of its own, so that a chart need not be drawn anew for each frame.
    #mark(plot, now) {
        const x = plot.valToPos(this.time, "x");
        now.hidden = !(x >= -1 && x <= plot.over.clientWidth + 1);
        now.style.transform = `translateX(${x}px)`;
    }

    #width() {
        const count = Math.max(this.figures.size, 2);
        return Math.max(160, (this.box.clientWidth - 16) / count - 4);
    }

    #resize() {
        for (const { plot } of this.figures.values()) plot?.setSize({ width: this.#width(), height: HEIGHT });
    }
}

function axis(size, factor) {
    const values = (_, ticks) => ticks.map((value) => number(value / factor));
    return { size, font: FONT, values, grid: { stroke: "#eceef1" } };
}

// Says beside the pointer what the curves have there.
function tell(plot, readout, unit) {
    const { idx, left, top } = plot.cursor;
    readout.hidden = !(idx >= 0 && left >= 0);
    if (readout.hidden) return;
    const line = (text, color) => {
        const element = document.createElement("div");
        [element.textContent, element.style.color] = [text, color];
        return element;
    };
    const shown = plot.series.map((series, i) => ({ series, value: plot.data[i][idx] })).slice(1);
    readout.replaceChildren(
        line(withUnit(plot.data[0][idx], "s"), "inherit"),
        ...shown
            .filter(({ series }) => series.show)
            .map(({ series, value }) => line(`${series.label} ${number(value)} ${unit}`, series.stroke())),
    );
    const { offsetWidth: width, offsetHeight: height } = plot.over;
    readout.style.left = left < 0.5 * width ? `${left + 12}px` : "";
    readout.style.right = left < 0.5 * width ? "" : `${width - left + 12}px`;
    readout.style.top = `${Math.max(0, Math.min(top - 8, height - readout.offsetHeight))}px`;
}

// Which curves the reader has put away, for a table that grows.
function remember(plot, hidden) {
    for (const { label, show } of plot.series.slice(1)) show ? hidden.delete(label) : hidden.add(label);
}
