// What the plan means at any time: between two states joints and position move linearly, orientation by slerp.

import { aboutAxis, apply, between, compose, mix, poseAt, scale, unit } from "./pose.js";

/** Forward kinematics of the hand. */
export class Hand {
    constructor(hand) {
        this.tipRadius = hand.tip_radius;
        this.fingers = hand.fingers.map((finger) => ({
            name: finger.name,
            base: poseAt(finger.base),
            tip: finger.tip,
            joints: finger.joints.map((joint) => ({ ...joint, origin: poseAt(joint.origin) })),
        }));
        this.jointCount = this.fingers.reduce((sum, finger) => sum + finger.joints.length, 0);
    }

    /** The frames of all links, finger by finger, for all joints of the hand in one row. */
    links(joints) {
        let next = 0;
        return this.fingers.map((finger) => {
            let frame = finger.base;
            return finger.joints.map((joint) => {
                const q = joints[next++];
                const move = joint.slides
                    ? { p: scale(joint.axis, q), q: [1, 0, 0, 0] }
                    : { p: [0, 0, 0], q: aboutAxis(joint.axis, q) };
                frame = compose(compose(frame, joint.origin), move);
                return frame;
            });
        });
    }

    /** The fingertips' centres, from the frames of the links. */
    tips(links) {
        return this.fingers.map((finger, f) => apply(links[f].at(-1), finger.tip));
    }
}

/** Columns of states. */
export class States {
    constructor(columns, hand) {
        this.columns = columns;
        this.hand = hand;
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

    /** Everything a fraction of the way from state k to the next. */
    snapshot(k, fraction = 0) {
        const next = fraction > 0 ? k + 1 : k;
        const joints = mix(this.joints(k), this.joints(next), fraction);
        const links = this.hand.links(joints);
        const object = between(this.object(k), this.object(next), fraction);
        const contacts = this.hand.fingers.map((_, f) => this.contactBetween(k, next, fraction, f));
        return { object, joints, links, tips: this.hand.tips(links), contacts, moving: null };
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
        this.states = new States(data.motion.states, this.hand);
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
        let worst = 0;
        for (const { state, tips } of checks) {
            const here = this.hand.tips(this.hand.links(this.states.joints(state)));
            tips.forEach((tip, f) => (worst = Math.max(worst, Math.hypot(...tip.map((x, i) => x - here[f][i])))));
        }
        return worst;
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
