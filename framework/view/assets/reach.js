// Where fingertips reach, sampled evenly over the joints' ranges.

import * as THREE from "three";
import { norm, sub } from "./pose.js";

const PRIMES = [2, 3, 5, 7, 11, 13, 17, 19];

/** The digits of a number in a base, behind the point: even at any count (J. Halton, Numerische Mathematik 2, 1960). */
function halton(index, base) {
    let [f, r] = [1, 0];
    for (let i = index; i > 0; i = Math.floor(i / base)) {
        f /= base;
        r += f * (i % base);
    }
    return r;
}

/** `count` postures of one finger (others at rest) and where its tip is in each. */
export function reach(hand, finger, count) {
    const { first, joints } = hand.fingers[finger];
    const row = hand.fingers.flatMap(({ rest }) => rest);
    const free = joints.map((joint, j) => j).filter((j) => !joints[j].mimic);
    return Array.from({ length: count }, (_, k) => {
        free.forEach((j, d) => {
            const [low, high] = joints[j].range;
            row[first + j] = low + (high - low) * halton(k + 1, PRIMES[d % PRIMES.length]);
        });
        const posture = hand.follow(row);
        const own = posture.slice(first, first + joints.length);
        return { own, tip: hand.tips(hand.links(posture))[finger] };
    });
}

export function cloud(samples, color, size) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(samples.flatMap(({ tip }) => tip)), 3));
    const material = new THREE.PointsMaterial({ color, size, transparent: true, opacity: 0.55, depthWrite: false });
    return new THREE.Points(geometry, material);
}

/** The sampled posture in which a tip is nearest to touching a ball from where it mostly does, and how far off it is (m). */
export function touching(samples, center, distance) {
    const off = ({ tip }) => Math.abs(norm(sub(tip, center)) - distance);
    const near = samples.filter((sample) => off(sample) < 3e-3);
    const mean = [0, 1, 2].map((i) => near.reduce((sum, { tip }) => sum + tip[i], 0) / Math.max(near.length, 1));
    const cost = (sample) => off(sample) + (near.length ? 0.05 * norm(sub(sample.tip, mean)) : 0);
    const best = samples.reduce((a, b) => (cost(b) < cost(a) ? b : a));
    return { own: best.own, off: off(best) };
}
