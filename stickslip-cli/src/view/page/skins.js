// Bodies as smooth surfaces: triangles that the server carries along with the particles.

import { BufferAttribute, BufferGeometry, DoubleSide, DynamicDrawUsage, Mesh, ShaderMaterial, Vector3 } from "three";

const MAGIC = 0x314b5353; // "SSK1"

const VERTEX = `
    attribute float value;
    attribute float paler;
    uniform vec2 range;
    uniform bool bodies;
    uniform sampler2D colors;
    varying vec3 tint, at, seen, across;
    void main() {
        vec4 view = modelViewMatrix * vec4(position, 1.0);
        at = position;
        seen = view.xyz;
        across = normalMatrix * normal;
        float share = clamp((value - range.x) / (range.y - range.x), 0.0, 1.0) * 0.996 + 0.002;
        if (bodies) share = (value + 0.5) / 256.0;
        tint = texture2D(colors, vec2(share, 0.5)).rgb;
        if (bodies) tint = mix(tint, vec3(1.0), 0.45 * paler);
        gl_Position = projectionMatrix * view;
    }`;

// Edges stay sharp: where the smoothed normal leaves that of the triangle, the triangle's counts.
const FRAGMENT = `
    uniform bool plane;
    uniform vec3 low, high;
    varying vec3 tint, at, seen, across;
    void main() {
        if (any(lessThan(at, low)) || any(greaterThan(at, high))) discard;
        float light = 1.0;
        if (!plane) {
            vec3 flat_normal = normalize(cross(dFdx(seen), dFdy(seen)));
            vec3 normal = normalize(across);
            if (dot(normal, flat_normal) < 0.0) normal = -normal;
            if (dot(normal, flat_normal) < 0.95) normal = flat_normal;
            light = 0.62 + 0.4 * dot(normal, vec3(-0.40, 0.56, 0.72));
            if (!gl_FrontFacing) light *= 0.6;
        }
        gl_FragColor = vec4(tint * light, 1.0);
    }`;

export class Skins {
    // `uniforms` are those of the particles: ranges and colours are the same.
    constructor(stage, source, uniforms) {
        this.stage = stage;
        this.source = source;
        const own = { low: { value: new Vector3() }, high: { value: new Vector3() } };
        this.material = new ShaderMaterial({
            vertexShader: VERTEX,
            fragmentShader: FRAGMENT,
            side: DoubleSide,
            uniforms: {
                range: uniforms.range,
                bodies: uniforms.bodies,
                colors: uniforms.colors,
                plane: uniforms.plane,
                ...own,
            },
        });
        this.mesh = new Mesh(new BufferGeometry(), this.material);
        this.mesh.frustumCulled = false;
        this.mesh.visible = false;
        stage.scene.add(this.mesh);
        this.bodies = new Map();
    }

    get isOn() {
        return this.mesh.visible;
    }

    // Fetches the triangles, the first time.
    async load(colors) {
        this.loading ??= this.source.buffer("/skins").then((buffer) => this.#take(buffer, colors));
        await this.loading.catch((error) => {
            this.loading = undefined;
            throw error;
        });
    }

    #take(buffer, colors) {
        const words = new Uint32Array(buffer, 0, buffer.byteLength >> 2);
        const [magic, corners, triangles, bodies] = words;
        if (magic !== MAGIC) throw new Error("the server sent no triangles");
        const at = 4 + 3 * bodies;
        this.triangles = words.slice(at, at + 3 * triangles);
        this.paler = Float32Array.from(new Uint8Array(buffer, 4 * (at + 3 * triangles), corners));
        this.bodyColors = new Float32Array(corners);
        let [corner, triangle] = [0, 0];
        for (let i = 0; i < bodies; i++) {
            const [body, own, faces] = words.subarray(4 + 3 * i, 7 + 3 * i);
            this.bodies.set(body, { from: triangle, to: triangle + faces });
            this.bodyColors.fill(body % colors, corner, corner + own);
            corner += own;
            triangle += faces;
        }
        this.corners = corners;
    }

    // Shows a frame, coloured by a quantity or by bodies.
    async show(frame, quantity) {
        const wanted = `${frame}/${quantity ?? ""}`;
        this.wanted = wanted;
        const asked = [this.source.buffer(`/skins/${frame}`)];
        if (quantity) asked.push(this.source.buffer(`/skins/${frame}/${quantity}`));
        const [places, column] = await Promise.all(asked);
        if (this.wanted !== wanted) return;
        const corners = new Float32Array(places);
        const { origin } = this.stage;
        for (let i = 0; i < corners.length; i++) corners[i] -= origin[i % 3];
        const geometry = new BufferGeometry();
        const put = (name, array, size) =>
            geometry.setAttribute(name, new BufferAttribute(array, size).setUsage(DynamicDrawUsage));
        put("position", corners, 3);
        put("value", column ? new Float32Array(column).subarray(4) : this.bodyColors, 1);
        put("paler", this.paler, 1);
        geometry.setIndex(new BufferAttribute(this.triangles, 1));
        if (!this.stage.plane) geometry.computeVertexNormals();
        if (this.chosen) geometry.setIndex(new BufferAttribute(this.chosen, 1));
        this.mesh.geometry.dispose();
        this.mesh.geometry = geometry;
        this.mesh.visible = true;
        this.stage.ask();
    }

    hide() {
        this.wanted = undefined;
        this.mesh.visible = false;
    }

    // Chooses what is drawn, as for the particles.
    choose(shown, cuts) {
        const { low, high } = this.material.uniforms;
        const local = (value, axis) => Math.max(-1e30, Math.min(1e30, value - this.stage.origin[axis]));
        low.value.set(...cuts.map((cut, axis) => local(cut.low, axis)));
        high.value.set(...cuts.map((cut, axis) => local(cut.high, axis)));
        if (!this.triangles) return;
        const parts = [...this.bodies].filter(([body]) => shown(body));
        this.chosen = undefined;
        if (parts.length < this.bodies.size) {
            this.chosen = new Uint32Array(parts.reduce((sum, [, { from, to }]) => sum + 3 * (to - from), 0));
            let at = 0;
            for (const [, { from, to }] of parts) {
                this.chosen.set(this.triangles.subarray(3 * from, 3 * to), at);
                at += 3 * (to - from);
            }
        }
        if (this.isOn) this.mesh.geometry.setIndex(new BufferAttribute(this.chosen ?? this.triangles, 1));
    }
}
