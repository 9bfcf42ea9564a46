// The page: what is chosen, and what follows from that.

import { BodyList } from "stickslip/bodies";
import { Charts } from "stickslip/charts";
import { Cloud } from "stickslip/cloud";
import { mapPixels, withUnit } from "stickslip/colors";
import { Frames } from "stickslip/frames";
import { Layers } from "stickslip/layers";
import { Looking } from "stickslip/looking";
import { measure } from "stickslip/measuring";
import { Overlay } from "stickslip/overlay";
import { ColorPanel, CutPanel } from "stickslip/panel";
import { Playing } from "stickslip/playing";
import { picture } from "stickslip/saving";
import { Skins } from "stickslip/skins";
import { Source } from "stickslip/source";
import { Stage } from "stickslip/stage";

const byId = (id) => document.getElementById(id);
const POLL = 1000; // ms
const AHEAD = 2; // frames that are fetched before they are shown
const STATUS = { running: "running", interrupted: "interrupted", out_of_time: "out of time", stopped: "stopped",
  failed: "failed" };

const source = new Source();
const frames = new Frames(source);
let index = await source.json("/index").catch(fail);
const stage = new Stage(byId("canvas"), index, (motion) => {
    cloud.prepare(motion);
    if (state.shown >= 0) overlay.draw();
});
const cloud = new Cloud(stage);
const skins = new Skins(stage, source, cloud.material.uniforms);
const panel = new ColorPanel(index, {
    onQuantity: () => show(state.frame),
    onLook: () => recolor(),
    has: (id) => source.has(`/column/0/${id}`),
});
const cuts = new CutPanel(index.dimension, () => choose(true));
const bodies = new BodyList(index, { onChange: () => choose(false), onChoose: (body) => looking.atBody(body) });
const charts = new Charts(byId("charts"), { onTime: (time) => show(nearest(time)), dimension: index.dimension });
const state = { frame: 0, shown: -1, pictures: 0 };
const parts = { state, source, frames, cloud, bodies, charts, panel, stage, skins };
const looking = new Looking(parts, () => index);
const layers = new Layers(parts, () => index, choosePieces);
const overlay = new Overlay(byId("overlay"), stage, () => looking.place());
const playing = new Playing(state, { stage, show, fetch: fetchFrame, count: () => index.times.length });

function fail(error) {
    byId("message").textContent = error.message ?? String(error);
    throw error;
}

function describe() {
    byId("title").textContent = index.title;
    document.title = `${index.title} - Stickslip`;
    const word = STATUS[index.status];
    byId("status").hidden = !word;
    byId("status").className = ["failed", "stopped"].includes(index.status) ? "bad" : "";
    byId("status").textContent = word ?? "";
    byId("time").max = Math.max(index.times.length - 1, 0);
    byId("follow-switch").hidden = !(source.isLive && index.status === "running");
    byId("sides").hidden = index.dimension === 2;
    layers.offer();
}

function nearest(time) {
    const off = (frame) => Math.abs(index.times[frame] - time);
    return index.times.reduce((best, _, frame) => (off(frame) < off(best) ? frame : best), 0);
}

// What the colours of a frame stand for: a column, or the bodies themselves.
function values(frame, places) {
    const { quantity } = panel;
    if (quantity) return frames.column(frame, quantity.id);
    if (!places.bodyColors) {
        places.bodyColors = new Float32Array(places.count);
        for (const { body, start, end } of places.runs)
            places.bodyColors.fill(body % index.body_colors.length, start, end);
    }
    return undefined;
}

// Shows a frame. If another one is wanted before it is there, that one is shown instead.
async function show(frame) {
    if (!(frame >= 0 && frame < index.times.length)) return;
    state.frame = frame;
    const { quantity } = panel;
    try {
        const [places, column] = await fetchFrame(frame);
        if (state.frame !== frame || panel.quantity !== quantity) return;
        draw(frame, places, column);
    } catch (error) {
        byId("message").textContent = error.message;
    }
}

function draw(frame, places, column) {
    const first = state.shown < 0;
    const other = state.places !== places;
    Object.assign(state, { shown: frame, places, column });
    if (first) begin(places);
    if (!column) values(frame, places);
    cloud.show(places, column ? column.values : places.bodyColors);
    if (other) choosePieces();
    recolor();
    byId("time").value = frame;
    byId("clock").textContent = `${withUnit(index.times[frame], "s")}   ${frame + 1} of ${index.times.length}`;
    byId("message").textContent = places.count === 0 ? "this frame has no particles" : "";
    charts.at(index.times[frame]);
    state.pictures += 1;
    layers.show();
    looking.tell();
    for (let ahead = 1; ahead <= AHEAD; ahead++) fetchAhead(frame + ahead);
}

// With the first frame it is known where everything is.
function begin(places) {
    const margin = 0.5 * places.largest;
    const low = places.low.map((value) => value - margin);
    const high = places.low.map((value, axis) => value + places.extent[axis] + margin);
    stage.origin = low.map((value, axis) => 0.5 * (value + high[axis]));
    state.box = { low, high, size: Math.hypot(...low.map((value, axis) => high[axis] - value)) };
    cuts.box = state.box;
    stage.fit(low, high, "oblique");
}

function fetchFrame(frame) {
    const { quantity } = panel;
    return Promise.all([frames.places(frame), quantity && frames.column(frame, quantity.id)]);
}

function fetchAhead(frame) {
    if (frame < index.times.length) fetchFrame(frame).catch(() => {});
}

function recolor() {
    const { column } = state;
    const look = panel.look(column);
    if (look && column) {
        const pixels = mapPixels(look.colors);
        panel.bar(pixels, look);
        cloud.color(pixels, look.range, false);
    } else {
        const pixels = new Uint8Array(4 * 256).fill(255);
        index.body_colors.forEach((color, i) =>
            pixels.set(
                color.map((part) => 255 * part),
                4 * i,
            ),
        );
        cloud.color(pixels, [0, 1], true);
    }
    stage.ask();
}

function choosePieces() {
    const shown = (body) => bodies.isShown(body);
    skins.choose(shown, cuts.cuts);
    cloud.choose(shown, cuts.cuts, (body) => !(skins.isOn && skins.bodies.has(body)));
}

function choose(moving) {
    choosePieces();
    layers.choose();
    if (moving) stage.move();
    else stage.ask();
}

// A run that goes on: what is new is asked for each second.
async function follow() {
    let known = "";
    while (source.isLive) {
        await new Promise((resolve) => setTimeout(resolve, POLL));
        try {
            const pulse = await source.json("/pulse");
            const { time, ...mark } = pulse;
            if (byId("message").dataset.lost) {
                byId("message").textContent = "";
                delete byId("message").dataset.lost;
            }
            if (known !== "" && known !== JSON.stringify(mark)) await refresh();
            else if (known === "" && (pulse.frames !== index.times.length || pulse.status !== index.status))
                await refresh();
            known = JSON.stringify(mark);
        } catch {
            byId("message").textContent = "the server has ended; `stickslip view` shows the results again";
            byId("message").dataset.lost = "yes";
        }
    }
}

async function refresh() {
    const before = index;
    index = await source.json("/index");
    // A run that began anew has other frames under the same numbers.
    const anew = before.times.some((time, frame) => index.times[frame] !== time);
    if (anew) frames.forget();
    panel.take(index);
    bodies.take(index);
    describe();
    showEnergy();
    const wasLast = state.frame >= before.times.length - 1;
    if (index.times.length === 0) return;
    if (state.shown < 0 || anew) await show(index.times.length - 1);
    else if (wasLast && byId("follow").checked && !state.playing) await show(index.times.length - 1);
    else draw(state.shown, state.places, state.column);
}

// Energies need no word where there are none.
async function showEnergy() {
    const table = await source.json("/energy").catch(() => ({}));
    if (!(table.time?.length > 1)) return;
    charts.energy(table);
    if (index.status !== "running") return;
    byId("status").textContent = `running: ${withUnit(table.time.at(-1), "s")} of ${withUnit(index.end, "s")}`;
}

byId("time").oninput = () => {
    stage.move();
    show(Number(byId("time").value));
};
byId("first").onclick = () => show(0);
byId("back").onclick = () => show(state.frame - 1);
byId("forth").onclick = () => show(state.frame + 1);
byId("fit").onclick = () => state.places && stage.fit(...bounds(state.places));
for (const button of byId("sides").querySelectorAll("button"))
    button.onclick = () => state.places && stage.fit(...bounds(state.places), button.value);
byId("show-charts").onchange = () => (byId("charts").hidden = !byId("show-charts").checked);
byId("save").onclick = () => {
    const link = document.createElement("a");
    stage.timed();
    overlay.draw();
    link.href = picture([byId("canvas"), byId("overlay")], byId("colorbar"));
    link.download = `${index.title}.png`;
    link.click();
};

function bounds(places) {
    return [places.low, places.low.map((value, axis) => value + places.extent[axis])];
}

// A click that is no drag picks.
let pressed;
byId("canvas").addEventListener("pointerdown", (event) => (pressed = [event.offsetX, event.offsetY]));
byId("canvas").addEventListener("pointerup", (event) => {
    if (event.button === 0 && pressed && Math.hypot(event.offsetX - pressed[0], event.offsetY - pressed[1]) < 4) {
        looking.pickAt(event.offsetX, event.offsetY);
    }
});

document.addEventListener("keydown", (event) => {
    if (["INPUT", "SELECT", "BUTTON"].includes(event.target.tagName) && event.target.type !== "checkbox") return;
    const keys = {
        " ": () => byId("play").click(),
        ArrowLeft: () => show(state.frame - 1),
        ArrowRight: () => show(state.frame + 1),
        Home: () => show(0),
        End: () => show(index.times.length - 1),
        Escape: () => looking.drop(),
        f: () => byId("fit").click(),
    };
    if (!keys[event.key] || event.ctrlKey || event.metaKey) return;
    event.preventDefault();
    keys[event.key]();
});

describe();
recolor();
showEnergy();
if (index.times.length > 0) await show(index.status === "running" ? index.times.length - 1 : 0);
else
    byId("message").textContent =
        index.status === "running" ? "waiting for the first frame ..." : "the run wrote no snapshots of particles";
follow();
window.stickslip = {
    state,
    source,
    frames,
    cloud,
    skins,
    show,
    play: () => playing.start(),
    pickAt: (x, y) => looking.pickAt(x, y),
    measure: (seconds) => measure({ stage, cloud, state }, seconds),
    index: () => index,
};
