// The hand: forward kinematics, and joints that others drive.

import { aboutAxis, apply, compose, poseAt, scale } from "./pose.js";

export class Hand {
    constructor(hand) {
        this.tipRadius = hand.tip_radius;
        this.fingers = hand.fingers.map((finger) => ({
            name: finger.name,
            base: poseAt(finger.base),
            tip: finger.tip,
            rest: finger.rest,
            joints: finger.joints.map((joint) => ({ ...joint, origin: poseAt(joint.origin) })),
        }));
        let next = 0;
        for (const finger of this.fingers) {
            finger.first = next;
            next += finger.joints.length;
        }
        this.jointCount = next;
    }

    /** The frames of all links, finger by finger, for all joints of the hand in one row. */
    links(joints) {
        let next = 0;
        return this.fingers.map((finger) => {
            let frame = finger.base;
            return finger.joints.map((joint) => {
                const q = joints[next++];
                const move = joint.slides ? { p: scale(joint.axis, q), q: [1, 0, 0, 0] } : { p: [0, 0, 0], q: aboutAxis(joint.axis, q) };
                frame = compose(compose(frame, joint.origin), move);
                return frame;
            });
        });
    }

    /** The fingertips' centres, from the frames of the links. */
    tips(links) {
        return this.fingers.map((finger, f) => apply(links[f].at(-1), finger.tip));
    }

    /** The largest distance (m) between the fingertips as computed here and as the program that wrote the page did. */
    disagreement(joints, tips) {
        const here = this.tips(this.links(joints));
        return Math.max(...tips.map((tip, f) => Math.hypot(...tip.map((x, i) => x - here[f][i]))));
    }

    /** The joints with those that others drive in the places that follow. */
    follow(joints) {
        const row = [...joints];
        for (const { first, joints: own } of this.fingers) {
            own.forEach(({ mimic }, j) => {
                if (mimic) row[first + j] = mimic.multiplier * row[first + mimic.joint] + mimic.offset;
            });
        }
        return row;
    }
}
