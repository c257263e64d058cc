// The table of contents: every segment, what moves and how far.

import { FINGER_COLORS } from "./bodies.js";
import { element } from "./dom.js";
import { angleBetween, norm, sub } from "./pose.js";

const degrees = (angle) => `${((angle * 180) / Math.PI).toFixed(1)}°`;
const millimetres = (length) => `${(length * 1000).toFixed(1)} mm`;

export function segmentTitle(motion, segment) {
    return segment.kind === "transfer" ? "Transfer" : `Regrasp: ${motion.hand.fingers[segment.finger].name}`;
}

/** The colour that stands for a segment. */
export function segmentColor(segment) {
    return segment.kind === "transfer" ? "var(--transfer)" : FINGER_COLORS[segment.finger % FINGER_COLORS.length];
}

/** What a segment does, in a few words. */
export function segmentDetail(motion, segment) {
    const { states } = motion;
    const seconds = `${(segment.end - segment.start).toFixed(2)} s`;
    if (segment.kind === "transfer") {
        const [a, b] = [states.object(segment.first), states.object(segment.last)];
        return `turns ${degrees(angleBetween(a.q, b.q))}, moves ${millimetres(norm(sub(b.p, a.p)))} · ${seconds}`;
    }
    const [a, b] = [states.contact(segment.first, segment.finger), states.contact(segment.last, segment.finger)];
    if (a && b) return `contact moves ${millimetres(norm(sub(b.point, a.point)))} · ${seconds}`;
    if (!a && !b) return `stays free · ${seconds}`;
    return `${a ? "lets go" : "takes hold"} · ${seconds}`;
}

export class SegmentList {
    constructor(list, motion, player) {
        this.items = motion.segments.map((segment) => {
            const mark = element("span", { class: "mark", style: `background:${segmentColor(segment)}` });
            const words = element(
                "span",
                { class: "words" },
                element("strong", { text: segmentTitle(motion, segment) }),
                element("small", { text: segmentDetail(motion, segment) }),
            );
            const number = element("span", { class: "number", text: segment.index + 1 });
            const go = () => player.seek(segment.start);
            const button = element("button", { type: "button", class: `segment ${segment.kind}`, onclick: go }, number, mark, words);
            list.append(element("li", {}, button));
            return button;
        });
        this.list = list;
        if (!this.items.length) list.append(element("li", { class: "empty", text: "There is no motion." }));
    }

    show(snapshot) {
        if (this.current === snapshot.segment) return;
        this.items[this.current]?.removeAttribute("aria-current");
        this.current = snapshot.segment;
        const item = this.items[this.current];
        item.setAttribute("aria-current", "true");
        const [list, box] = [this.list.getBoundingClientRect(), item.getBoundingClientRect()];
        // Only the list scrolls, never the page.
        if (box.top < list.top || box.bottom > list.bottom) this.list.scrollTop += box.top - list.top - list.height / 3;
    }
}

/** The segments as the background of the slider, whose ends are those of `span`. */
export function strip(motion, span) {
    if (motion.duration <= 0) return "none";
    const at = (time) => `${(((time - span.begin) / (span.end - span.begin)) * 100).toFixed(3)}%`;
    const parts = motion.segments.map((s) => `${segmentColor(s)} ${at(s.start)} ${at(s.end)}`);
    return `linear-gradient(to right, ${[...parts, `transparent ${at(motion.end)}`].join(", ")})`;
}
