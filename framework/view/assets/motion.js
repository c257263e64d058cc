// What the plan means at any time: between two states joints and position move linearly, orientation by slerp.

import { Hand } from "./hand.js";
import { between, mix, poseAt, unit } from "./pose.js";

/** Columns of states. */
export class States {
    constructor(columns, hand, grip = null) {
        this.columns = columns;
        this.hand = hand;
        this.grip = grip;
        this.count = columns.time.length;
    }

    object(k) {
        return poseAt(this.columns.object, 7 * k);
    }

    joints(k) {
        const n = this.hand.jointCount;
        return this.columns.joints.slice(n * k, n * (k + 1));
    }

    /** The contact of a finger at state k, or null. */
    contact(k, finger) {
        const c = this.columns.contacts[k][finger];
        return c.length ? { point: c.slice(0, 3), normal: c.slice(3, 6), onTip: c.slice(6, 9) } : null;
    }

    /** The force (N, in O) of each finger at state k; null where it does not hold, or nothing is known. */
    forces(k) {
        return this.grip ? this.grip.forces[k].map((force) => (force.length ? force : null)) : null;
    }

    /** Everything a fraction of the way from state k to the next. */
    snapshot(k, fraction = 0) {
        const next = fraction > 0 ? k + 1 : k;
        const joints = mix(this.joints(k), this.joints(next), fraction);
        const links = this.hand.links(joints);
        const object = between(this.object(k), this.object(next), fraction);
        const contacts = this.hand.fingers.map((_, f) => this.contactBetween(k, next, fraction, f));
        const [a, b] = [this.forces(k), this.forces(next)];
        const forces = a && a.map((force, f) => (force && b[f] ? mix(force, b[f], fraction) : null));
        return { object, joints, links, tips: this.hand.tips(links), contacts, forces, moving: null };
    }

    contactBetween(k, next, fraction, finger) {
        const [a, b] = [this.contact(k, finger), this.contact(next, finger)];
        if (!a || !b) return null;
        return {
            point: mix(a.point, b.point, fraction),
            normal: unit(mix(a.normal, b.normal, fraction)),
            onTip: mix(a.onTip, b.onTip, fraction),
        };
    }
}

export class Motion {
    constructor(data) {
        this.hand = new Hand(data.hand);
        this.states = new States(data.motion.states, this.hand, data.grip);
        const time = data.motion.states.time;
        this.segments = data.motion.segments.map((segment, index) => ({
            ...segment,
            index,
            last: segment.first + segment.count - 1,
            start: time[segment.first],
            end: time[segment.first + segment.count - 1],
        }));
        this.time = time;
        this.begin = time.length ? time[0] : 0;
        this.end = time.length ? time[time.length - 1] : 0;
        this.duration = this.end - this.begin;
    }

    /** Segment, state before, and fraction of the way to the next one at a time; where two segments meet, the later one. */
    locate(t) {
        let s = lastNotAfter(this.segments.length, (i) => this.segments[i].start, t);
        const segment = this.segments[s];
        const state = segment.first + lastNotAfter(segment.count, (i) => this.time[segment.first + i], t);
        if (state >= segment.last) return { segment: s, state: segment.last, fraction: 0 };
        const [a, b] = [this.time[state], this.time[state + 1]];
        const fraction = b > a ? Math.min(Math.max((t - a) / (b - a), 0), 1) : 0;
        return { segment: s, state, fraction };
    }

    at(t) {
        const place = this.locate(t);
        const snapshot = this.states.snapshot(place.state, place.fraction);
        return { ...snapshot, ...place, time: t, moving: this.segments[place.segment].finger };
    }

    /** The largest distance (m) between the fingertips as computed here and as the program that wrote the page did. */
    disagreement(checks) {
        return Math.max(0, ...checks.map(({ state, tips }) => this.hand.disagreement(this.states.joints(state), tips)));
    }
}

/** The last index in 0..count whose key is not after t, at least 0; keys ascend. */
export function lastNotAfter(count, key, t) {
    let [low, high] = [0, count - 1];
    while (low < high) {
        const middle = (low + high + 1) >> 1;
        if (key(middle) <= t) low = middle;
        else high = middle - 1;
    }
    return low;
}
