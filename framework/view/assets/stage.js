// The scene in 3-D: camera, layers, section plane, one picture or several side by side.

import * as THREE from "three";
import { OrbitControls } from "three/orbit";
import { lights } from "./light.js";

/** How long (ms) nothing must have changed before a picture is drawn with all care where that is slow. */
const REST = 200;
/** Half the angle (degrees) that the camera sees from below to above. */
const HALF_VIEW = 16;
const radians = (degrees) => (degrees * Math.PI) / 180;

/** A stage on the page's canvas, or one that draws nothing where the browser cannot; `complain` is told why. */
export function openStage(canvas, complain) {
    try {
        return new Stage(canvas);
    } catch (error) {
        complain(`This browser draws nothing in 3-D (${error.message}); switch WebGL on to see the hand move.`);
        return null;
    }
}

export class Stage {
    constructor(canvas) {
        this.canvas = canvas;
        this.layers = {};
        this.solids = [];
        this.endless = [];
        this.panes = null;
        THREE.Object3D.DEFAULT_UP.set(0, 0, 1);
        this.soft = this.quick = drawsInSoftware();
        this.slow = false;
        // Without a graphics processor every sample of a pixel costs; pictures at rest are drawn finer instead.
        this.renderer = new THREE.WebGLRenderer({ canvas, antialias: !this.soft, powerPreference: "high-performance" });
        this.renderer.shadowMap.enabled = true;
        this.renderer.localClippingEnabled = true;
        this.scene = new THREE.Scene();
        this.camera = new THREE.PerspectiveCamera(2 * HALF_VIEW, 1, 0.01, 10);
        this.plane = new THREE.Plane(new THREE.Vector3(0, -1, 0), 0);
    }

    /** A lit surface, which the section plane cuts: `look` for any, `fine` beside it where a graphics processor draws. */
    surface(look, fine = {}) {
        const material = this.soft ? new THREE.MeshLambertMaterial(look) : new THREE.MeshStandardMaterial({ ...look, ...fine });
        material.userData.side = material.side;
        this.solids.push(material);
        return material;
    }

    /** Adds what a layer shows and hides. */
    layer(key, ...parts) {
        (this.layers[key] ??= []).push(...parts);
    }

    toggle(key, shown) {
        (this.layers[key] ?? []).forEach((part) => (part.visible = shown));
        this.stale = true;
    }

    /** Sets the camera so that all of `box` is seen, and lights it. */
    open(box) {
        const sphere = box.getBoundingSphere(new THREE.Sphere());
        this.endless.forEach((mark) => this.spread(mark, sphere, box));
        box.getBoundingSphere(sphere);
        this.box = box;
        [this.center, this.radius] = [sphere.center, Math.max(sphere.radius, 1e-3)];
        this.camera.near = this.radius / 100;
        this.camera.far = this.radius * 60;
        const away = new THREE.Vector3(0.78, -0.95, 0.62).normalize();
        this.home = this.center.clone().addScaledVector(away, this.radius / Math.sin(radians(HALF_VIEW)));
        this.camera.position.copy(this.home);
        Object.assign(this, lights(this));
        this.controls = new OrbitControls(this.camera, this.canvas);
        this.controls.target.copy(this.center);
        this.controls.maxDistance = this.radius * 12;
        this.controls.minDistance = this.radius * 0.15;
        this.controls.addEventListener("change", () => (this.stale = true));
        this.controls.update();
        this.outline = outline();
        this.scene.add(this.outline);
        this.setSection(null);
        new ResizeObserver(() => this.resize()).observe(this.canvas.parentElement);
        this.resize();
    }

    /** Lays an endless plane below, above or beside what is shown, and brings it into view where it is near. */
    spread(mark, sphere, box) {
        mark.updateWorldMatrix(true, false);
        const { normal, offset } = mark.userData.endless;
        const center = mark.worldToLocal(sphere.center.clone());
        const n = new THREE.Vector3(...normal);
        const foot = center.addScaledVector(n, offset - n.dot(center));
        mark.children[0].position.copy(foot);
        mark.children[0].scale.setScalar(3 * sphere.radius);
        const seen = mark.localToWorld(foot.clone());
        if (seen.distanceTo(sphere.center) < 3 * sphere.radius) box.expandByPoint(seen);
    }

    /** Cuts all solid bodies: `axis` 0 to 2 of the hand's frame, `share` of the way through the scene; null for no cut. */
    setSection(section) {
        this.section = section;
        this.outline.visible = Boolean(section);
        if (section) {
            const low = this.box.min.getComponent(section.axis);
            const high = this.box.max.getComponent(section.axis);
            const at = low + (high - low) * section.share;
            this.plane.normal.set(0, 0, 0).setComponent(section.axis, -1);
            this.plane.constant = at;
            this.outline.scale.setScalar(this.radius * 0.9);
            this.outline.position.copy(this.center).setComponent(section.axis, at);
            this.outline.rotation.set(section.axis === 1 ? Math.PI / 2 : 0, section.axis === 0 ? Math.PI / 2 : 0, 0);
        }
        for (const material of this.solids) {
            material.clippingPlanes = section ? [this.plane] : null;
            material.side = section ? THREE.DoubleSide : material.userData.side;
            material.needsUpdate = true;
        }
        this.stale = true;
    }

    /** Where the section is, in metres along its axis. */
    sectionAt() {
        return this.plane.constant;
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

    resetCamera() {
        this.camera.position.copy(this.home);
        this.controls.target.copy(this.center);
        this.controls.update();
    }

    /** Turns the camera about what it looks at (rad). */
    orbit(around, down) {
        const away = this.camera.position.clone().sub(this.controls.target);
        // Angles are measured from the vertical, which is z here and y in three.js.
        const turned = new THREE.Spherical().setFromCartesianCoords(away.x, away.z, -away.y);
        turned.theta += around;
        turned.phi = Math.min(Math.max(turned.phi + down, 0.02), Math.PI - 0.02);
        const { x, y, z } = new THREE.Vector3().setFromSpherical(turned);
        this.camera.position.copy(this.controls.target).add(new THREE.Vector3(x, -z, y));
        this.controls.update();
    }

    /** Brings the camera nearer by a factor. */
    zoom(factor) {
        const away = this.camera.position.clone().sub(this.controls.target).multiplyScalar(factor);
        this.camera.position.copy(this.controls.target).add(away);
        this.controls.update();
    }

    /** Looks at a point from where the camera is, from a distance at which this radius (m) is well seen. */
    lookAt(point, radius) {
        const away = this.camera.position.clone().sub(this.controls.target).setLength(radius / Math.sin(radians(HALF_VIEW)));
        this.controls.target.copy(point);
        this.camera.position.copy(point).add(away);
        this.controls.update();
    }

    resize() {
        const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
        if (!width || !height) return;
        const full = Math.min(window.devicePixelRatio || 1, 2);
        this.renderer.setPixelRatio(this.quick ? Math.min(full, 1) : this.soft ? 2 : full);
        this.renderer.setSize(width, height, false);
        [this.width, this.height] = [width, height];
        this.lens(width / height);
        this.stale = true;
    }

    /** Sets the camera for a picture of this shape; a narrow one must not cut off the sides. */
    lens(aspect) {
        if (this.camera.aspect === aspect) return;
        this.camera.aspect = aspect;
        this.camera.fov = 2 * (aspect < 1 ? (Math.atan(Math.tan(radians(HALF_VIEW)) / aspect) * 180) / Math.PI : HALF_VIEW);
        this.camera.updateProjectionMatrix();
    }

    /** With less care: no shadows, no more pixels than the screen needs. */
    setQuick(quick) {
        if (quick === this.quick) return;
        this.quick = quick;
        this.sun.castShadow = !quick;
        this.resize();
    }

    /** Draws what has changed; where drawing is slow with less care while it changes, and once more with all care when it rests. */
    render(now = performance.now()) {
        const rests = !this.stale && this.quick && now - this.drawn > REST;
        if (!this.stale && !rests) return;
        this.setQuick(!rests && (this.soft || this.slow));
        if (!rests) this.drawn = now;
        this.stale = false;
        this.draw();
    }

    /** Draws at once. */
    draw() {
        const panes = this.panes ?? [() => {}];
        const wide = this.width >= this.height;
        const [width, height] = wide ? [this.width / panes.length, this.height] : [this.width, this.height / panes.length];
        this.renderer.setScissorTest(panes.length > 1);
        panes.forEach((choose, i) => {
            choose();
            this.lens(width / height);
            const place = [wide ? i * width : 0, wide ? 0 : this.height - (i + 1) * height, width, height];
            this.renderer.setViewport(...place);
            this.renderer.setScissor(...place);
            this.renderer.render(this.scene, this.camera);
        });
    }
}

/** The edge of the section plane. */
function outline() {
    const corners = [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([x, y]) => new THREE.Vector3(x, y, 0));
    const line = new THREE.LineLoop(new THREE.BufferGeometry().setFromPoints(corners), new THREE.LineBasicMaterial({ color: "#d6336c" }));
    line.visible = false;
    return line;
}

/** In the place of a stage where the browser draws nothing in 3-D: all else of the page can still be used. */
export class NoStage {
    constructor() {
        for (const nothing of ["render", "draw", "toggle", "theme", "resetCamera", "setSection", "orbit", "zoom", "lookAt"]) this[nothing] = () => {};
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
