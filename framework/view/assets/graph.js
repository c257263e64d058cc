// The manipulation graph: nodes as small grasps seen from above, edges by what came of them.

import { States } from "./motion.js";
import { FINGER_COLORS } from "./bodies.js";
import { drawing, element } from "./dom.js";
import { angleBetween, conjugate, multiply, norm, rotate, scale, sub } from "./pose.js";

/** What can come of an edge: how it is called, and whether it is drawn at first. */
const FATES = [
    ["failed", "failed", false],
    ["unchecked", "not checked", true],
    ["valid", "valid", true],
    ["executable", "executable", true],
    ["used", "used", true],
];

/** How two grasps can be joined; each is a layer of its own. */
const KINDS = [
    ["grasp", "paths in GS_n"],
    ["transfer-regrasp", "transfers and regrasps"],
];

/** What decides where a grasp is drawn, and how many numbers of its feature that takes. */
const PLACES = [
    ["pose", "the object's pose", 6],
    ["orientation", "its orientation, SO(3)", 3],
];

/** Up to so many nodes push each other apart until they can be told apart. */
const MOST_RELAXED = 600;

export class GraphTab {
    constructor(parent, data, app) {
        this.app = app;
        this.graph = data.graph;
        this.states = new States(data.graph.states, app.motion.hand);
        this.count = this.states.count;
        this.bodyRadius = data.object.vertices.reduce((most, x) => Math.max(most, Math.abs(x)), 1e-6);
        this.data = data;
        this.parts = bySize(this.graph.grasp_components);
        this.places = layout(this.states, this.graph.edges, data, PLACES[0][2]);
        this.size = Math.min(16, 220 / Math.sqrt(this.count + 1));
        this.details = element("p", { class: "node-details", "aria-live": "polite" });
        this.hidden = new Set(FATES.filter(([, , shown]) => !shown).map(([fate]) => fate));
        this.svg = this.picture();
        parent.append(element("p", { class: "summary", text: this.summary() }), this.legend(), this.svg, this.details);
        this.describe(null);
    }

    /** Draws the graph anew, each grasp at its place by so many numbers of its feature. */
    place(numbers) {
        this.release();
        this.places = layout(this.states, this.graph.edges, this.data, numbers);
        const old = this.svg;
        this.svg = this.picture();
        old.replaceWith(this.svg);
    }

    summary() {
        const components = new Set(this.graph.components).size;
        const tried = this.graph.edges.length;
        const failed = this.graph.edges.filter((edge) => edge.fate === "failed").length;
        const plural = (n, word) => `${n} ${word}${n === 1 ? "" : "s"}`;
        const largest = this.parts[0]?.size ?? 0;
        const inside = `by paths in GS_n alone in ${plural(this.parts.length, "component")}, the largest of ${largest}, each in its colour`;
        return `${plural(this.count, "grasp")} in ${plural(components, "component")}, ${inside}; ${plural(tried, "edge")} tried, ${failed} failed. Seen from above; a dot is a finger, the line shows how the object is turned.`;
    }

    legend() {
        const box = (name, layer, count, look) => {
            const input = element("input", { type: "checkbox", onchange: () => this.toggle(layer, !input.checked) });
            input.checked = !this.hidden.has(layer);
            return element("label", { class: `fate ${look}` }, input, element("i"), element("span", { text: `${name} (${count})` }));
        };
        const number = (key, value) => this.graph.edges.filter((edge) => edge[key] === value).length;
        const fates = FATES.filter(([fate]) => number("fate", fate)).map(([fate, name]) => box(name, fate, number("fate", fate), fate));
        const kinds = KINDS.filter(([kind]) => number("kind", kind)).map(([kind, name]) => box(name, kind, number("kind", kind), `kind ${kind}`));
        const choice = element("select", { onchange: () => this.place(PLACES[choice.selectedIndex][2]) });
        choice.append(...PLACES.map(([value, name]) => element("option", { value, text: name })));
        const places = element("label", {}, element("span", { text: "Placed by" }), choice);
        return element("div", { class: "legend" }, ...fates, ...kinds, places);
    }

    /** Hides or shows all edges of a fate or a kind. */
    toggle(layer, hide) {
        if (hide) this.hidden.add(layer);
        else this.hidden.delete(layer);
        this.hide();
    }

    hide() {
        for (const [name, layers] of Object.entries(this.layers)) {
            layers.forEach((layer) => layer.classList.toggle("off", this.hidden.has(name)));
        }
    }

    picture() {
        const root = drawing("g");
        this.layers = Object.fromEntries([...FATES, ...KINDS].map(([name]) => [name, []]));
        for (const [fate] of FATES) {
            const layer = drawing("g", { class: `edges ${fate}` });
            this.layers[fate].push(layer);
            for (const [kind] of KINDS) {
                const chosen = this.graph.edges.filter((edge) => edge.fate === fate && edge.kind === kind);
                const d = chosen.map((edge) => `M${this.spot(edge.from)}L${this.spot(edge.to)}`).join("");
                if (!d) continue;
                const path = drawing("path", { d, class: kind });
                this.layers[kind].push(path);
                layer.append(path);
            }
            root.append(layer);
        }
        this.hide();
        this.nodes = this.places.map((_, node) => this.node(node));
        root.append(...this.nodes);
        const svg = drawing("svg", { class: "graph", viewBox: this.box(), role: "group", "aria-label": "Manipulation graph" });
        svg.append(root);
        zoomable(svg);
        return svg;
    }

    spot(node) {
        return this.places[node].map((x) => x.toFixed(1)).join(" ");
    }

    box() {
        const pad = this.size * 2.5;
        const range = (i) => {
            const all = this.places.map((place) => place[i]);
            return [Math.min(...all, 0) - pad, Math.max(...all, 0) + pad];
        };
        const [[x0, x1], [y0, y1]] = [range(0), range(1)];
        return `${x0} ${y0} ${x1 - x0} ${y1 - y0}`;
    }

    /** A small grasp: the object from above, a dot for each holding finger, a line for how it is turned. */
    node(node) {
        const r = this.size;
        const end = this.graph.ends[node];
        const kind = end ? (end === "start" ? "start" : "goal") : "";
        const part = this.parts.findIndex((part) => part.name === this.graph.grasp_components[node]);
        const alone = this.parts[part].size === 1 ? "alone" : "";
        const attributes = { class: `node ${kind} ${alone}`, transform: `translate(${this.spot(node)})`, tabindex: 0, role: "button", "aria-label": this.label(node) };
        const group = drawing("g", attributes, drawing("circle", { r, class: "disc", style: `--hue:${(210 + part * 137.5) % 360}` }));
        const pose = this.states.object(node);
        const turn = rotate(pose.q, [1, 0, 0]);
        group.append(drawing("line", { x1: 0, y1: 0, x2: turn[0] * r * 0.8, y2: -turn[1] * r * 0.8, class: "turn" }));
        this.app.motion.hand.fingers.forEach((_, f) => {
            const contact = this.states.contact(node, f);
            if (!contact) return;
            const p = scale(rotate(pose.q, contact.point), r / this.bodyRadius);
            group.append(drawing("circle", { cx: p[0], cy: -p[1], r: r * 0.24, fill: FINGER_COLORS[f % FINGER_COLORS.length] }));
        });
        if (end) group.append(drawing("text", { y: -r * 1.25, "font-size": r * 0.75 }, end));
        group.append(drawing("title", {}, this.label(node)));
        const listen = (type, action) => group.addEventListener(type, action);
        listen("pointerenter", () => this.preview(node));
        listen("pointerleave", () => this.chosen === undefined && this.restore());
        listen("click", () => this.choose(node));
        listen("keydown", (event) => {
            if (event.key !== "Enter" && event.key !== " ") return;
            event.preventDefault();
            this.choose(node);
        });
        return group;
    }

    label(node) {
        const holding = this.app.motion.hand.fingers.filter((_, f) => this.states.contact(node, f)).map((finger) => finger.name);
        const end = this.graph.ends[node];
        return `Grasp ${node + 1}${end ? ` (${end})` : ""}: ${holding.join(", ")}`;
    }

    /** Shows a node's grasp in 3-D for as long as nothing else is chosen. */
    preview(node) {
        if (this.chosen === undefined) this.showNode(node);
    }

    choose(node) {
        this.release();
        this.app.player.pause();
        this.chosen = node;
        this.nodes[node].classList.add("chosen");
        this.showNode(node);
    }

    showNode(node) {
        this.shown = true;
        this.app.pose(this.states.snapshot(node));
        this.app.title(`Grasp ${node + 1} of the graph`, this.graph.ends[node] ?? "");
        this.describe(node);
    }

    describe(node) {
        if (node === null) {
            this.details.textContent = "Point at a grasp to see it in 3-D, click to keep it there.";
            return;
        }
        const own = this.graph.edges.filter((edge) => edge.from === node || edge.to === node);
        const counts = FATES.map(([fate, name]) => [own.filter((edge) => edge.fate === fate).length, name]).filter(([n]) => n);
        const edges = counts.map(([n, name]) => `${n} ${name}`).join(", ") || "none";
        const turned = (angleBetween(this.states.object(0).q, this.states.object(node).q) * 180) / Math.PI;
        this.details.textContent = `${this.label(node)}; component ${this.graph.components[node] + 1}, in GS_n alone ${this.graph.grasp_components[node] + 1}; object ${turned.toFixed(0)}° from grasp 1; edges: ${edges}.`;
    }

    /** Goes back to where the play head is. */
    release() {
        if (this.chosen !== undefined) this.nodes[this.chosen].classList.remove("chosen");
        this.chosen = undefined;
        if (this.shown) this.restore();
    }

    restore() {
        this.shown = false;
        this.describe(null);
        this.app.captioned = null;
        if (!this.app.snapshot) return;
        this.app.pose(this.app.snapshot);
        this.app.caption(this.app.snapshot);
    }

    /** Without a motion there is something to see all the same. */
    opened() {
        if (!this.app.motion.states.count && this.count) this.choose(0);
    }
}

/** The components that these names of each node make, the largest first. */
function bySize(names) {
    const sizes = new Map();
    for (const name of names) sizes.set(name, (sizes.get(name) ?? 0) + 1);
    return [...sizes].map(([name, size]) => ({ name, size })).sort((a, b) => b.size - a.size || a.name - b.name);
}

/** Where the nodes are drawn: their two widest directions in the space of the first `numbers` of their features, then pushed apart. */
function layout(states, edges, data, numbers) {
    const count = states.count;
    if (!count) return [];
    const features = Array.from({ length: count }, (_, k) => feature(states, k, data).slice(0, numbers));
    const plane = principal(features);
    // Each direction fills its share of the picture, however much less than the other it varies.
    const wide = [0, 1].map((i) => Math.max(...plane.map((place) => Math.abs(place[i])), 1e-9));
    const spread = 30 * Math.sqrt(count) + 40;
    const places = plane.map(([x, y], k) => [(x / wide[0]) * spread + Math.cos(2.4 * k) * 4, (y / wide[1]) * spread * 0.8 + Math.sin(2.4 * k) * 4]);
    if (count <= MOST_RELAXED) relax(places, edges);
    return places;
}

/** A node as six numbers: how far the object is turned from the first node's orientation, and where it is, in its own size. */
function feature(states, k, data) {
    const [first, pose] = [states.object(0), states.object(k)];
    const turn = multiply(pose.q, conjugate(first.q));
    const sign = turn[0] < 0 ? -1 : 1;
    const size = Math.max(...data.object.vertices.map(Math.abs), 1e-6);
    const move = scale(sub(pose.p, first.p), 1 / size);
    const angle = 2 * Math.atan2(norm(turn.slice(1)), Math.abs(turn[0]));
    const axis = norm(turn.slice(1)) > 1e-9 ? scale(turn.slice(1), (sign * angle) / norm(turn.slice(1))) : [0, 0, 0];
    return [...axis, ...move];
}

/** Coordinates along the two directions in which the rows vary most, by power iteration. */
function principal(rows) {
    const [n, d] = [rows.length, rows[0].length];
    const mean = rows[0].map((_, i) => rows.reduce((sum, row) => sum + row[i], 0) / n);
    let left = rows.map((row) => row.map((x, i) => x - mean[i]));
    const columns = [0, 1].map((which) => {
        let direction = Array.from({ length: d }, (_, i) => 1 + 0.1 * i + which);
        for (let step = 0; step < 60; step++) {
            const next = Array(d).fill(0);
            for (const row of left) {
                const s = row.reduce((sum, x, i) => sum + x * direction[i], 0);
                row.forEach((x, i) => (next[i] += s * x));
            }
            const length = Math.hypot(...next);
            if (length < 1e-12) break;
            direction = next.map((x) => x / length);
        }
        const along = left.map((row) => row.reduce((sum, x, i) => sum + x * direction[i], 0));
        left = left.map((row, k) => row.map((x, i) => x - along[k] * direction[i]));
        return along;
    });
    return rows.map((_, k) => [columns[0][k], columns[1][k]]);
}

/** Pushes nodes apart that are closer than they are wide, and draws joined ones a little together. */
function relax(places, edges) {
    const joined = edges.filter((edge) => edge.fate !== "failed");
    for (let step = 0; step < 120; step++) {
        for (const { from, to } of joined) pull(places[from], places[to], 0.004, 60);
        for (let a = 0; a < places.length; a++) {
            for (let b = a + 1; b < places.length; b++) push(places[a], places[b], 58);
        }
    }
}

function pull(a, b, share, rest) {
    const [x, y] = [b[0] - a[0], b[1] - a[1]];
    const length = Math.hypot(x, y);
    if (length <= rest) return;
    const s = share * (1 - rest / length);
    a[0] += x * s;
    a[1] += y * s;
    b[0] -= x * s;
    b[1] -= y * s;
}

function push(a, b, least) {
    const [x, y] = [b[0] - a[0], b[1] - a[1]];
    const length = Math.hypot(x, y);
    if (length >= least) return;
    const s = length > 1e-9 ? (0.5 * (least - length)) / length : 0;
    a[0] -= x * s;
    a[1] -= y * s;
    b[0] += x * s;
    b[1] += y * s;
}

/** Wheel to zoom, drag to move. */
function zoomable(svg) {
    const view = () => svg.viewBox.baseVal;
    svg.addEventListener("wheel", (event) => {
        event.preventDefault();
        const [box, area] = [view(), svg.getBoundingClientRect()];
        const factor = Math.exp(event.deltaY * 0.0015);
        const [u, v] = [(event.clientX - area.left) / area.width, (event.clientY - area.top) / area.height];
        box.x += box.width * u * (1 - factor);
        box.y += box.height * v * (1 - factor);
        box.width *= factor;
        box.height *= factor;
    }, { passive: false });
    let from = null;
    svg.addEventListener("pointerdown", (event) => (from = [event.clientX, event.clientY]));
    window.addEventListener("pointerup", () => (from = null));
    svg.addEventListener("pointermove", (event) => {
        if (!from) return;
        const [box, area] = [view(), svg.getBoundingClientRect()];
        const ratio = Math.max(box.width / area.width, box.height / area.height);
        box.x -= (event.clientX - from[0]) * ratio;
        box.y -= (event.clientY - from[1]) * ratio;
        from = [event.clientX, event.clientY];
    });
}
