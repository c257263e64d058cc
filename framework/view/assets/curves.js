// The plots of a plan: margin, clearance, friction, efforts, speeds.

import { fingerColor } from "./handbody.js";
import { dot, norm } from "./pose.js";

const percent = (x) => `${(100 * x).toFixed(Math.abs(x) < 0.0995 && x ? 1 : 0)} %`;
const plain = (digits) => (x, tick) => (tick ? String(Number(x.toPrecision(4))) : Number.isFinite(x) ? x.toFixed(digits) : "more than any");
const millimetres = (x, tick) => (tick ? String(Number((x * 1000).toPrecision(4))) : `${(x * 1000).toFixed(2)} mm`);

/** What can be plotted of `shown` (`{ data, motion, label, color }`), with the figures of `others` beside it where there is one curve. */
export function plots(shown, others) {
    const list = [];
    const { data } = shown;
    const curves = data.curves;
    if (curves?.margin.some((x) => x !== null)) {
        list.push({
            key: "margin", name: curves.margin_name, unit: "", digits: plain(4), sets: single(shown, others, "margin"),
            limit: { value: 0, label: "limit: above 0", above: true },
        });
    }
    if (curves?.clearance.some((x) => x !== null)) list.push(clearance(shown, others));
    if (data.grip) list.push(friction(shown), efforts(shown));
    if (shown.motion.states.count > 1) list.push(speeds(shown));
    return list;
}

function single(shown, others, key) {
    const one = ({ data, motion, label, color }, faint) => ({ name: label, color, faint, times: motion.time, values: data.curves[key] });
    const beside = others.filter((other) => other.data.curves).map((other) => one(other, true));
    const own = { ...one(shown, false), color: "var(--line)", name: others.length ? shown.label : "" };
    return [{ name: "", series: [own, ...beside] }];
}

function clearance(shown, others) {
    const { pair, pairs, least_clearance: least } = shown.data.curves;
    const label = least > 0 ? `limit: above ${(least * 1000).toFixed(2)} mm` : "limit: above 0 mm";
    const note = (time) => {
        const { state } = shown.motion.locate(Math.min(time, shown.motion.end));
        return `between ${pairs[pair[state]].replaceAll("`", "")}`;
    };
    return { key: "clearance", name: "Clearance", unit: "mm", digits: millimetres, sets: single(shown, others, "clearance"), limit: { value: least, label, above: true }, note };
}

/** The share of tangential in normal force: the coefficient of friction that a contact needs. */
export function needed(force, normal) {
    const pressing = -dot(force, normal);
    const along = norm(force.map((x, i) => x + pressing * normal[i]));
    if (pressing > 1e-6) return along / pressing;
    return along > 1e-6 ? Infinity : null;
}

function friction({ data, motion }) {
    const { contacts } = motion.states.columns;
    const all = motion.hand.fingers.map((finger, f) => {
        const values = motion.time.map((_, k) => {
            const [force, contact] = [data.grip.forces[k][f], contacts[k][f]];
            return force.length && contact.length ? needed(force, contact.slice(3, 6)) : null;
        });
        return { name: finger.name, color: fingerColor(f), times: motion.time, values };
    });
    const given = data.cone?.mu ?? data.object.friction;
    const remark = data.cone?.gamma ? "forces alone; torsion about the normals is not counted" : "";
    return {
        key: "friction", name: "Friction needed", unit: "", digits: plain(3), sets: [{ name: "fingers", series: all }], remark,
        limit: { value: given, label: `given: ${Number(given.toPrecision(3))}` },
    };
}

/** The joints' shares of their limits, as the largest of each finger, and for each finger joint by joint. */
function ofJoints(motion, times, share) {
    const { fingers } = motion.hand;
    const largest = fingers.map(({ name, first, joints }, f) => {
        const values = times.map((_, k) => joints.reduce((most, _, j) => Math.max(most, Math.abs(share(k, first + j))), 0));
        return { name, color: fingerColor(f), times, values };
    });
    // Joint by joint only once somebody asks.
    const joints = ({ name, first, joints }) => ({
        name: `joints of ${name}`,
        get series() {
            return joints.map(({ name }, j) => ({ name, color: fingerColor(j), times, values: times.map((_, k) => Math.abs(share(k, first + j))) }));
        },
    });
    return [{ name: "fingers", series: largest }, ...fingers.map(joints)];
}

function efforts({ data, motion }) {
    const { efforts } = data.grip;
    const n = motion.hand.jointCount;
    return {
        key: "effort", name: "Effort", unit: "% of the limit", digits: percent, sets: ofJoints(motion, motion.time, (k, j) => efforts[n * k + j]),
        limit: { value: 1, label: "limit: 100 %" }, remark: "to hold the object; without the links' weight",
    };
}

/** Speeds at the states and in the middle between them, of the cubic that a controller plays; of straight steps where no velocities are known. */
function speeds({ motion }) {
    const { columns, hand } = motion.states;
    const n = hand.jointCount;
    const limits = hand.fingers.flatMap((finger) => finger.joints.map((joint) => joint.velocity));
    const { time, joints, velocities } = { velocities: null, ...columns };
    const [times, rows] = [[], []];
    const push = (t, speed) => {
        times.push(t);
        rows.push(limits.map((limit, j) => speed(j) / limit));
    };
    for (let k = 0; k < time.length; k++) {
        const h = k + 1 < time.length ? time[k + 1] - time[k] : 0;
        const mean = (j) => (joints[n * (k + 1) + j] - joints[n * k + j]) / h;
        if (velocities) push(time[k], (j) => velocities[n * k + j]);
        if (h <= 0) continue;
        if (velocities) push(time[k] + h / 2, (j) => 1.5 * mean(j) - 0.25 * (velocities[n * k + j] + velocities[n * (k + 1) + j]));
        else [time[k], time[k + 1]].forEach((t) => push(t, mean));
    }
    return {
        key: "speed", name: "Speed", unit: "% of the limit", digits: percent, sets: ofJoints(motion, times, (k, j) => rows[k][j]),
        limit: { value: 1, label: "limit: 100 %" },
    };
}
