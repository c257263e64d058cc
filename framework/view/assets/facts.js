// What is to be known of the plan as a whole.

import { element, facets, factList, number } from "./dom.js";
import { CheckTable } from "./table.js";

function counts(motion) {
    const transfers = motion.segments.filter((segment) => segment.kind === "transfer").length;
    return `${transfers} transfers, ${motion.segments.length - transfers} regrasps, ${motion.states.count} states, ${motion.duration.toFixed(1)} s`;
}

/** One line for the head of the page. */
export function headline(data, motion) {
    const verdict = data.verdict.length ? (data.verdict.every((check) => check.ok) ? "verified" : "does not verify") : "";
    return [`seed ${data.seed}`, counts(motion), verdict].filter(Boolean).join(" · ");
}

function rows(data, motion, arrows) {
    const reached = `${data.goals_reached.length} of ${data.goals.length}`;
    const gamma = data.cone?.gamma ? `, γ = ${number(data.cone.gamma * 1000)} mm` : "";
    const list = [
        ["Motion", counts(motion)],
        ["Goals reached", data.stopped_by ? `${reached} (stopped: ${data.stopped_by})` : reached],
        ["Hand", `${data.hand.name}, ${data.hand.fingers.length} fingers`],
        ["Object", `${data.object.name}, ${facets(data.object)}, ${data.object.mass} kg, friction ${data.object.friction}`],
        ["Contacts", data.cone ? `${data.contact_model}, μ = ${number(data.cone.mu)}${gamma}` : data.contact_model],
    ];
    if (data.grip) list.push(["Forces", [data.grip.origin, arrows].filter(Boolean).join("; ")]);
    if (data.replay) list.push(["Simulation", data.replay.caption]);
    return list;
}

/** Writes them; `arrows` says what their length means, `visit` is told of which check the place is to be shown. */
export function facts(parent, { data, motion }, arrows, visit) {
    parent.replaceChildren(factList(rows(data, motion, arrows)));
    if (data.verdict.length) {
        parent.append(element("h2", { text: "Verifier" }));
        new CheckTable(parent, data.verdict, visit);
    }
    parent.append(element("h2", { text: "Plugins" }), factList(Object.entries(data.plugins)));
}
