// Charts beside the picture, with the time that is shown as a line in each: a click goes to another time.

import uPlot from "uplot";
import { number, scaled } from "stickslip/colors";

const HEIGHT = 150; // pixels
const COLORS = ["#1f5fa8", "#c0562b", "#2f8555", "#7d4f9e", "#b08a1e", "#9c1c3c", "#4a5560", "#258a94", "#000000"];
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
const MOMENTA = [
    ["px", "py", "pz"],
    ["lx", "ly", "lz"],
];
// What a body has through time, in groups that share an axis.
export const OF_BODY = {
    velocity: ["m/s", "vx", "vy", "vz"],
    position: ["m", "x", "y", "z"],
    spin: ["rad/s", "wx", "wy", "wz"],
    energy: ["J", "kinetic", "strain"],
};

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
            moving.map((name) => [name.replace("_", " "), table[name]]),
        );
        const [linear, angular] = MOMENTA;
        const shown = this.dimension === 2 ? linear.slice(0, 2) : linear;
        this.#put(
            "momentum",
            "Momentum",
            "kg m/s",
            table.time,
            shown.map((name) => [name, table[name]]),
        );
        this.angular = angular;
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
        for (const { plot } of this.figures.values()) plot?.redraw(false);
    }

    // `onGroup(group)` is called when the reader wants another group of a body's columns.
    #put(id, title, unit, time, series, group) {
        let figure = this.figures.get(id);
        if (!figure) {
            const element = document.createElement("figure");
            element.dataset.chart = id;
            this.box.append(element);
            figure = { element };
            this.figures.set(id, figure);
            // The others make room for it.
            this.#resize();
        }
        figure.plot?.destroy();
        figure.element.replaceChildren();
        const size = Math.max(...series.flatMap(([, values]) => values.map(Math.abs)).filter(Number.isFinite), 0);
        const scale = scaled(unit, size);
        const caption = document.createElement("figcaption");
        caption.textContent = scale.unit ? `${title} [${scale.unit}]` : title;
        if (group) caption.append(this.#groups(group));
        figure.element.append(caption);
        const options = {
            width: this.#width(),
            height: HEIGHT,
            legend: { live: false },
            cursor: { points: { show: false }, drag: { x: false, y: false } },
            scales: { x: { time: false } },
            axes: [
                {
                    size: 26,
                    font: "11px system-ui",
                    values: (_, ticks) => ticks.map((value) => number(value)),
                    grid: { stroke: "#eceef1" },
                },
                {
                    size: 52,
                    font: "11px system-ui",
                    values: (_, ticks) => ticks.map((value) => number(value)),
                    grid: { stroke: "#eceef1" },
                },
            ],
            series: [
                {},
                ...series.map(([label], i) => ({
                    label,
                    stroke: COLORS[i % COLORS.length],
                    width: 1.5,
                    points: { show: time.length < 3 },
                })),
            ],
            hooks: { draw: [(plot) => this.#line(plot)] },
        };
        const data = [time, ...series.map(([, values]) => values.map((value) => value / scale.factor))];
        figure.plot = new uPlot(options, data, figure.element);
        figure.plot.over.addEventListener("click", (event) => this.onTime(figure.plot.posToVal(event.offsetX, "x")));
    }

    #groups(group) {
        const select = document.createElement("select");
        select.setAttribute("aria-label", "what of the body");
        for (const name of Object.keys(OF_BODY)) select.append(new Option(name, name, false, name === group));
        select.onchange = () => this.onGroup?.(select.value);
        return select;
    }

    #line(plot) {
        const x = plot.valToPos(this.time, "x", true);
        const { left, top, width, height } = plot.bbox;
        if (x < left - 1 || x > left + width + 1) return;
        plot.ctx.save();
        plot.ctx.strokeStyle = "#b3261e";
        plot.ctx.lineWidth = 1.5;
        plot.ctx.beginPath();
        plot.ctx.moveTo(x, top);
        plot.ctx.lineTo(x, top + height);
        plot.ctx.stroke();
        plot.ctx.restore();
    }

    #width() {
        const count = Math.max(this.figures.size, 2);
        return Math.max(160, (this.box.clientWidth - 16) / count - 4);
    }

    #resize() {
        for (const { plot } of this.figures.values()) plot?.setSize({ width: this.#width(), height: HEIGHT });
    }
}
