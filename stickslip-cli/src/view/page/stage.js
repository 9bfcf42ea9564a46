// Camera, controls and the moment of drawing: a picture is made when something has changed, and at no other time.

import {
    AmbientLight,
    DirectionalLight,
    OrbitControls,
    OrthographicCamera,
    PerspectiveCamera,
    Scene,
    Vector3,
    WebGLRenderer,
} from "three";

const SETTLED = 160; // ms without motion, after which the picture is drawn in full
// Time of a picture of a motion [ms], above which it is made simpler, and below which it need not be.
const [SLOW, QUICK] = [70, 28];
const COARSE = 0.5; // share of the pixels of a side that are left then
const BESIDE = 200; // pixels that the bar of colours takes, and as many on the other side
const VIEW_ANGLE = 28; // degrees
// Where the eye stands at first: as in the pictures of `stickslip render`.
const [AZIMUTH, ELEVATION] = [16, 18].map((angle) => (angle * Math.PI) / 180);

export class Stage {
    // `onDraw({ moving, fewer, more })` is called before each picture: whether things move, and whether less is to be
    // drawn while they do, for there are fewer pixels already, or more can be.
    constructor(canvas, index, onDraw) {
        this.canvas = canvas;
        this.plane = index.dimension === 2;
        this.onDraw = onDraw;
        // The mean time of the last pictures of a motion [ms].
        Object.assign(this, { moving: false, coarse: false, pace: QUICK });
        this.renderer = new WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
        this.renderer.setClearColor(0xffffff);
        this.scene = new Scene();
        this.scene.add(new AmbientLight(0xffffff, 1.6));
        this.origin = [0, 0, 0];
        this.halves = [1, 1];
        this.up = this.plane ? new Vector3(0, 1, 0) : vertical(index.gravity);
        this.camera = this.plane ? new OrthographicCamera() : new PerspectiveCamera(VIEW_ANGLE);
        this.camera.up.copy(this.up);
        const light = new DirectionalLight(0xffffff, 2.2);
        light.position.set(-0.4, 0.6, 0.7);
        this.camera.add(light);
        this.scene.add(this.camera);
        this.controls = new OrbitControls(this.camera, canvas);
        this.controls.enableDamping = false;
        this.controls.zoomToCursor = true;
        if (this.plane) {
            this.controls.enableRotate = false;
            this.controls.mouseButtons.LEFT = 2; // pan
            this.controls.touches.ONE = 1;
        }
        this.controls.addEventListener("change", () => this.move());
        new ResizeObserver(() => this.#resize()).observe(canvas.parentElement);
        this.#resize();
    }

    get size() {
        return [this.canvas.clientWidth, this.canvas.clientHeight];
    }

    // Pixels of the canvas in a length of one at a distance of one, as shaders need it.
    get pixels() {
        return 0.5 * this.canvas.height;
    }

    // Length of a pixel at what is looked at [m].
    get metresPerPixel() {
        const { camera, controls } = this;
        const [, height] = this.size;
        if (this.plane) return (camera.top - camera.bottom) / camera.zoom / height;
        const distance = camera.position.distanceTo(controls.target);
        return (2 * distance * Math.tan((0.5 * VIEW_ANGLE * Math.PI) / 180)) / height;
    }

    // Where on the canvas a place [m] is seen [pixels]; nothing behind the eye.
    onScreen(place) {
        const [width, height] = this.size;
        const at = new Vector3(...place.map((value, axis) => value - this.origin[axis])).project(this.camera);
        return at.z < 1 ? [0.5 * (1 + at.x) * width, 0.5 * (1 - at.y) * height] : undefined;
    }

    // Looks at a box, whose corners are given in metres: from a side, or else from where the eye is.
    fit(low, high, side) {
        const middle = low.map((value, axis) => 0.5 * (value + high[axis]));
        const half = Math.max(1e-12, 0.5 * Math.hypot(...low.map((value, axis) => high[axis] - value)));
        const at = new Vector3(...middle.map((value, axis) => value - this.origin[axis]));
        const toward = side
            ? this.#toward(side)
            : this.camera.position.clone().sub(this.controls.target).normalize();
        this.controls.target.copy(at);
        if (this.plane) {
            this.halves = [0, 1].map((axis) => Math.max(0.54 * (high[axis] - low[axis]), 1e-12));
            this.camera.zoom = 1;
            this.camera.position.set(at.x, at.y, 10 * half);
            [this.camera.near, this.camera.far] = [0.01 * half, 100 * half];
        } else {
            const distance = this.#distance(low.map((value, axis) => 0.5 * (high[axis] - value)), toward);
            this.camera.position.copy(at).addScaledVector(toward, distance);
            [this.camera.near, this.camera.far] = [1e-3 * distance, 20 * distance];
        }
        this.#resize();
        this.controls.update();
        this.move();
    }

    // How far from the middle of a box the eye sees all of its corners; `halves` are half its sides.
    #distance(halves, toward) {
        const right = new Vector3().crossVectors(this.up, toward).normalize();
        const above = new Vector3().crossVectors(toward, right);
        const [width, height] = this.size;
        const aspect = this.#room(width) / Math.max(height, 1);
        const slope = 0.92 * Math.tan((0.5 * VIEW_ANGLE * Math.PI) / 180);
        let distance = 0;
        for (let i = 0; i < 8; i++) {
            const corner = new Vector3(...halves.map((half, axis) => ((i >> axis) & 1 ? half : -half)));
            const off = Math.max(Math.abs(corner.dot(above)), Math.abs(corner.dot(right)) / aspect);
            distance = Math.max(distance, corner.dot(toward) + off / slope);
        }
        return distance;
    }

    // Pixels of the width that are left beside the bar of colours.
    #room(width) {
        return Math.max(width - BESIDE, 0.6 * width);
    }

    // From what is looked at to the eye: from the front, the right, the top, or from between them ("oblique").
    #toward(side) {
        const front = Math.abs(this.up.z) > 0.5 ? new Vector3(0, -1, 0) : new Vector3(0, 0, 1);
        const right = new Vector3().crossVectors(this.up, front);
        if (side === "front") return front;
        if (side === "right") return right;
        // Not quite from above, so that it is known what is to the right.
        if (side === "top") return front.multiplyScalar(1e-5).add(this.up).normalize();
        const level = front.multiplyScalar(Math.cos(AZIMUTH)).addScaledVector(right, Math.sin(AZIMUTH));
        return level.multiplyScalar(Math.cos(ELEVATION)).addScaledVector(this.up, Math.sin(ELEVATION));
    }

    // Draws soon, in full.
    ask() {
        this.asked ??= requestAnimationFrame((now) => this.#draw(now));
    }

    // Draws soon, as in a motion that goes on: in full once it has ended.
    move() {
        this.moving = true;
        clearTimeout(this.settling);
        this.ask();
    }

    #draw(now) {
        this.asked = undefined;
        const { moving } = this;
        const slow = moving && this.pace > SLOW;
        const fewer = slow && this.coarse;
        if (this.coarse !== (moving && (slow || this.coarse))) {
            this.coarse = !this.coarse;
            this.#resize();
        }
        if (slow) this.pace = QUICK;
        this.onDraw({ moving, fewer, more: moving && this.pace < QUICK });
        this.renderer.render(this.scene, this.camera);
        if (!moving) return;
        // When the browser is ready for the next one tells the time that the reader feels, on any processor.
        requestAnimationFrame((next) => {
            this.pace += 0.3 * (next - now - this.pace);
            this.#settle();
        });
    }

    // Waits for a motion to go on.
    #settle() {
        clearTimeout(this.settling);
        this.settling = setTimeout(() => {
            this.moving = false;
            this.ask();
        }, SETTLED);
    }

    // Draws now, waits until it is done, and says how long that took [ms].
    timed() {
        const start = performance.now();
        this.renderer.render(this.scene, this.camera);
        const gl = this.renderer.getContext();
        gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
        return performance.now() - start;
    }

    #resize() {
        const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
        if (width === 0 || height === 0) return;
        this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2) * (this.coarse ? COARSE : 1));
        this.renderer.setSize(width, height, false);
        if (this.plane) {
            const [across, up] = this.halves;
            const half = Math.max(up, (across * height) / this.#room(width));
            [this.camera.top, this.camera.bottom] = [half, -half];
            [this.camera.left, this.camera.right] = [(-half * width) / height, (half * width) / height];
        } else {
            this.camera.aspect = width / height;
        }
        this.camera.updateProjectionMatrix();
        this.ask();
    }
}

// The axis that gravity pulls against most; z without gravity.
function vertical(gravity) {
    const sizes = gravity.map(Math.abs);
    const axis = Math.max(...sizes) > 0 ? sizes.lastIndexOf(Math.max(...sizes)) : 2;
    const up = [0, 0, 0];
    up[axis] = gravity[axis] > 0 ? -1 : 1;
    return new Vector3(...up);
}
