// What the reader adds to the particles of a frame: surfaces, forces, velocities, fringes.

import { withUnit } from "stickslip/colors";
import { Forces } from "stickslip/forces";
import { Velocities } from "stickslip/velocities";

const byId = (id) => document.getElementById(id);
const isTicked = (id) => byId(id).checked;

export class Layers {
    // `parts` are those of the page; `index()` is the newest list of what there is; `choosePieces()` chooses anew what
    // is drawn, when surfaces come or go.
    constructor(parts, index, choosePieces) {
        Object.assign(this, parts);
        this.newest = index;
        this.choosePieces = choosePieces;
        this.contacts = new Forces(this.stage);
        this.moves = new Velocities(this.stage, this.source, this.frames);
        byId("chains").onchange = byId("arrows").onchange = () => this.forces();
        byId("draw").onchange = () => this.surfaces();
        byId("velocities").onchange = () => this.velocities();
        byId("show-fringes").onchange = () => this.fringes();
    }

    // Which layers there can be.
    offer() {
        const { source } = this;
        byId("velocities").disabled = !this.moves.areThere;
        byId("draw").lastElementChild.disabled = !source.has("/skins");
        byId("fringes-switch").hidden = !(this.newest().fringes && source.has("/fringes/0"));
    }

    // Another frame is shown.
    show() {
        this.surfaces();
        this.fringes();
        this.choose();
    }

    // Others of its bodies and parts are.
    choose() {
        this.forces();
        this.velocities();
    }

    // Bodies as surfaces, where the reader wants that and they are known.
    async surfaces() {
        const { state, skins, stage } = this;
        if (state.shown < 0) return;
        if (byId("draw").value === "particles") {
            if (!skins.isOn) return;
            skins.hide();
            this.choosePieces();
            stage.ask();
            return;
        }
        const { shown } = state;
        const { quantity } = this.panel;
        const wasOn = skins.isOn;
        try {
            if (!skins.triangles) byId("no-surfaces").textContent = "making surfaces ...";
            await skins.load(this.newest().body_colors.length);
            await skins.show(shown, quantity?.id);
            byId("no-surfaces").textContent = "";
            if (!wasOn) this.choosePieces();
        } catch (error) {
            byId("draw").value = "particles";
            byId("no-surfaces").textContent = error.message;
        }
    }

    async forces() {
        const { state, stage, bodies, contacts } = this;
        const [chains, arrows] = ["chains", "arrows"].map(isTicked);
        const note = byId("force-scale");
        note.textContent = "";
        if (state.shown < 0) return;
        if (!chains && !arrows) {
            contacts.clear();
            stage.ask();
            return;
        }
        const { shown, places, box } = state;
        const nothing = { contacts: [], largest: 0 };
        const told = await this.source.json(`/contacts/${shown}`).catch((error) => ({ ...nothing, error }));
        if (state.shown !== shown) return;
        const { rigid, dimension } = this.newest();
        contacts.show(told, places, { chains, arrows, shown: (body) => bodies.isShown(body), rigid, size: box.size });
        const largest = withUnit(told.largest, dimension === 2 ? "N/m" : "N");
        note.textContent =
            told.error?.message ?? `contacts: ${told.contacts.length}; the widest and longest stand for ${largest}`;
        stage.ask();
    }

    async velocities() {
        const { state, stage, moves } = this;
        const note = byId("velocity-scale");
        note.textContent = "";
        if (state.shown < 0) return;
        if (!isTicked("velocities")) {
            moves.clear();
            stage.ask();
            return;
        }
        const { shown, places, box } = state;
        const isShown = () => state.shown === shown && isTicked("velocities");
        try {
            const fastest = await moves.show(shown, { places, list: this.cloud.list, size: box.size, isShown });
            if (fastest !== undefined) note.textContent = `the longest stands for ${withUnit(fastest, "m/s")}`;
        } catch (error) {
            note.textContent = error.message;
        }
        stage.ask();
    }

    fringes() {
        const isWanted = isTicked("show-fringes") && this.state.shown >= 0;
        byId("fringes").hidden = !isWanted;
        if (isWanted) byId("fringes").firstElementChild.src = `/fringes/${this.state.shown}`;
    }
}
