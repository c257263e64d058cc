// What is to be known of the plan as a whole.

import { element } from "./curves.js";

const number = (x) => {
    if (x === null || x === undefined) return "–";
    const size = Math.abs(x);
    return x === 0 || (size >= 1e-3 && size < 1e5) ? x.toFixed(4) : x.toExponential(2);
};

function row(name, value) {
    return [element("dt", { text: name }), element("dd", { text: value })];
}

function counts(data, motion) {
    const transfers = motion.segments.filter((segment) => segment.kind === "transfer").length;
    return `${transfers} transfers, ${motion.segments.length - transfers} regrasps, ${motion.states.count} states, ${motion.duration.toFixed(1)} s`;
}

/** One line for the head of the page. */
export function headline(data, motion) {
    const verdict = data.verdict.length ? (data.verdict.every((check) => check.ok) ? "verified" : "does not verify") : "";
    return [`seed ${data.seed}`, counts(data, motion), verdict].filter(Boolean).join(" · ");
}

function facets({ facets, count }) {
    const drawn = facets.length / 3;
    return drawn < count ? `${count} facets (drawn with ${drawn})` : `${count} facets`;
}

export function facts(parent, data, motion, player) {
    const list = element("dl", { class: "facts" });
    const reached = `${data.goals_reached.length} of ${data.goals}`;
    const rows = [
        ["Motion", counts(data, motion)],
        ["Goals reached", data.stopped_by ? `${reached} (stopped: ${data.stopped_by})` : reached],
        ["Hand", `${data.hand.name}, ${data.hand.fingers.length} fingers`],
        ["Object", `${data.object.name}, ${facets(data.object)}, ${data.object.mass} kg, friction ${data.object.friction}`],
        ["Contacts", data.cone ? `${data.contact_model}, μ = ${number(data.cone.mu)}${data.cone.gamma ? `, γ = ${number(data.cone.gamma)} m` : ""}` : data.contact_model],
    ];
    if (data.replay) rows.push(["Simulation", data.replay.caption]);
    rows.forEach(([name, value]) => list.append(...row(name, value)));
    parent.append(list);
    if (data.verdict.length) parent.append(element("h3", { text: "Verifier" }), verdict(data.verdict, player));
    parent.append(element("h3", { text: "Plugins" }));
    const plugins = element("dl", { class: "facts" });
    Object.entries(data.plugins).forEach(([slot, id]) => plugins.append(...row(slot, id)));
    parent.append(plugins);
}

function verdict(checks, player) {
    const body = element("tbody");
    for (const check of checks) {
        const where = check.place.replaceAll("`", "");
        const place = check.time === null
            ? element("span", { text: where })
            : element("button", { type: "button", class: "link", text: where, onclick: () => player.seek(check.time) });
        body.append(
            element(
                "tr",
                { class: check.ok ? "" : "failed" },
                element("th", { scope: "row", text: check.name }),
                element("td", { text: check.ok ? "ok" : "FAILED" }),
                element("td", { text: number(check.worst) }),
                element("td", { text: `${check.sign} ${number(check.limit)} ${check.unit}` }),
                element("td", {}, place),
            ),
        );
    }
    const head = ["check", "", "worst", "limit", "where"].map((text) => element("th", { scope: "col", text }));
    return element("div", { class: "scrolls" }, element("table", {}, element("thead", {}, element("tr", {}, ...head)), body));
}
