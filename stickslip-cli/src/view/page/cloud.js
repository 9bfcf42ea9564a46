// Particles as points: balls in space, squares in the plane, drawn by the graphics processor or in its place.
//
// Which ones are drawn is a list of their numbers, made anew when a frame, a cut or a choice of bodies changes. In
// space it holds those at the surface of their bodies, and beside a cut those inside. It goes through the particles in
// eight passes of every eighth, so that its first part is an even selection: the one that is drawn while things move,
// where all of them would take too long.

import {
    BufferAttribute,
    BufferGeometry,
    DataTexture,
    DynamicDrawUsage,
    LinearFilter,
    Points,
    RGBAFormat,
    ShaderMaterial,
    Vector2,
    Vector3,
} from "three";

const PASSES = [0, 4, 2, 6, 1, 5, 3, 7];
// Balls of this many sides across let no light through a face of a lattice, nor do squares that are turned.
const [BALL, SQUARE] = [1.48, 1.3];
const LEAST_SHARE = 1 / 16;
// Fewer particles than this are always all drawn.
const FEW = 20000;
// Marks a particle beside a cut.
const FILLING = 2;

const VERTEX = `
    attribute vec4 place;
    attribute float value;
    uniform vec3 low, extent;
    uniform float largest, swell, pixels;
    uniform vec2 range;
    uniform bool bodies;
    uniform sampler2D colors;
    varying vec3 tint;
    varying float width;
    void main() {
        vec3 x = low + extent * place.xyz / 65535.0;
        float side = floor(place.w / 4.0) * largest / 16383.0;
        bool pale = mod(place.w, 2.0) > 0.5;
        gl_Position = projectionMatrix * viewMatrix * vec4(x, 1.0);
        width = swell * side * projectionMatrix[1][1] * pixels / gl_Position.w;
        gl_PointSize = side > 0.0 ? max(width, 1.5) : 0.0;
        float share = clamp((value - range.x) / (range.y - range.x), 0.0, 1.0) * 0.996 + 0.002;
        if (bodies) share = (value + 0.5) / 256.0;
        tint = texture2D(colors, vec2(share, 0.5)).rgb;
        if (bodies && pale) tint = mix(tint, vec3(1.0), 0.45);
        if (!(value - value == 0.0)) tint = vec3(0.6);
    }`;

const FRAGMENT = `
    uniform bool plane;
    varying vec3 tint;
    varying float width;
    void main() {
        float light = 1.0;
        if (!plane && width > 2.0) {
            vec2 at = 2.0 * gl_PointCoord - 1.0;
            float square = dot(at, at);
            if (square > 1.0) discard;
            light = 0.62 + 0.4 * dot(vec3(at.x, -at.y, sqrt(1.0 - square)), vec3(-0.40, 0.56, 0.72));
        }
        gl_FragColor = vec4(tint * light, 1.0);
    }`;

export class Cloud {
    constructor(stage) {
        this.stage = stage;
        this.share = 1;
        this.texture = new DataTexture(new Uint8Array(4 * 256), 256, 1, RGBAFormat);
        this.material = new ShaderMaterial({
            vertexShader: VERTEX,
            fragmentShader: FRAGMENT,
            uniforms: {
                low: { value: new Vector3() },
                extent: { value: new Vector3() },
                largest: { value: 0 },
                swell: { value: 1 },
                pixels: { value: 1 },
                range: { value: new Vector2(0, 1) },
                bodies: { value: true },
                plane: { value: stage.plane },
                colors: { value: this.texture },
            },
        });
        this.points = new Points(new BufferGeometry(), this.material);
        this.points.frustumCulled = false;
        stage.scene.add(this.points);
        this.list = new Uint32Array(0);
    }

    // Shows a frame. `values` are those of the column, or indices of bodies' colours.
    show(places, values) {
        const geometry = this.points.geometry;
        if (this.places !== places) {
            this.places = places;
            this.#put("place", places.data, 4);
            const { low, extent } = places;
            this.material.uniforms.low.value.set(...low.map((value, axis) => value - this.stage.origin[axis]));
            this.material.uniforms.extent.value.set(...extent);
            this.material.uniforms.largest.value = places.largest;
        }
        if (geometry.getAttribute("value")?.array !== values) this.#put("value", values, 1);
    }

    // Takes the place of what an attribute held, in the same buffer where it has the same length.
    #put(name, array, components) {
        const geometry = this.points.geometry;
        const held = geometry.getAttribute(name);
        if (held && held.array.length === array.length) {
            held.array = array;
            held.needsUpdate = true;
            return;
        }
        if (held) this.points.geometry = renewed(geometry, name);
        this.points.geometry.setAttribute(name, new BufferAttribute(array, components).setUsage(DynamicDrawUsage));
    }

    // Chooses what is in sight: `shown(body)` says whether a body is, `cuts` between which values of an axis. Of that,
    // bodies for which `drawn(body)` does not hold are drawn by others, as shells: particles beside a cut fill them.
    choose(shown, cuts, drawn = () => true) {
        const { places, stage } = this;
        if (!places) return;
        const { count, data } = places;
        const cut = cuts.some(({ low, high }) => low > -Infinity || high < Infinity);
        // In units of the data; beside a cut, what is hidden elsewhere is in sight.
        const bounds = cuts.map(({ low, high }, axis) => {
            const unit = 65535 / places.extent[axis];
            const bound = (value) => (value - places.low[axis]) * unit;
            const skin = 2.2 * places.largest * unit;
            return [bound(low), bound(high), bound(low) + skin, bound(high) - skin];
        });
        const visible = new Uint8Array(count);
        for (const { body, start, end } of places.runs) if (shown(body)) visible.fill(1, start, end);
        if (cut || !stage.plane) {
            for (let i = 0; i < count; i++) {
                if (visible[i] === 0) continue;
                const seen = stage.plane || (data[4 * i + 3] & 2) !== 0;
                let filling = false;
                for (let axis = 0; cut && axis < 3; axis++) {
                    const x = data[4 * i + axis];
                    const [low, high, inner, outer] = bounds[axis];
                    if (x < low || x > high) {
                        visible[i] = 0;
                        break;
                    }
                    if (x < inner || x > outer) filling = true;
                }
                if (visible[i] === 0 || (stage.plane && seen)) continue;
                visible[i] = filling ? FILLING : Number(seen);
            }
        }
        let total = 0;
        for (let i = 0; i < count; i++) if (visible[i]) total += 1;
        const list = this.list.length === total ? this.list : new Uint32Array(total);
        let at = 0;
        for (const pass of PASSES) for (let i = pass; i < count; i += 8) if (visible[i]) list[at++] = i;
        this.list = list;
        const others = places.runs.filter(({ body }) => !drawn(body));
        for (const { start, end } of others)
            for (let i = start; i < end; i++) if (visible[i] !== FILLING) visible[i] = 0;
        this.#draw(others.length > 0 ? list.filter((i) => visible[i]) : list);
    }

    // Draws the particles of a list.
    #draw(list) {
        const index = this.points.geometry.getIndex();
        if (index && index.array === list) {
            index.needsUpdate = true;
        } else {
            if (index) this.points.geometry = renewed(this.points.geometry, "index");
            this.points.geometry.setIndex(new BufferAttribute(list, 1).setUsage(DynamicDrawUsage));
        }
        this.total = list.length;
    }

    color(pixels, range, bodies) {
        this.texture.image.data.set(pixels);
        this.texture.minFilter = this.texture.magFilter = bodies ? 1003 : LinearFilter;
        this.texture.needsUpdate = true;
        this.material.uniforms.range.value.set(range[0], range[1] > range[0] ? range[1] : range[0] + 1e-30);
        this.material.uniforms.bodies.value = bodies;
    }

    // Before each picture: how much of the list is drawn.
    prepare({ moving, fewer, more }) {
        const { stage, total = 0 } = this;
        if (fewer) this.share = Math.max(this.share / 2, LEAST_SHARE);
        else if (more) this.share = Math.min(this.share * 1.25, 1);
        const share = moving && total > FEW ? this.share : 1;
        this.drawn = Math.ceil(share * total);
        this.points.geometry.setDrawRange(0, this.drawn);
        const uniforms = this.material.uniforms;
        // Fewer ones cover as much.
        uniforms.swell.value = (stage.plane ? SQUARE : BALL) / Math.sqrt(share);
        uniforms.pixels.value = stage.pixels;
    }
}

// The same geometry but for one attribute, whose buffer is given back.
function renewed(geometry, without) {
    const fresh = new BufferGeometry();
    for (const [name, attribute] of Object.entries(geometry.attributes)) {
        if (name !== without)
            fresh.setAttribute(
                name,
                new BufferAttribute(attribute.array, attribute.itemSize).setUsage(DynamicDrawUsage),
            );
    }
    if (without !== "index" && geometry.getIndex())
        fresh.setIndex(new BufferAttribute(geometry.getIndex().array, 1).setUsage(DynamicDrawUsage));
    geometry.dispose();
    return fresh;
}
