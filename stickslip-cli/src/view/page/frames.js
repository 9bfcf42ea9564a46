// Frames as they come from the source: places of particles and values at them, the newest kept in memory.

const KEPT_BYTES = 600e6;
// Values that are sorted to find what most of them are.
const SAMPLE = 50000;
const MAGIC = 0x31565353; // "SSV1"

// Places of the particles of a frame; places.rs says how the bytes stand.
export class Places {
    constructor(buffer) {
        const view = new DataView(buffer);
        if (view.getUint32(0, true) !== MAGIC) throw new Error("the server sent no frame");
        this.count = view.getUint32(4, true);
        const runs = view.getUint32(8, true);
        this.sidesKnown = view.getUint32(12, true) === 1;
        const real = (i) => view.getFloat64(16 + 8 * i, true);
        this.low = [real(0), real(1), real(2)];
        this.extent = [real(3), real(4), real(5)];
        this.largest = real(6);
        this.runs = [];
        let start = 0;
        for (let i = 0; i < runs; i++) {
            const [body, count, first, step] = [0, 4, 8, 12].map((at) => view.getUint32(72 + 16 * i + at, true));
            this.runs.push({ body, start, end: start + count, first, step });
            start += count;
        }
        this.data = new Uint16Array(buffer, 72 + 16 * runs, 4 * this.count);
        const numbers = 72 + 16 * runs + 8 * this.count;
        this.numbers = buffer.byteLength > numbers ? new Uint32Array(buffer, numbers, this.count) : null;
        this.byteLength = buffer.byteLength;
    }

    run(particle) {
        let [low, high] = [0, this.runs.length - 1];
        while (low < high) {
            const middle = (low + high) >> 1;
            if (this.runs[middle].end > particle) high = middle;
            else low = middle + 1;
        }
        return this.runs[low];
    }

    number(particle) {
        const run = this.run(particle);
        return run.step === 0 ? this.numbers[particle] : run.first + (particle - run.start) * run.step;
    }

    // The particle of a body with a number; -1 if there is none.
    find(body, number) {
        const run = this.runs.find((run) => run.body === body);
        if (!run) return -1;
        if (run.step === 0) {
            const place = this.numbers.subarray(run.start, run.end).indexOf(number);
            return place < 0 ? -1 : run.start + place;
        }
        const place = (number - run.first) / run.step;
        return Number.isInteger(place) && place >= 0 && run.start + place < run.end ? run.start + place : -1;
    }

    position(particle) {
        return [0, 1, 2].map((axis) => this.low[axis] + (this.extent[axis] * this.data[4 * particle + axis]) / 65535);
    }

    side(particle) {
        return ((this.data[4 * particle + 3] >> 2) * this.largest) / 16383;
    }

    // Means of the particles' places, by body.
    centers() {
        if (this.means) return this.means;
        this.means = new Map();
        for (const { body, start, end } of this.runs) {
            const sums = [0, 0, 0];
            for (let i = start; i < end; i++)
                for (let axis = 0; axis < 3; axis++) sums[axis] += this.data[4 * i + axis];
            const mean = (sum, axis) => this.low[axis] + (this.extent[axis] * sum) / (65535 * (end - start));
            this.means.set(body, sums.map(mean));
        }
        return this.means;
    }
}

// Values of a quantity at the particles of a frame.
export class Column {
    constructor(buffer) {
        const values = new Float32Array(buffer);
        [this.least, this.most, this.low, this.high] = values;
        this.values = values.subarray(4);
        this.byteLength = buffer.byteLength;
    }

    // Between which values 95 of 100 lie, told by an even selection of them.
    inner() {
        if (this.between) return this.between;
        const step = Math.ceil(this.values.length / SAMPLE);
        const sample = this.values.filter((value, i) => i % step === 0 && Number.isFinite(value)).sort();
        const at = (share) => sample[Math.round(share * (sample.length - 1))] ?? 0;
        this.between = [at(0.025), at(0.975)];
        return this.between;
    }
}

export class Frames {
    constructor(source) {
        this.source = source;
        // Promises by their routes, the one that was wanted last at the end.
        this.kept = new Map();
        this.bytes = 0;
    }

    places(frame) {
        return this.#get(`/frame/${frame}`, Places);
    }

    column(frame, quantity) {
        return this.#get(`/column/${frame}/${quantity}`, Column);
    }

    forget() {
        this.kept.clear();
        this.bytes = 0;
    }

    #get(route, Kind) {
        let entry = this.kept.get(route);
        if (entry) {
            this.kept.delete(route);
        } else {
            entry = { bytes: 0 };
            entry.promise = this.source.buffer(route).then((buffer) => {
                entry.bytes = buffer.byteLength;
                this.bytes += entry.bytes;
                this.#shrink(route);
                return new Kind(buffer);
            });
            entry.promise.catch(() => this.kept.delete(route));
        }
        this.kept.set(route, entry);
        return entry.promise;
    }

    #shrink(newest) {
        for (const [route, entry] of this.kept) {
            if (this.bytes <= KEPT_BYTES) return;
            if (entry.bytes === 0 || route === newest) continue;
            this.kept.delete(route);
            this.bytes -= entry.bytes;
        }
    }
}
