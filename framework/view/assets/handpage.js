// Puts the page of a hand together.

import * as THREE from "three";
import { element, factList, id } from "./dom.js";
import { Hand } from "./hand.js";
import { HandBody, fingerColor } from "./handbody.js";
import { place } from "./bodies.js";
import { JointSliders } from "./joints.js";
import { cloud, reach, touching } from "./reach.js";
import { word } from "./label.js";
import { NoStage, openStage } from "./stage.js";
import { Section } from "./section.js";
import { Layers, Tabs, Theme, cameraKeys, complain, keyboard, layerKeys, pageData } from "./shell.js";

const LAYERS = [
    ["names", "Finger names", "n", true],
    ["tips", "Fingertip balls", "t", true],
    ["links", "Links", "l", true],
    ["reach", "Reach", "r", true],
    ["ball", "Place of a ball", "b", true],
    ["frames", "Frames", "f", false],
];
/** Sampled postures of each finger. */
const POSTURES = 3000;

class App {
    constructor(data) {
        this.data = data;
        this.hand = new Hand(data.hand);
        this.samples = this.hand.fingers.map((_, f) => reach(this.hand, f, POSTURES));
        this.stage = openStage(id("canvas"), complain) ?? new NoStage();
        if (!(this.stage instanceof NoStage)) this.build(data);
        const { fingers, jointCount } = this.hand;
        id("headline").textContent = `${fingers.length} fingers, ${jointCount} joints, fingertips of ${(1000 * data.hand.tip_radius).toFixed(1)} mm radius`;
        this.controls(data);
        const checks = data.checks.map(({ joints, tips }) => this.hand.disagreement(joints, tips));
        this.disagreement = Math.max(0, ...checks);
        if (this.disagreement > 1e-6) complain(`This page puts a fingertip ${(this.disagreement * 1e6).toFixed(1)} µm from where it should be: do not trust it.`);
        const frame = (now) => {
            this.stage.render(now);
            requestAnimationFrame(frame);
        };
        requestAnimationFrame(frame);
    }

    build(data) {
        const { stage, hand } = this;
        const size = data.hand.tip_radius;
        this.body = new HandBody(stage, data.hand);
        stage.scene.add(this.body.root);
        this.clouds = this.samples.map((samples, f) => cloud(samples, fingerColor(f), size * 0.24));
        stage.scene.add(...this.clouds);
        stage.layer("reach", ...this.clouds);
        const row = hand.follow(hand.fingers.flatMap(({ rest }) => rest));
        this.body.pose(hand.links(row));
        this.body.root.updateMatrixWorld(true);
        const box = new THREE.Box3();
        [...this.body.solids(), ...this.clouds].forEach((part) => box.expandByObject(part));
        if (data.ball) this.ball(data, box);
        stage.open(box);
        this.body.frames(data.hand);
        this.words = hand.fingers.map(({ name }, f) => word(name, stage.radius * 0.05, fingerColor(f)));
        stage.scene.add(...this.words);
        stage.layer("names", ...this.words);
        stage.layer("tips", ...this.body.fingers.map(({ tip }) => tip));
        stage.layer("links", this.body.palm, ...this.body.fingers.flatMap(({ shapes }) => shapes));
    }

    ball(data, box) {
        const material = new THREE.MeshLambertMaterial({ color: "#8b5cf6", transparent: true, opacity: 0.45, depthWrite: false });
        const ball = new THREE.Mesh(new THREE.SphereGeometry(data.ball_radius, 48, 32), material);
        place(ball, { p: data.ball.position, q: [1, 0, 0, 0] });
        this.stage.scene.add(ball);
        this.stage.layer("ball", ball);
        box.expandByObject(ball);
    }

    controls(data) {
        this.tabs = new Tabs([["move", "Joints"], ["facts", "Hand"], ["notes", "Notes"]]);
        this.tabs.open("move");
        this.buttons(data);
        this.sliders = new JointSliders(id("move"), this.hand, (joints) => this.pose(joints), (finger) => this.point(finger));
        id("facts").append(this.quality(data), factList(data.facts));
        id("notes").append(...data.lists.flatMap(([heading, lines]) => [element("h2", { text: heading }), listOf(lines)]));
        if (!data.lists.length) id("notes").append(element("p", { text: "There is nothing to note." }));
        this.layers = new Layers(this.stage, LAYERS.filter(([key]) => key !== "ball" || data.ball));
        this.section = new Section(this.stage);
        this.theme = new Theme(this.stage);
        const flip = [["d"], "Dark or light", () => this.theme.flip()];
        const help = [["?", "h"], "This help", () => id("help").showModal()];
        keyboard([...layerKeys(LAYERS.filter(([key]) => this.layers.boxes[key]), this.layers), this.section.key(), ...cameraKeys(this.stage), flip, help]);
    }

    buttons(data) {
        const row = (pick) => this.hand.follow(this.hand.fingers.flatMap((finger) => finger.joints.map((joint, j) => pick(joint, finger.rest[j]))));
        const middle = ({ range: [low, high] }) => (low + high) / 2;
        const postures = [["Rest", () => row((_, rest) => rest)], ["Middle", () => row(middle)]];
        if (data.ball) postures.push(["At the ball", () => this.atBall(data)]);
        const buttons = postures.map(([text, joints]) => element("button", { type: "button", class: "chip", text, onclick: () => this.sliders.set(joints()) }));
        this.told = element("p", { class: "told", role: "status" });
        id("move").append(element("div", { class: "postures", role: "group", "aria-label": "Postures" }, ...buttons), this.told);
    }

    /** The sampled postures in which the fingertips come nearest to holding the ball. */
    atBall(data) {
        const distance = data.ball_radius + data.hand.tip_radius;
        const found = this.samples.map((samples) => touching(samples, data.ball.position, distance));
        this.told.textContent = `Of ${POSTURES} postures a finger those nearest to the ball: tips within ${(1000 * Math.max(...found.map(({ off }) => off))).toFixed(1)} mm of touching it.`;
        return found.flatMap(({ own }) => own);
    }

    quality({ ball, ball_radius: radius }) {
        const size = `a ball of ${(2000 * radius).toFixed(0)} mm`;
        if (!ball) return element("p", { text: `No place was found at which all fingertips reach ${size}.` });
        const at = ball.position.map((x) => (1000 * x).toFixed(0)).join(", ");
        const meter = element("meter", { min: 0, max: 1, value: ball.quality, "aria-label": "How well the fingers surround the ball" });
        return element("p", { class: "quality" }, `The fingertips surround ${size} best at ${at} mm: quality ${ball.quality.toFixed(2)} of 1 `, meter);
    }

    pose(joints) {
        this.joints = joints;
        const links = this.hand.links(joints);
        this.tips = this.hand.tips(links);
        if (!this.body) return;
        this.links = links;
        this.body.pose(links, this.pointed);
        this.words.forEach((sprite, f) => sprite.position.set(...this.tips[f]).setZ(this.tips[f][2] + 2.2 * this.hand.tipRadius));
        this.stage.stale = true;
    }

    /** Lights up the finger whose sliders somebody is at, and its reach alone. */
    point(finger) {
        this.pointed = finger;
        if (!this.body) return;
        this.body.pose(this.links, finger);
        this.clouds.forEach(({ material }, f) => (material.opacity = finger === null || finger === f ? 0.55 : 0.06));
        this.stage.stale = true;
    }
}

const listOf = (lines) => element("ul", { class: "lines" }, ...lines.map((text) => element("li", { text: text.replaceAll("`", "") })));

const app = new App(pageData());

/** For scripts and tests: the page from outside. */
window.regrasp = { app, data: app.data, disagreement: app.disagreement, readyMs: performance.now() };
document.body.dataset.ready = "true";
