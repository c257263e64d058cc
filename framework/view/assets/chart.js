// A plot over time: axes with ticks and units, the limit as a line, values under the pointer and at the play head.

import { drawing, element } from "./dom.js";
import { lastNotAfter } from "./motion.js";

/** Room (px) for the ticks on the left and below, and a little on the other sides. */
const PAD = { left: 42, right: 10, top: 7, bottom: 17 };
/** What is more than this many times the limit is drawn at the upper edge, and said. */
const MOST_OF_LIMIT = 3;

/** Round steps that divide a range into about `count`. */
export function ticks(low, high, count) {
    const raw = (high - low) / Math.max(count, 1);
    const power = 10 ** Math.floor(Math.log10(raw));
    const step = [1, 2, 5, 10].map((m) => m * power).find((s) => s >= raw * 0.999);
    const list = [];
    for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) list.push(Number((k * step).toPrecision(10)));
    return list;
}

/** The value of a series at a time: linear between its samples; null in a gap, or outside. */
export function valueAt({ times, values }, time) {
    if (!times.length || time < times[0] - 1e-9 || time > times.at(-1) + 1e-9) return null;
    const k = lastNotAfter(times.length, (i) => times[i], time);
    const next = Math.min(k + 1, times.length - 1);
    const [a, b] = [values[k], values[next]];
    if (time <= times[k] || next === k) return a;
    if (a === null || b === null) return null;
    return a + ((b - a) * (time - times[k])) / (times[next] - times[k]);
}

/**
 * `sets` are the choices of curves, each `{ name, series: [{ name, color, times, values }] }`; `limit` is `{ value, label, above }`, `above`
 * where values must stay over it; `bands` are the shaded times, `span` is where time begins and ends; `note(time)` gives words below the plot.
 */
export class Chart {
    constructor(parent, { name, unit, digits, sets, limit, bands, span, note, remark, seek }) {
        Object.assign(this, { name, unit, digits, sets, limit, bands, span, note, remark });
        this.series = sets[0].series;
        this.reading = element("output", { class: "reading" });
        this.svg = drawing("svg", { "aria-hidden": "true" });
        this.head = element("span", { class: "head", "aria-hidden": "true" });
        this.cursor = element("span", { class: "cursor", "aria-hidden": "true" });
        this.tip = element("div", { class: "tip", "aria-hidden": "true" });
        this.cursor.hidden = this.tip.hidden = true;
        this.area = element("div", { class: "area" }, this.cursor, this.head);
        this.plot = element("div", { class: "plot", role: "img" }, this.svg, this.area, this.tip);
        this.capped = element("small", { class: "capped" });
        const title = element("figcaption", { class: "curve-title" }, element("span", { text: `${name} (${unit || "no unit"})` }), this.choice(), this.reading);
        this.under = element("small", { class: "capped" });
        this.figure = element("figure", { class: "curve" }, title, this.plot, this.under, this.capped);
        parent.append(this.figure);
        this.listen(seek);
        this.choose(0);
        // The first drawing is made when there is room for it, which the page does not wait for.
        new ResizeObserver(() => this.draw()).observe(this.plot);
    }

    /** A menu of the curves that can be shown; nothing where there is one choice. */
    choice() {
        if (this.sets.length < 2) return "";
        const options = this.sets.map((set, i) => element("option", { value: i, text: set.name }));
        return element("select", { "aria-label": `Curves of ${this.name}`, onchange: (event) => this.choose(Number(event.target.value)) }, ...options);
    }

    choose(index) {
        this.series = this.sets[index].series;
        const limit = this.limit?.value ?? 0;
        [this.least, this.most] = extremes(this.series);
        const cap = limit > 0 && !this.limit.above ? MOST_OF_LIMIT * limit : Infinity;
        const over = this.most > cap;
        const top = over ? cap : Math.max(this.most, limit, 1e-9);
        const bottom = Math.min(this.least, limit, 0);
        const room = 0.08 * (top - bottom);
        [this.top, this.bottom] = [top + room, bottom < 0 ? bottom - room : 0];
        this.capped.textContent = [this.remark, over ? `drawn up to ${this.digits(cap)}; largest: ${this.digits(this.most)}` : ""].filter(Boolean).join(" · ");
        this.plot.setAttribute("aria-label", this.summary());
        this.dots = this.series.map((s) => element("span", { class: "dot", style: `--own:${s.color}`, "aria-hidden": "true" }));
        this.area.replaceChildren(this.cursor, this.head, ...this.dots);
        if (this.drawn) this.draw();
        if (this.time !== undefined) this.show(this.time);
    }

    summary() {
        const range = `from ${this.digits(this.least)} to ${this.digits(this.most)}`;
        return `${this.name} over time: ${range}${this.limit ? `; ${this.limit.label}` : ""}`;
    }

    x(time) {
        const [begin, end] = this.span;
        return end > begin ? (time - begin) / (end - begin) : 0;
    }

    y(value) {
        return 1 - Math.min(Math.max((value - this.bottom) / (this.top - this.bottom), 0), 1);
    }

    /** Draws anew, in pixels, so that texts are sharp. */
    draw() {
        const [width, height] = [this.plot.clientWidth, this.plot.clientHeight];
        if (!width || !height) return;
        this.drawn = true;
        const [w, h] = [width - PAD.left - PAD.right, height - PAD.top - PAD.bottom];
        const [X, Y] = [(t) => PAD.left + w * this.x(t), (v) => PAD.top + h * this.y(v)];
        this.svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
        const bands = this.bands.map((s) => drawing("rect", { class: "band", x: X(s.start), width: Math.max(X(s.end) - X(s.start), 0), y: PAD.top, height: h }));
        const lines = this.series.map((s) => drawing("path", { class: "line", d: path(s, X, Y), style: `--own:${s.color}${s.faint ? ";stroke-dasharray:4 3" : ""}` }));
        const rows = ticks(this.bottom, this.top, h / 26).flatMap((v) => [
            drawing("line", { class: "grid", x1: PAD.left, x2: width - PAD.right, y1: Y(v), y2: Y(v) }),
            drawing("text", { class: "tick", x: PAD.left - 5, y: Y(v) + 3.5, "text-anchor": "end" }, this.digits(v, true)),
        ]);
        const columns = ticks(...this.span, w / 70).flatMap((t) => [
            drawing("line", { class: "grid", x1: X(t), x2: X(t), y1: PAD.top + h, y2: PAD.top + h + 3 }),
            drawing("text", { class: "tick", x: X(t), y: height - 3, "text-anchor": X(t) > width - 24 ? "end" : "middle" }, `${t} s`),
        ]);
        this.svg.replaceChildren(...bands, drawing("g", { class: "axis-y" }, ...rows), drawing("g", { class: "axis-x" }, ...columns), ...this.limitLine(X, Y, width), ...lines, ...this.worst(X, Y));
    }

    limitLine(X, Y, width) {
        if (!this.limit) return [];
        const y = Y(this.limit.value);
        const text = drawing("text", { class: "limit-label", x: width - PAD.right - 2, y: y > 22 ? y - 3 : y + 11, "text-anchor": "end" }, this.limit.label);
        return [drawing("line", { class: "limit", x1: PAD.left, x2: width - PAD.right, y1: y, y2: y }), text];
    }

    /** A ring at the value that is nearest its limit. */
    worst(X, Y) {
        const better = this.limit?.above ? (a, b) => a < b : (a, b) => a > b;
        let found = null;
        for (const { times, values, faint } of this.series) {
            if (faint) continue;
            values.forEach((value, k) => {
                if (value !== null && (!found || better(value, found.value))) found = { value, time: times[k] };
            });
        }
        return found ? [drawing("circle", { class: "low", cx: X(found.time), cy: Y(found.value), r: 3.5 })] : [];
    }

    show(time) {
        this.time = time;
        this.head.style.left = `${100 * this.x(time)}%`;
        const values = this.series.map((s) => valueAt(s, time));
        values.forEach((value, i) => {
            this.dots[i].hidden = value === null;
            if (value === null) return;
            this.dots[i].style.left = `${100 * this.x(time)}%`;
            this.dots[i].style.top = `${100 * this.y(value)}%`;
        });
        this.reading.textContent = this.words(values);
        if (this.note) this.under.textContent = this.note(time);
    }

    /** The value, or the worst of several and whose it is. */
    words(values) {
        const known = values.map((value, i) => [value, this.series[i]]).filter(([value, s]) => value !== null && !s.faint);
        if (!known.length) return "none";
        const [value, s] = known.reduce((a, b) => ((this.limit?.above ? b[0] < a[0] : b[0] > a[0]) ? b : a));
        return `${this.digits(value)}${known.length > 1 ? ` ${s.name}` : ""}`;
    }

    /** Seeks while pressed, and shows the values under the pointer. */
    listen(seek) {
        const time = (event) => {
            const box = this.area.getBoundingClientRect();
            const share = Math.min(Math.max((event.clientX - box.left) / box.width, 0), 1);
            return this.span[0] + share * (this.span[1] - this.span[0]);
        };
        this.plot.addEventListener("pointerdown", (event) => {
            this.plot.setPointerCapture(event.pointerId);
            seek(time(event));
        });
        this.plot.addEventListener("pointermove", (event) => {
            if (this.plot.hasPointerCapture(event.pointerId)) seek(time(event));
            this.hover(time(event));
        });
        this.plot.addEventListener("pointerleave", () => (this.cursor.hidden = this.tip.hidden = true));
    }

    hover(time) {
        this.cursor.hidden = this.tip.hidden = false;
        const share = this.x(time);
        this.cursor.style.left = `${100 * share}%`;
        const rows = this.series.map((s) => {
            const value = valueAt(s, time);
            return element("span", {}, element("i", { style: `--own:${s.color}` }), `${s.name} ${value === null ? "none" : this.digits(value)}`);
        });
        this.tip.replaceChildren(element("b", { text: `${time.toFixed(2)} s` }), ...rows);
        this.tip.classList.toggle("left", share > 0.5);
    }
}

/** The least and the largest value of some series; 0 where there are none. */
function extremes(series) {
    let [least, most] = [Infinity, -Infinity];
    for (const { values } of series) {
        for (const value of values) {
            if (value === null) continue;
            if (value < least) least = value;
            if (value > most) most = value;
        }
    }
    return least <= most ? [least, most] : [0, 0];
}

/** A series as a line; points that nobody could tell from the one before are left out. */
function path({ times, values }, X, Y) {
    let [d, open, left, above] = ["", false, 0, 0];
    values.forEach((value, k) => {
        if (value !== null) {
            const [x, y] = [X(times[k]), Y(value)];
            const near = open && Math.abs(x - left) < 0.4 && Math.abs(y - above) < 0.4 && values[k + 1] !== null && k + 1 < values.length;
            if (!near) {
                d += `${open ? "L" : "M"}${x.toFixed(1)} ${y.toFixed(1)}`;
                [left, above] = [x, y];
            }
        }
        open = value !== null;
    });
    return d;
}
