// The section plane's controls: a box, an axis, and where along it.

import { element, id } from "./dom.js";

export class Section {
    constructor(stage) {
        this.stage = stage;
        this.box = element("input", { type: "checkbox", onchange: () => this.apply() });
        const options = ["x", "y", "z"].map((name, axis) => element("option", { value: axis, text: name }));
        this.axis = element("select", { "aria-label": "Axis of the section", onchange: () => this.apply() }, ...options);
        this.axis.value = "1";
        this.place = element("input", { type: "range", min: 0, max: 1, step: 0.005, value: 0.5, "aria-label": "Place of the section", oninput: () => this.apply() });
        const label = element("label", { title: "key x" }, this.box, element("span", { text: "Section" }));
        id("layers").append(element("span", { class: "section" }, label, this.axis, this.place));
        this.apply();
    }

    toggle() {
        this.box.checked = !this.box.checked;
        this.apply();
    }

    apply() {
        const on = this.box.checked;
        this.axis.hidden = this.place.hidden = !on;
        this.stage.setSection(on ? { axis: Number(this.axis.value), share: Number(this.place.value) } : null);
        if (on) this.place.setAttribute("aria-valuetext", `${"xyz"[this.axis.value]} = ${(this.stage.sectionAt() * 1000).toFixed(1)} mm`);
    }

    key() {
        return [["x"], "Section plane on or off", () => this.toggle()];
    }
}
