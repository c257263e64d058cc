// Vectors, unit quaternions [w, x, y, z] and poses {p, q}, in doubles. A pose X_AB takes points from B to A.

export const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const scale = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const norm = (a) => Math.hypot(a[0], a[1], a[2]);
export const unit = (a) => {
    const length = norm(a);
    return length > 0 ? scale(a, 1 / length) : [0, 0, 1];
};
export const mix = (a, b, s) => a.map((x, i) => x + (b[i] - x) * s);

export function multiply(a, b) {
    const [w, x, y, z] = a;
    const [s, i, j, k] = b;
    return [w * s - x * i - y * j - z * k, w * i + x * s + y * k - z * j, w * j - x * k + y * s + z * i, w * k + x * j - y * i + z * s];
}

export const conjugate = (q) => [q[0], -q[1], -q[2], -q[3]];

export function rotate(q, v) {
    const u = [q[1], q[2], q[3]];
    const t = scale(cross(u, v), 2);
    return add(add(v, scale(t, q[0])), cross(u, t));
}

export function aboutAxis(axis, angle) {
    const s = Math.sin(angle / 2);
    return [Math.cos(angle / 2), axis[0] * s, axis[1] * s, axis[2] * s];
}

export function normalized(q) {
    const length = Math.hypot(...q);
    return q.map((x) => x / length);
}

export const compose = (a, b) => ({ p: add(a.p, rotate(a.q, b.p)), q: multiply(a.q, b.q) });
export const apply = (pose, point) => add(pose.p, rotate(pose.q, point));
export const poseAt = (numbers, at = 0) => ({
    p: [numbers[at], numbers[at + 1], numbers[at + 2]],
    q: normalized([numbers[at + 3], numbers[at + 4], numbers[at + 5], numbers[at + 6]]),
});

/** The angle of the turn from a to b (rad), in [0, pi]. */
export function angleBetween(a, b) {
    const d = multiply(conjugate(a), b);
    return 2 * Math.atan2(Math.hypot(d[1], d[2], d[3]), Math.abs(d[0]));
}

/** The shorter turn from a to b, a fraction s of it, at even speed. */
export function slerp(a, b, s) {
    let cosine = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
    const end = cosine < 0 ? b.map((x) => -x) : b;
    cosine = Math.min(Math.abs(cosine), 1);
    const sine = Math.hypot(...multiply(conjugate(a), end).slice(1));
    if (sine < 1e-9) return normalized(mix(a, end, s));
    const angle = Math.atan2(sine, cosine);
    const [u, v] = [Math.sin((1 - s) * angle) / sine, Math.sin(s * angle) / sine];
    return normalized(a.map((x, i) => x * u + end[i] * v));
}

/** A pose a fraction s of the way from a to b: position straight, orientation by slerp. */
export const between = (a, b, s) => ({ p: mix(a.p, b.p, s), q: slerp(a.q, b.q, s) });

/** The turn that takes the z axis to a unit vector. */
export function fromZ(n) {
    if (n[2] < -0.999999) return [0, 1, 0, 0];
    return normalized([1 + n[2], -n[1], n[0], 0]);
}
