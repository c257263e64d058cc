// Puts the page of an object together.

import * as THREE from "three";
import { element, facets, factList, id } from "./dom.js";
import { axes, meshGeometry, painted, place } from "./bodies.js";
import { NoStage, openStage } from "./stage.js";
import { Section } from "./section.js";
import { Layers, Tabs, Theme, cameraKeys, complain, keyboard, layerKeys, pageData } from "./shell.js";

const LAYERS = [
    ["facets", "Facets", "w", false],
    ["axes", "Axes", "a", true],
    ["center", "Centre of mass", "c", true],
    ["tip", "Fingertip to scale", "t", false],
];
/** What can be looked at where there is a contact surface. */
const VIEWS = [
    ["mesh", "The mesh as it is"],
    ["distance", "The mesh, coloured by how far the contact surface is from it"],
    ["twin", "The contact surface, coloured by how far it is from the mesh"],
    ["both", "Both: the contact surface over the mesh"],
];
/** Below, at, and above the mesh (C. Brewer's RdBu, which people who see few colours tell apart). */
const SCALE = ["#2166ac", "#92c5de", "#f2f2f2", "#f4a582", "#b2182b"];

/** The colour of a share from -1 to 1. */
export function colorOf(share) {
    const at = ((Math.min(Math.max(share, -1), 1) + 1) / 2) * (SCALE.length - 1);
    const k = Math.min(Math.floor(at), SCALE.length - 2);
    return new THREE.Color(SCALE[k]).lerp(new THREE.Color(SCALE[k + 1]), at - k);
}

class App {
    constructor(data) {
        this.data = data;
        const all = data.twin ? [...data.twin.heights, ...data.twin.of_mesh] : [];
        this.most = all.reduce((most, x) => Math.max(most, Math.abs(x)), 1e-6);
        this.stage = openStage(id("canvas"), complain) ?? new NoStage();
        if (!(this.stage instanceof NoStage)) this.build(data);
        id("headline").textContent = facets(data.object) + (data.twin ? `; fingertips touch a contact surface of ${facets(data.twin)}` : "");
        this.controls(data);
        const frame = (now) => {
            this.stage.render(now);
            requestAnimationFrame(frame);
        };
        requestAnimationFrame(frame);
    }

    build({ object, twin, center, tip_radius: tip }) {
        const { stage } = this;
        const geometry = meshGeometry(object);
        const add = (part, ...layer) => {
            stage.scene.add(part);
            layer.forEach((key) => stage.layer(key, part));
            return part;
        };
        this.mesh = add(new THREE.Mesh(geometry, painted(stage, geometry)));
        this.mesh.castShadow = true;
        const box = new THREE.Box3().setFromObject(this.mesh);
        stage.open(box);
        const lines = new THREE.LineBasicMaterial({ color: "#101418", transparent: true, opacity: 0.35 });
        this.wire = add(new THREE.LineSegments(new THREE.WireframeGeometry(geometry), lines), "facets");
        geometry.computeBoundingSphere();
        add(axes(geometry.boundingSphere.radius * 1.25), "axes");
        const dot = new THREE.Mesh(new THREE.SphereGeometry(stage.radius * 0.035, 24, 16), new THREE.MeshBasicMaterial({ color: "#d6336c", depthTest: false, transparent: true }));
        dot.renderOrder = 10;
        place(dot, { p: center, q: [1, 0, 0, 0] });
        add(dot, "center");
        if (tip > 0) {
            const ball = new THREE.Mesh(new THREE.SphereGeometry(tip, 32, 20), stage.surface({ color: "#e69f00" }));
            ball.position.set(box.max.x + 1.5 * tip, stage.center.y, stage.center.z);
            add(ball, "tip");
        }
        if (!twin) return;
        this.colored = add(this.coloredMesh(object, twin.of_mesh.map((x) => -x)));
        this.twin = add(this.coloredMesh(twin, twin.heights));
        const edges = new THREE.LineBasicMaterial({ color: "#14181d", transparent: true, opacity: 0.5 });
        this.net = add(new THREE.LineSegments(new THREE.WireframeGeometry(this.twin.geometry), edges));
    }

    /** A mesh whose vertices have these heights of the contact surface over the object (m). */
    coloredMesh(mesh, heights) {
        const geometry = meshGeometry(mesh);
        const colors = new Float32Array(3 * mesh.facets.length);
        mesh.facets.forEach((vertex, i) => colorOf(heights[vertex] / this.most).toArray(colors, 3 * i));
        geometry.setAttribute("color", new THREE.BufferAttribute(colors, 3));
        return new THREE.Mesh(geometry, this.stage.surface({ vertexColors: true }, { roughness: 0.7 }));
    }

    controls(data) {
        const panel = id("move");
        this.tabs = new Tabs([["move", "Surface"], ["facts", "Object"]]);
        this.tabs.open("move");
        id("notes").remove();
        id("facts").append(factList(data.facts));
        if (data.twin) panel.append(this.views(), this.legend());
        else panel.append(element("p", { text: "Fingertips touch the mesh itself: it needs no contact surface of its own." }));
        panel.append(factList(data.facts.slice(0, 4)));
        this.show(data.twin ? "distance" : "mesh");
        this.layers = new Layers(this.stage, LAYERS.filter(([key]) => key !== "tip" || data.tip_radius > 0));
        this.section = new Section(this.stage);
        this.theme = new Theme(this.stage);
        const flip = [["d"], "Dark or light", () => this.theme.flip()];
        const help = [["?", "h"], "This help", () => id("help").showModal()];
        keyboard([...layerKeys(LAYERS.filter(([key]) => this.layers.boxes[key]), this.layers), this.section.key(), ...cameraKeys(this.stage), flip, help]);
    }

    views() {
        this.radios = VIEWS.map(([key, text]) => {
            const radio = element("input", { type: "radio", name: "view", value: key, onchange: () => this.show(key) });
            return [radio, element("label", {}, radio, text)];
        });
        return element("fieldset", { class: "views" }, element("legend", { text: "What is shown" }), ...this.radios.map(([, label]) => label));
    }

    /** The colours with what they mean in millimetres. */
    legend() {
        const mm = (share) => `${share > 0 ? "+" : ""}${(1000 * share * this.most).toPrecision(2)}`.replace(/^\+?-?0\.0$/, "0");
        const ticks = [-1, -0.5, 0, 0.5, 1].map((share) => element("span", { text: share ? mm(share) : "0" }));
        const bar = element("div", { class: "bar", style: `background:linear-gradient(to right, ${SCALE.join(", ")})` });
        const ends = element("div", { class: "ticks" }, element("span", { text: "below the mesh" }), element("span", { text: "above it" }));
        const bound = `A fingertip on it is within ${(Math.ceil(1e5 * this.data.twin.bound) / 100).toFixed(2)} mm of touching the mesh.`;
        return element("figure", { class: "scale" }, element("figcaption", { text: "Contact surface over the mesh (mm)" }), bar, element("div", { class: "ticks" }, ...ticks), ends, element("p", { text: bound }));
    }

    show(view) {
        this.view = view;
        this.radios?.forEach(([radio]) => (radio.checked = radio.value === view));
        if (!this.mesh) return;
        this.mesh.visible = view === "mesh" || view === "both";
        if (this.twin) {
            this.colored.visible = view === "distance";
            this.twin.visible = view === "twin" || view === "both";
            this.net.visible = view === "both" || view === "twin";
            Object.assign(this.twin.material, { transparent: view === "both", opacity: view === "both" ? 0.6 : 1, needsUpdate: true });
        }
        this.stage.stale = true;
    }
}

const app = new App(pageData());

/** For scripts and tests: the page from outside. */
window.regrasp = { app, data: app.data, colorOf: (share) => colorOf(share).getHexString(), readyMs: performance.now() };
document.body.dataset.ready = "true";
