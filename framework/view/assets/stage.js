// The scene in 3-D: hand, object, obstacles, marks; camera and light.

import * as THREE from "three";
import { OrbitControls } from "three/orbit";
import { FINGER_COLORS, axes, meshGeometry, painted, place, shapeMesh, surface } from "./bodies.js";
import { ContactMarks, Trace } from "./marks.js";
import { norm, poseAt, unit } from "./pose.js";

/** What can be shown and hidden: key, name, letter on the keyboard, whether it is shown at first. */
export const LAYERS = [
    ["contacts", "Contacts", "c", true],
    ["cones", "Friction cones", "f", true],
    ["traces", "Rolled traces", "t", true],
    ["axes", "Object axes", "a", true],
    ["obstacles", "Obstacles", "o", true],
    ["facets", "Facets", "w", false],
    ["replay", "Simulated object", "r", true],
];

/** How long (ms) nothing must have changed before a picture is drawn with all care where that is slow. */
const REST = 200;

export class Stage {
    constructor(canvas, data, motion) {
        this.canvas = canvas;
        this.motion = motion;
        this.layers = Object.fromEntries(LAYERS.map(([key]) => [key, []]));
        THREE.Object3D.DEFAULT_UP.set(0, 0, 1);
        this.soft = this.quick = drawsInSoftware();
        this.slow = false;
        // Without a graphics processor every sample of a pixel costs; pictures at rest are drawn finer instead.
        this.renderer = new THREE.WebGLRenderer({ canvas, antialias: !this.soft, powerPreference: "high-performance" });
        this.renderer.shadowMap.enabled = true;
        this.scene = new THREE.Scene();
        this.camera = new THREE.PerspectiveCamera(32, 1, 0.01, 10);
        this.build(data);
        this.frame();
        this.light();
        this.controls = new OrbitControls(this.camera, canvas);
        this.controls.target.copy(this.center);
        this.controls.maxDistance = this.radius * 12;
        this.controls.minDistance = this.radius * 0.4;
        this.controls.addEventListener("change", () => (this.stale = true));
        this.controls.update();
        LAYERS.forEach(([key, , , shown]) => this.toggle(key, shown));
        new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
        this.resize();
    }

    build(data) {
        const size = data.hand.tip_radius;
        const neutral = surface(this.soft, { color: "#98a0ab" }, { roughness: 0.65, metalness: 0.1 });
        const rough = surface(this.soft, { color: "#8d7f6d", transparent: true, opacity: 0.85 }, { roughness: 0.9 });
        const wide = Math.max(...data.hand.fingers.map((finger) => norm(finger.base))) * 4 + 8 * size;
        this.still = new THREE.Group();
        data.hand.palm.forEach((shape) => this.still.add(shapeMesh(shape, neutral, wide)));
        this.obstacles = new THREE.Group();
        data.obstacles.forEach(({ shape }) => this.obstacles.add(shapeMesh(shape, rough, wide)));
        this.scene.add(this.still, this.obstacles);
        this.layers.obstacles.push(this.obstacles);
        this.fingers = data.hand.fingers.map((finger, f) => this.finger(finger, f, size));
        this.object(data, size);
        this.traces(data, size);
    }

    finger(finger, f, size) {
        const color = FINGER_COLORS[f % FINGER_COLORS.length];
        const skin = new THREE.Color("#c3c8d0").lerp(new THREE.Color(color), 0.16);
        const material = surface(this.soft, { color: skin }, { roughness: 0.5, metalness: 0.15 });
        const links = finger.joints.map((joint) => {
            const link = new THREE.Group();
            joint.shapes.forEach((shape) => link.add(shapeMesh(shape, material, size)));
            this.scene.add(link);
            return link;
        });
        const rubber = surface(this.soft, { color }, { roughness: 0.45 });
        const tip = new THREE.Mesh(new THREE.SphereGeometry(size, 32, 20), rubber);
        tip.position.set(...finger.tip);
        tip.castShadow = true;
        links.at(-1).add(tip);
        return { links, tip, rubber };
    }

    object(data, size) {
        const geometry = meshGeometry(data.object);
        this.body = new THREE.Group();
        const skin = new THREE.Mesh(geometry, painted(this.soft, geometry));
        skin.castShadow = skin.receiveShadow = true;
        this.body.add(skin);
        geometry.computeBoundingSphere();
        this.bodyRadius = geometry.boundingSphere.radius;
        const arrows = axes(this.bodyRadius * 1.3);
        this.layers.axes.push(arrows);
        const wire = new THREE.LineSegments(
            new THREE.WireframeGeometry(geometry),
            new THREE.LineBasicMaterial({ color: "#101418", transparent: true, opacity: 0.35 }),
        );
        this.layers.facets.push(wire);
        this.marks = new ContactMarks(this.fingers.length, data.cone, size);
        this.layers.contacts.push(this.marks.points);
        this.layers.cones.push(this.marks.cones);
        this.body.add(arrows, wire, this.marks.points, this.marks.cones);
        this.scene.add(this.body);
        if (data.replay) this.addReplay(geometry);
    }

    /** A second, translucent object that goes where a simulation took it. */
    addReplay(geometry) {
        const material = surface(this.soft, { color: "#ff5da2", transparent: true, opacity: 0.42, depthWrite: false }, {});
        // Where both are in the same place, this one is in front.
        Object.assign(material, { polygonOffset: true, polygonOffsetFactor: -4, polygonOffsetUnits: -4 });
        this.ghost = new THREE.Mesh(geometry, material);
        this.ghost.renderOrder = 5;
        this.layers.replay.push(this.ghost);
        this.scene.add(this.ghost);
    }

    traces(data, size) {
        const { states, segments } = this.motion;
        const transfers = segments.filter((segment) => segment.kind === "transfer");
        const firsts = transfers.map((segment) => segment.first);
        this.trails = [];
        this.fingers.forEach((finger, f) => {
            const points = transfers.map((segment) => contactsOf(states, segment, f));
            const onObject = points.map((list) => list.map((c) => [c.point, c.normal]));
            const tip = data.hand.fingers[f].tip;
            const onTip = points.map((list) =>
                list.map((c) => [c.onTip.map((x, i) => x + tip[i]), unit(c.onTip)]),
            );
            const color = FINGER_COLORS[f % FINGER_COLORS.length];
            const first = new Trace(onObject, firsts, color, size * 0.16);
            const second = new Trace(onTip, firsts, "#14181d", size * 0.1);
            this.body.add(first.group);
            finger.links.at(-1).add(second.group);
            this.layers.traces.push(first.group, second.group);
            this.trails.push(first, second);
        });
    }

    /** Finds what is to be seen at first, and sets the camera so that it is. */
    frame() {
        if (this.motion.states.count) this.show(this.motion.at(this.motion.begin));
        this.scene.updateMatrixWorld(true);
        const box = new THREE.Box3();
        const palm = this.still.children.filter((part) => !part.userData.endless);
        [...this.fingers.flatMap((finger) => finger.links), this.body, ...palm].forEach((part) => box.expandByObject(part));
        const sphere = box.getBoundingSphere(new THREE.Sphere());
        [this.center, this.radius] = [sphere.center, Math.max(sphere.radius, 1e-3)];
        this.center.z -= this.radius * 0.05;
        this.floor = box.min.z;
        const away = new THREE.Vector3(0.78, -0.95, 0.62).normalize();
        this.camera.near = this.radius / 100;
        this.camera.far = this.radius * 60;
        this.home = this.center.clone().addScaledVector(away, (this.radius * 0.96) / Math.sin((16 * Math.PI) / 180));
        this.camera.position.copy(this.home);
    }

    light() {
        const r = this.radius;
        this.scene.add(new THREE.HemisphereLight("#ffffff", "#8a8f99", 1.7));
        const sun = new THREE.DirectionalLight("#fff6e8", 2.3);
        sun.position.copy(this.center).add(new THREE.Vector3(0.9 * r, -1.1 * r, 3.2 * r));
        sun.target.position.copy(this.center);
        sun.castShadow = !this.quick;
        sun.shadow.mapSize.set(1024, 1024);
        Object.assign(sun.shadow.camera, { left: -1.6 * r, right: 1.6 * r, top: 1.6 * r, bottom: -1.6 * r, near: 0.1 * r, far: 8 * r });
        sun.shadow.bias = -0.0005;
        sun.shadow.normalBias = r * 0.004;
        const fill = new THREE.DirectionalLight("#dfe9ff", 0.7);
        fill.position.set(-2 * r, 1.5 * r, r);
        const ground = new THREE.Mesh(new THREE.CircleGeometry(4 * r, 96), new THREE.ShadowMaterial({ opacity: 0.22 }));
        ground.position.set(this.center.x, this.center.y, this.floor - 0.002 * r);
        ground.receiveShadow = true;
        this.grid = new THREE.GridHelper(6 * r, 24).rotateX(Math.PI / 2);
        this.grid.position.copy(ground.position);
        this.grid.material.transparent = true;
        this.scene.add(sun, sun.target, fill, ground, this.grid);
        this.sun = sun;
    }

    /** Colours of page and stage go together. */
    theme(background, lines) {
        this.scene.background = new THREE.Color(background);
        this.scene.fog = new THREE.Fog(background, this.radius * 6, this.radius * 11);
        this.grid.material.color.set(lines);
        this.grid.material.vertexColors = false;
        this.grid.material.opacity = 0.5;
        this.grid.material.needsUpdate = true;
        this.stale = true;
    }

    toggle(key, shown) {
        this.layers[key].forEach((part) => (part.visible = shown));
        this.stale = true;
    }

    resetCamera() {
        this.camera.position.copy(this.home);
        this.controls.target.copy(this.center);
        this.controls.update();
    }

    resize() {
        const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
        if (!width || !height) return;
        const full = Math.min(window.devicePixelRatio || 1, 2);
        this.renderer.setPixelRatio(this.quick ? Math.min(full, 1) : this.soft ? 2 : full);
        this.renderer.setSize(width, height, false);
        this.camera.aspect = width / height;
        // A narrow window must not cut off the sides.
        this.camera.fov = width < height ? (2 * Math.atan(Math.tan((16 * Math.PI) / 180) * (height / width)) * 180) / Math.PI : 32;
        this.camera.updateProjectionMatrix();
        this.stale = true;
    }

    /** With less care: no shadows, no more pixels than the screen needs. */
    setQuick(quick) {
        if (quick === this.quick) return;
        this.quick = quick;
        this.sun.castShadow = !quick;
        this.resize();
    }

    show(snapshot) {
        place(this.body, snapshot.object);
        this.fingers.forEach((finger, f) => {
            finger.links.forEach((link, j) => place(link, snapshot.links[f][j]));
            finger.rubber.emissive.set(snapshot.moving === f ? "#5a1a1a" : "#000000");
        });
        this.marks.show(snapshot.contacts);
        this.trails.forEach((trail) => trail.show(snapshot.state ?? -1));
        this.stale = true;
    }

    showReplay(pose) {
        if (this.ghost && pose) place(this.ghost, pose);
    }

    /** Draws what has changed; where drawing is slow with less care while it changes, and once more with all care when it rests. */
    render(now = performance.now()) {
        const rests = !this.stale && this.quick && now - this.drawn > REST;
        if (!this.stale && !rests) return;
        this.setQuick(!rests && (this.soft || this.slow));
        if (!rests) this.drawn = now;
        this.stale = false;
        this.renderer.render(this.scene, this.camera);
    }
}

/** In the place of a stage where the browser draws nothing in 3-D: all else of the page can still be used. */
export class NoStage {
    constructor(data) {
        const { vertices } = data.object;
        this.bodyRadius = vertices.reduce((most, x) => Math.max(most, Math.abs(x)), 1e-6);
        for (const nothing of ["show", "showReplay", "render", "toggle", "theme", "resetCamera"]) this[nothing] = () => {};
    }
}

/** Whether this browser has no graphics processor to draw with, as far as it tells. */
function drawsInSoftware() {
    const context = document.createElement("canvas").getContext("webgl2");
    const info = context?.getExtension("WEBGL_debug_renderer_info");
    const name = String(context?.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : context.RENDERER) ?? "");
    context?.getExtension("WEBGL_lose_context")?.loseContext();
    return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
}

function contactsOf(states, segment, finger) {
    const list = [];
    for (let k = segment.first; k <= segment.last; k++) {
        const contact = states.contact(k, finger);
        if (contact) list.push(contact);
    }
    return list.length === segment.count ? list : [];
}
