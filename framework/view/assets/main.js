// Puts the page together.

import { Motion, lastNotAfter } from "./motion.js";
import { between, poseAt } from "./pose.js";
import { LAYERS, NoStage, Stage } from "./stage.js";
import { Player } from "./player.js";
import { curves, element } from "./curves.js";
import { SegmentList, segmentDetail, segmentTitle, strip } from "./segments.js";
import { facts, headline } from "./facts.js";
import { GraphTab } from "./graph.js";
import { SPEEDS, bindings, keyName, listen } from "./keys.js";

const id = (name) => document.getElementById(name);

/** Frames longer than this (ms), many in a row, make the page draw with less care while it plays. */
const SLOW_FRAME = 45;

class App {
    constructor(data) {
        this.data = data;
        this.motion = new Motion(data);
        this.player = new Player(this.motion);
        this.stage = this.newStage();
        this.frames = [];
        id("headline").textContent = headline(data, this.motion);
        this.curves = curves(id("curves"), data, this.motion, this.player);
        this.segments = new SegmentList(id("segment-list"), this.motion, this.player);
        facts(id("facts"), data, this.motion, this.player);
        this.graph = data.graph ? new GraphTab(id("graph"), data, this) : null;
        this.tabs();
        this.layers();
        this.transport();
        this.themes();
        this.bindings = bindings(this);
        this.writeHelp();
        listen(this, this.bindings);
        this.player.onChange(() => this.show());
        this.checkTips();
        this.show();
        this.stage.render();
        requestAnimationFrame((now) => this.frame(now));
    }

    newStage() {
        try {
            return new Stage(id("canvas"), this.data, this.motion);
        } catch (error) {
            this.complain(`This browser draws nothing in 3-D (${error.message}); switch WebGL on to see the hand move.`);
            return new NoStage(this.data);
        }
    }

    complain(text) {
        id("problem").hidden = false;
        id("problem").textContent = text;
    }

    /** Whether there is anything of a layer to show. */
    has(layer) {
        if (layer === "obstacles") return this.data.obstacles.length > 0;
        if (layer === "cones") return Boolean(this.data.cone?.mu);
        return layer === "replay" ? Boolean(this.data.replay) : true;
    }

    tabs() {
        const list = id("tabs");
        const names = [["segments", "Segments"], ["facts", "Plan"]];
        if (this.graph) names.push(["graph", "Graph"]);
        this.tabButtons = names.map(([panel, name]) => {
            const button = element("button", { type: "button", role: "tab", id: `tab-${panel}`, "aria-controls": panel, text: name });
            button.addEventListener("click", () => this.openTab(panel));
            list.append(button);
            return button;
        });
        list.addEventListener("keydown", (event) => {
            const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
            if (!step) return;
            const count = names.length;
            const next = (this.tabButtons.indexOf(document.activeElement) + step + count) % count;
            this.openTab(names[next][0]);
            this.tabButtons[next].focus();
        });
        this.openTab(this.motion.states.count || !this.graph ? "segments" : "graph");
    }

    openTab(panel) {
        for (const button of this.tabButtons) {
            const chosen = button.id === `tab-${panel}`;
            button.setAttribute("aria-selected", chosen);
            button.tabIndex = chosen ? 0 : -1;
            id(button.getAttribute("aria-controls")).hidden = !chosen;
        }
        document.body.dataset.tab = panel;
        if (panel !== "graph") this.graph?.release();
        else this.graph.opened();
    }

    layers() {
        this.boxes = {};
        for (const [key, name, letter, shown] of LAYERS) {
            if (!this.has(key)) continue;
            const box = element("input", { type: "checkbox", onchange: () => this.stage.toggle(key, box.checked) });
            box.checked = shown;
            this.boxes[key] = box;
            id("layers").append(element("label", { title: `key ${letter}` }, box, element("span", { text: name })));
        }
    }

    toggle(key) {
        this.boxes[key].checked = !this.boxes[key].checked;
        this.stage.toggle(key, this.boxes[key].checked);
    }

    transport() {
        const { player, motion } = this;
        id("play").addEventListener("click", () => player.togglePlay());
        id("back").addEventListener("click", () => player.stepSegment(-1));
        id("on").addEventListener("click", () => player.stepSegment(1));
        const scrub = id("scrub");
        Object.assign(scrub, { min: motion.begin, max: motion.end, step: "any" });
        scrub.style.setProperty("--strip", strip(motion));
        scrub.addEventListener("input", () => player.seek(Number(scrub.value)));
        const speed = id("speed");
        SPEEDS.forEach((s) => speed.append(element("option", { value: s, text: `${s}×` })));
        speed.addEventListener("change", () => player.setSpeed(Number(speed.value)));
        if (!motion.states.count) document.body.classList.add("still");
    }

    themes() {
        const stored = () => {
            try {
                return localStorage.getItem("regrasp-theme");
            } catch {
                return null; // Some browsers keep nothing for pages from files.
            }
        };
        const preferred = matchMedia("(prefers-color-scheme: dark)");
        this.dark = stored() ? stored() === "dark" : preferred.matches;
        preferred.addEventListener("change", () => {
            if (!stored()) this.setTheme(preferred.matches);
        });
        id("theme").addEventListener("click", () => this.switchTheme());
        this.setTheme(this.dark);
    }

    setTheme(dark) {
        this.dark = dark;
        document.documentElement.dataset.theme = dark ? "dark" : "light";
        const style = getComputedStyle(document.documentElement);
        this.stage.theme(style.getPropertyValue("--stage").trim(), style.getPropertyValue("--grid").trim());
        id("theme").setAttribute("aria-label", dark ? "Switch to light" : "Switch to dark");
    }

    switchTheme() {
        this.setTheme(!this.dark);
        try {
            localStorage.setItem("regrasp-theme", this.dark ? "dark" : "light");
        } catch {
            // Then it lasts as long as the page.
        }
    }

    writeHelp() {
        const list = id("help-list");
        for (const [keys, text] of this.bindings) {
            const names = keys.map((key) => element("kbd", { text: keyName(key) }));
            list.append(element("dt", {}, ...names), element("dd", { text }));
        }
        id("help-button").addEventListener("click", () => this.help());
    }

    help() {
        id("help").showModal();
    }

    /** The page's kinematics must be the program's. */
    checkTips() {
        this.disagreement = this.motion.disagreement(this.data.motion.checks);
        if (this.disagreement > 1e-6) {
            this.complain(`This page puts a fingertip ${(this.disagreement * 1e6).toFixed(1)} µm from where it should be: do not trust it.`);
            console.error("forward kinematics disagree by", this.disagreement, "m");
        }
    }

    /** Shows where the play head is. */
    show() {
        const { player, motion } = this;
        this.graph?.release();
        id("speed").value = String(player.speed);
        document.body.classList.toggle("playing", player.playing);
        id("play").setAttribute("aria-label", player.playing ? "Pause" : "Play");
        if (!motion.states.count) return;
        const snapshot = motion.at(player.time);
        this.snapshot = snapshot;
        this.stage.show(snapshot);
        this.stage.showReplay(this.replayPose(player.time));
        this.curves.forEach((curve) => curve.show(snapshot));
        this.segments.show(snapshot);
        this.caption(snapshot);
        id("scrub").value = String(player.time);
    }

    caption(snapshot) {
        const segment = this.motion.segments[snapshot.segment];
        const title = `Segment ${segment.index} · ${segmentTitle(this.motion, segment)}`;
        id("clock").textContent = `${snapshot.time.toFixed(2)} / ${this.motion.end.toFixed(2)} s`;
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

    replayPose(time) {
        const replay = this.data.replay;
        if (!replay) return null;
        const k = lastNotAfter(replay.times.length, (i) => replay.times[i], time);
        const next = Math.min(k + 1, replay.times.length - 1);
        const step = replay.times[next] - replay.times[k];
        const fraction = step > 0 ? Math.min(Math.max((time - replay.times[k]) / step, 0), 1) : 0;
        return between(poseAt(replay.poses, 7 * k), poseAt(replay.poses, 7 * next), fraction);
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

const app = new App(JSON.parse(id("data").textContent));

/** For scripts and tests: the page from outside. */
window.regrasp = {
    app,
    data: app.data,
    play: () => app.player.play(),
    pause: () => app.player.pause(),
    seek: (time) => app.player.seek(time),
    rate: () => app.rate(),
    /** Everything at a time: object {p, q}, joints, frames of the links, fingertips, contacts. */
    at: (time) => app.motion.at(time),
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
