// A slider for each joint of the hand; driven joints follow.

import { element } from "./dom.js";
import { fingerColor } from "./handbody.js";

const shown = (joint, q) => (joint.slides ? `${(q * 1000).toFixed(1)} mm` : `${((q * 180) / Math.PI).toFixed(1)}°`);

export class JointSliders {
    /** `moved` is called with all joints in a row; `pointed` with the finger that somebody is at, or null. */
    constructor(parent, hand, moved, pointed) {
        Object.assign(this, { hand, moved });
        this.sliders = [];
        this.readings = [];
        hand.fingers.forEach((finger, f) => {
            const title = element("legend", {}, element("i", { style: `background:${fingerColor(f)}` }), finger.name);
            const rows = finger.joints.map((joint, j) => this.row(finger, joint, finger.first + j));
            const group = element("fieldset", { class: "finger" }, title, ...rows);
            for (const [name, at] of [["pointerenter", f], ["focusin", f], ["pointerleave", null], ["focusout", null]]) group.addEventListener(name, () => pointed(at));
            parent.append(group);
        });
        this.set(hand.follow(hand.fingers.flatMap(({ rest }) => rest)));
    }

    row(finger, joint, index) {
        const [low, high] = joint.range;
        const about = joint.mimic ? `${joint.name}, driven by ${finger.joints[joint.mimic.joint].name}` : joint.name;
        const slider = element("input", { type: "range", min: low, max: high, step: "any", "aria-label": `${finger.name}: ${about}` });
        slider.disabled = Boolean(joint.mimic);
        // A joint's range is seldom round: a step of the keys is a hundredth of it.
        slider.addEventListener("keydown", (event) => {
            const step = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageDown: -10, PageUp: 10 }[event.key];
            if (!step) return;
            event.preventDefault();
            this.move(index, Math.min(Math.max(Number(slider.value) + (step * (high - low)) / 100, low), high));
        });
        slider.addEventListener("input", () => this.move(index, Number(slider.value)));
        const reading = element("output");
        this.sliders.push(slider);
        this.readings.push(reading);
        const ends = element("small", { class: "ends", "aria-hidden": "true" }, element("span", { text: shown(joint, low) }), element("span", { text: shown(joint, high) }));
        return element("div", { class: "joint" }, element("span", { class: "joint-name", text: about }), reading, slider, ends);
    }

    move(index, q) {
        const row = [...this.joints];
        row[index] = q;
        this.set(this.hand.follow(row));
    }

    /** Shows these joints and tells of them. */
    set(joints) {
        this.joints = joints;
        this.hand.fingers.flatMap((finger) => finger.joints).forEach((joint, i) => {
            this.sliders[i].value = String(joints[i]);
            this.sliders[i].setAttribute("aria-valuetext", shown(joint, joints[i]));
            this.readings[i].textContent = shown(joint, joints[i]);
        });
        this.moved(joints);
    }
}
