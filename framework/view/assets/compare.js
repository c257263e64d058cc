// Several plans in one page: which one the lists and plots are about, and how the scene shows the others.

import { element, id } from "./dom.js";

/** Colours that tell plans apart in plots. */
export const PLAN_COLORS = ["#2457d6", "#b3541e", "#0f7b6c", "#8b3fa0", "#6b6f1d", "#a3305b"];

const MODES = [["overlay", "overlaid"], ["beside", "side by side"], ["alone", "alone"]];
const CLOCKS = [["time", "same time"], ["share", "same share of the motion"]];

const menu = (label, choices, changed) => {
    const options = choices.map(([value, text]) => element("option", { value, text }));
    const select = element("select", { onchange: () => changed(select.value) }, ...options);
    return [element("label", {}, element("span", { text: label }), select), select];
};

export class Compare {
    /** `shown` are the plans; `app` is told when another one is chosen. */
    constructor(app, shown) {
        Object.assign(this, { app, shown, active: 0, mode: shown.length > 1 ? "overlay" : "alone", clock: "time" });
        if (shown.length < 2) return;
        const [plan, select] = menu("Plan", shown.map(({ label }, i) => [i, label]), (i) => app.choose(Number(i)));
        const [mode] = menu("Plans", MODES, (value) => this.set({ mode: value }));
        const [clock] = menu("In step by", CLOCKS, (value) => this.set({ clock: value }));
        this.select = select;
        id("compare").append(plan, mode, clock);
        id("compare").hidden = false;
    }

    set(change) {
        Object.assign(this, change);
        this.app.choose(this.active);
    }

    /** Chooses a plan. */
    choose(index) {
        this.active = index;
        if (this.select) this.select.value = String(index);
        this.arrange();
    }

    /** What time a plan is at when the clock, which is the chosen plan's, shows `time`. */
    timeOf(index, time) {
        const [{ motion }, chosen] = [this.shown[index], this.shown[this.active].motion];
        const share = chosen.duration > 0 ? (time - chosen.begin) / chosen.duration : 0;
        const own = this.clock === "share" && index !== this.active ? motion.begin + share * motion.duration : time;
        return Math.min(Math.max(own, motion.begin), motion.end);
    }

    /** From when to when the clock runs: until the longest plan has ended, or the chosen one. */
    span() {
        const all = this.clock === "share" ? [this.shown[this.active]] : this.shown;
        const moving = all.filter(({ motion }) => motion.states.count);
        if (!moving.length) return [0, 0];
        return [Math.min(...moving.map(({ motion }) => motion.begin)), Math.max(...moving.map(({ motion }) => motion.end))];
    }

    arrange() {
        this.app.player.setSpan(this.span());
        const { actors, stage } = this.app;
        const only = (i) => () => actors.forEach((actor, k) => (actor.root.visible = k === i));
        actors.forEach((actor, i) => {
            actor.root.visible = this.mode === "overlay" || i === this.active;
            actor.setFaint(this.mode === "overlay" && i !== this.active);
        });
        stage.panes = this.mode === "beside" ? actors.map((_, i) => only(i)) : null;
        const names = this.mode === "beside" ? this.shown.map(({ label }) => element("span", { text: label })) : [];
        id("pane-names").replaceChildren(...names);
        stage.stale = true;
    }
}
