// Figures over time, with the play head on them.

const SVG = "http://www.w3.org/2000/svg";

export function element(name, attributes = {}, ...children) {
    const node = document.createElement(name);
    for (const [key, value] of Object.entries(attributes)) {
        if (key === "text") node.textContent = value;
        else if (key.startsWith("on")) node.addEventListener(key.slice(2), value);
        else if (value !== null && value !== undefined) node.setAttribute(key, value);
    }
    node.append(...children);
    return node;
}

export function drawing(name, attributes = {}, ...children) {
    const node = document.createElementNS(SVG, name);
    for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
    node.append(...children);
    return node;
}

const [WIDTH, HEIGHT] = [1000, 100];

/** One curve: `values` hold a number or null for each state; `digits` shows one. */
export class Curve {
    constructor(parent, motion, player, { name, values, digits, note }) {
        Object.assign(this, { motion, values, digits, note });
        const known = values.filter((value) => value !== null);
        this.top = Math.max(...known, 1e-9) * 1.08;
        this.bottom = Math.min(...known, 0) * 1.08;
        this.reading = element("output", { class: "reading" });
        this.note = note;
        // What moves lies above the drawing, not in it: drawing a curve anew in every frame would cost more than the scene.
        this.line = element("span", { class: "head", "aria-hidden": "true" });
        this.dot = element("span", { class: "dot", "aria-hidden": "true" });
        const least = values.indexOf(Math.min(...known));
        const low = element("span", { class: "low", title: `smallest: ${digits(values[least])}` });
        this.move(low, motion.time[least], values[least]);
        const picture = drawing("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, preserveAspectRatio: "none", "aria-hidden": "true" });
        picture.append(...this.bands(), this.area(true), this.area(false));
        const summary = `${name} over time: from ${digits(values[least])} to ${digits(Math.max(...known))}`;
        const plot = element("div", { class: "plot", role: "img", "aria-label": summary }, picture, low, this.line, this.dot);
        follow(plot, (fraction) => player.seek(motion.begin + fraction * motion.duration));
        const title = element("div", { class: "curve-title" }, element("span", { text: name }), this.reading);
        parent.append(element("figure", { class: "curve" }, title, plot));
    }

    x(time) {
        return this.motion.duration > 0 ? ((time - this.motion.begin) / this.motion.duration) * WIDTH : 0;
    }

    y(value) {
        return HEIGHT - ((value - this.bottom) / (this.top - this.bottom)) * HEIGHT;
    }

    bands() {
        const regrasps = this.motion.segments.filter((segment) => segment.kind === "regrasp");
        return regrasps.map((s) => drawing("rect", { class: "band", x: this.x(s.start), width: this.x(s.end) - this.x(s.start), y: 0, height: HEIGHT }));
    }

    area(filled) {
        const points = [];
        let open = false;
        this.values.forEach((value, k) => {
            if (value !== null) points.push(`${open ? "L" : "M"}${this.x(this.motion.time[k]).toFixed(2)} ${this.y(value).toFixed(2)}`);
            open = value !== null;
        });
        if (!filled) return drawing("path", { class: "line", d: points.join("") });
        const whole = this.values.every((value) => value !== null);
        return drawing("path", { class: "fill", d: whole ? `${points.join("")}L${WIDTH} ${HEIGHT}L0 ${HEIGHT}Z` : "" });
    }

    move(mark, time, value) {
        mark.style.left = `${this.x(time) / 10}%`;
        mark.style.top = `${this.y(value)}%`;
    }

    show(snapshot) {
        const [a, b] = [this.values[snapshot.state], this.values[snapshot.fraction > 0 ? snapshot.state + 1 : snapshot.state]];
        const value = a === null || b === null ? null : a + (b - a) * snapshot.fraction;
        this.line.style.left = `${this.x(snapshot.time) / 10}%`;
        this.dot.hidden = value === null;
        if (value !== null) this.move(this.dot, snapshot.time, value);
        const note = this.note ? this.note(snapshot.state) : "";
        this.reading.textContent = value === null ? "none" : `${this.digits(value)}${note ? ` · ${note}` : ""}`;
    }
}

/** Calls `seek` with where along its width (0 to 1) the pointer is, while it is pressed. */
function follow(plot, seek) {
    const at = (event) => {
        const box = plot.getBoundingClientRect();
        seek(Math.min(Math.max((event.clientX - box.left) / box.width, 0), 1));
    };
    plot.addEventListener("pointerdown", (event) => {
        plot.setPointerCapture(event.pointerId);
        at(event);
    });
    plot.addEventListener("pointermove", (event) => plot.hasPointerCapture(event.pointerId) && at(event));
}

/** The curves that the data have. */
export function curves(parent, data, motion, player) {
    if (!data.curves || !motion.states.count) return [];
    const { margin, clearance, pair, pairs, margin_name: name } = data.curves;
    const list = [];
    const some = (values) => values.some((value) => value !== null);
    if (some(margin)) {
        list.push(new Curve(parent, motion, player, { name, values: margin, digits: (x) => x.toFixed(4) }));
    }
    if (some(clearance)) {
        const digits = (x) => `${(x * 1000).toFixed(2)} mm`;
        const note = (state) => pairs[pair[state]].replaceAll("`", "");
        list.push(new Curve(parent, motion, player, { name: "Clearance", values: clearance, digits, note }));
    }
    return list;
}
