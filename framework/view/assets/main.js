// Puts the page of a plan, or of several in step, together.

import * as THREE from "three";
import { Motion, lastNotAfter } from "./motion.js";
import { between, poseAt } from "./pose.js";
import { NoStage, openStage } from "./stage.js";
import { Actor, LAYERS, Spotlight } from "./actor.js";
import { Player } from "./player.js";
import { element, id } from "./dom.js";
import { Layers, Tabs, Theme, cameraKeys, complain, keyboard, layerKeys, pageData } from "./shell.js";
import { Section } from "./section.js";
import { SegmentList, segmentDetail, segmentTitle, strip } from "./segments.js";
import { facts, headline } from "./facts.js";
import { GraphTab } from "./graph.js";
import { PlotBar } from "./plotbar.js";
import { Compare, PLAN_COLORS } from "./compare.js";
import { Recorder } from "./record.js";
import { SPEEDS, playKeys } from "./keys.js";

/** Frames longer than this (ms), many in a row, make the page draw with less care while it plays. */
const SLOW_FRAME = 45;

class App {
    constructor(first) {
        const all = [first, ...(first.beside ?? []).map((other) => whole(other, first))];
        this.shown = all.map((data, i) => ({ data, motion: new Motion(data), label: data.label, color: PLAN_COLORS[i % PLAN_COLORS.length] }));
        this.player = new Player(this.shown[0].motion);
        this.frames = [];
        this.openStage();
        this.compare = new Compare(this, this.shown);
        this.plots = new PlotBar(this.player);
        const panels = [["segments", "Segments"], ["facts", "Plan"]];
        if (all.some((data) => data.graph)) panels.push(["graph", "Graph"]);
        this.tabs = new Tabs(panels, (panel) => (panel === "graph" ? this.graph?.opened() : this.graph?.release()));
        this.choose(0);
        this.tabs.open(this.motion.states.count || !this.graph ? "segments" : "graph");
        this.controls();
        this.player.onChange(() => this.show());
        this.checkTips();
        this.show();
        this.stage.render();
        requestAnimationFrame((now) => this.frame(now));
    }

    openStage() {
        this.actors = [];
        this.stage = openStage(id("canvas"), complain) ?? new NoStage();
        if (this.stage instanceof NoStage) return;
        this.actors = this.shown.map(({ data, motion }) => new Actor(this.stage, data, motion));
        const box = new THREE.Box3();
        this.actors.forEach((actor) => actor.measure(box));
        this.stage.open(box);
        this.actors.forEach((actor) => actor.finish());
        this.spotlight = new Spotlight(this.stage);
    }

    get data() {
        return this.shown[this.compare.active].data;
    }

    get motion() {
        return this.shown[this.compare.active].motion;
    }

    /** Makes lists, plots and marks those of this plan. */
    choose(index) {
        this.compare.choose(index);
        const { data, motion } = this;
        this.player.motion = motion;
        this.captioned = this.snapshot = null;
        id("headline").textContent = headline(data, motion);
        id("segment-list").replaceChildren();
        this.segments = new SegmentList(id("segment-list"), motion, this.player);
        facts(id("facts"), this.shown[index], this.actors[index]?.arrowScale(), (check) => this.visit(check));
        id("graph").replaceChildren();
        this.graph = data.graph ? new GraphTab(id("graph"), data, this) : null;
        this.plots.open(this.shown[index], this.shown.filter((_, i) => i !== index));
        Object.assign(id("scrub"), { min: this.player.begin, max: this.player.end, step: "any" });
        id("scrub").style.setProperty("--strip", strip(motion, this.player));
        this.show();
    }

    /** Goes to a check's place in time, and shows it in the scene. */
    visit(check) {
        this.player.pause();
        this.player.seek(check.time);
        const actor = this.actors[this.compare.active];
        if (!actor) return;
        const finger = check.finger;
        const joint = finger === null || check.joint === null ? null : { link: [finger, check.joint] };
        const bodies = check.pair ?? [joint ?? (finger === null ? "object" : { fingertip: finger })];
        this.spotlight.on(bodies.map((body) => actor.part(body)).filter(Boolean));
        this.lit = true;
        this.title(`Check ${check.name}: ${check.ok ? "ok" : "FAILED"}`, check.place.replaceAll("`", ""));
    }

    /** Whether there is anything of a layer to show. */
    has(layer) {
        const some = (test) => this.shown.some(({ data }) => test(data));
        if (layer === "obstacles") return some((data) => data.obstacles.length > 0);
        if (layer === "cones") return some((data) => data.cone?.mu);
        if (layer === "forces") return this.actors.some((actor) => actor.forces);
        return layer === "replay" ? some((data) => data.replay) : true;
    }

    controls() {
        const { player } = this;
        const layers = LAYERS.filter(([key]) => this.has(key));
        this.layers = new Layers(this.stage, layers);
        this.section = new Section(this.stage);
        this.theme = new Theme(this.stage);
        this.recorder = this.actors.length ? new Recorder(this) : null;
        id("record-button").hidden = !this.recorder;
        id("play").addEventListener("click", () => player.togglePlay());
        id("back").addEventListener("click", () => player.stepSegment(-1));
        id("on").addEventListener("click", () => player.stepSegment(1));
        const scrub = id("scrub");
        scrub.addEventListener("input", () => player.seek(Number(scrub.value)));
        const speed = id("speed");
        SPEEDS.forEach((s) => speed.append(element("option", { value: s, text: `${s}×` })));
        speed.addEventListener("change", () => player.setSpeed(Number(speed.value)));
        if (!this.shown.some(({ motion }) => motion.states.count)) document.body.classList.add("still");
        keyboard([...playKeys(this), ...layerKeys(layers, this.layers), this.section.key(), ...cameraKeys(this.stage)]);
    }

    /** The page's kinematics must be the program's. */
    checkTips() {
        this.disagreement = Math.max(...this.shown.map(({ data, motion }) => motion.disagreement(data.motion.checks)));
        if (this.disagreement > 1e-6) {
            complain(`This page puts a fingertip ${(this.disagreement * 1e6).toFixed(1)} µm from where it should be: do not trust it.`);
            console.error("forward kinematics disagree by", this.disagreement, "m");
        }
    }

    /** Shows where the play head is. */
    show() {
        const { player, motion, compare } = this;
        this.graph?.release();
        this.darken();
        id("speed").value = String(player.speed);
        document.body.classList.toggle("playing", player.playing);
        id("play").setAttribute("aria-label", player.playing ? "Pause" : "Play");
        this.actors.forEach((actor, i) => {
            const own = this.shown[i];
            if (i === compare.active || !own.motion.states.count) return;
            actor.show(own.motion.at(compare.timeOf(i, player.time)));
        });
        if (!motion.states.count) return;
        const snapshot = motion.at(compare.timeOf(compare.active, player.time));
        this.snapshot = snapshot;
        this.pose(snapshot);
        this.actors.forEach((actor, i) => actor.showReplay(replayPose(this.shown[i].data.replay, compare.timeOf(i, player.time))));
        this.plots.show(snapshot.time);
        this.segments.show(snapshot);
        this.caption(snapshot);
        id("scrub").value = String(player.time);
    }

    /** Puts the chosen plan's hand and object into a state. */
    pose(snapshot) {
        this.actors[this.compare.active]?.show(snapshot);
    }

    darken() {
        if (!this.lit) return;
        this.lit = false;
        this.captioned = null;
        this.spotlight.clear();
    }

    caption(snapshot) {
        const segment = this.motion.segments[snapshot.segment];
        const title = `Segment ${segment.index + 1} · ${segmentTitle(this.motion, segment)}`;
        id("clock").textContent = `${snapshot.time.toFixed(2)} / ${this.player.end.toFixed(2)} s`;
        if (this.captioned === segment.index) return;
        this.captioned = segment.index;
        this.title(title, segmentDetail(this.motion, segment));
        id("scrub").setAttribute("aria-valuetext", title);
    }

    /** What the scene shows, in words. */
    title(title, detail) {
        id("caption-title").textContent = title;
        id("caption-detail").textContent = detail;
    }

    frame(now) {
        this.player.tick(now);
        this.stage.render(now);
        this.frames.push(now);
        if (this.frames.length > 40) this.frames.shift();
        if (this.player.playing && this.frames.length === 40 && now - this.frames[0] > 39 * SLOW_FRAME) this.stage.slow = true;
        requestAnimationFrame((next) => this.frame(next));
    }

    /** Frames a second, over the last ones. */
    rate() {
        const n = this.frames.length - 1;
        return n > 0 ? (1000 * n) / (this.frames[n] - this.frames[0]) : 0;
    }
}

/** A plan's data with what it shares with the first plan. */
function whole(other, first) {
    const { hand, object, obstacles } = first;
    return { ...other, hand: other.hand ?? hand, object: other.object ?? object, obstacles: other.obstacles ?? obstacles };
}

function replayPose(replay, time) {
    if (!replay) return null;
    const k = lastNotAfter(replay.times.length, (i) => replay.times[i], time);
    const next = Math.min(k + 1, replay.times.length - 1);
    const step = replay.times[next] - replay.times[k];
    const fraction = step > 0 ? Math.min(Math.max((time - replay.times[k]) / step, 0), 1) : 0;
    return between(poseAt(replay.poses, 7 * k), poseAt(replay.poses, 7 * next), fraction);
}

const app = new App(pageData());

/** For scripts and tests: the page from outside. */
window.regrasp = {
    app,
    play: () => app.player.play(),
    pause: () => app.player.pause(),
    seek: (time) => app.player.seek(time),
    rate: () => app.rate(),
    /** Everything at a time: object {p, q}, joints, frames of the links, fingertips, contacts, forces. */
    at: (time) => app.motion.at(time),
    get data() {
        return app.data;
    },
    get time() {
        return app.player.time;
    },
    get playing() {
        return app.player.playing;
    },
    get segment() {
        return app.snapshot ? app.snapshot.segment : null;
    },
    disagreement: app.disagreement,
    readyMs: performance.now(),
};
document.body.dataset.ready = "true";
