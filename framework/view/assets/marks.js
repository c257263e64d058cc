// What happens at the contacts: points, friction cones, and the traces that rolling leaves on both bodies.

import * as THREE from "three";
import { add, cross, fromZ, norm, scale, sub, unit } from "./pose.js";
import { FINGER_COLORS, place } from "./bodies.js";

/** Contact point and friction cone of each finger, in the object's frame. The cone opens inwards: it holds the forces that the object can get. */
export class ContactMarks {
    constructor(fingers, cone, size) {
        this.points = new THREE.Group();
        this.cones = new THREE.Group();
        const ball = new THREE.SphereGeometry(size * 0.085, 16, 12);
        const shape = cone && cone.mu > 0 ? coneGeometry(cone.mu, size) : null;
        for (let f = 0; f < fingers; f++) {
            const color = FINGER_COLORS[f % FINGER_COLORS.length];
            this.points.add(marked(ball, new THREE.MeshBasicMaterial({ color: "#ffffff", depthTest: false, transparent: true }), 12));
            if (shape) this.cones.add(coneMark(shape, color));
        }
    }

    show(contacts) {
        contacts.forEach((contact, f) => {
            for (const group of [this.points, this.cones]) {
                const mark = group.children[f];
                if (!mark) continue;
                mark.visible = contact !== null;
                if (contact) place(mark, { p: contact.point, q: fromZ(scale(contact.normal, -1)) });
            }
        });
    }
}

function marked(geometry, material, order) {
    const mesh = new THREE.Mesh(geometry, material);
    mesh.renderOrder = order;
    return mesh;
}

/** A cone with its tip at the origin, opening along z: |f_t| = mu f_n. Steep ones are drawn shorter, so that none outgrows the scene. */
function coneGeometry(mu, size) {
    const height = (size * 1.25) / Math.max(1, Math.hypot(1, mu) / 1.3);
    const geometry = new THREE.ConeGeometry(height * mu, height, 48, 1, true);
    return geometry.rotateX(-Math.PI / 2).translate(0, 0, height / 2);
}

function coneMark(geometry, color) {
    const group = new THREE.Group();
    const parts = { color, transparent: true, depthTest: false, depthWrite: false, side: THREE.DoubleSide };
    group.add(marked(geometry, new THREE.MeshBasicMaterial({ ...parts, opacity: 0.2 }), 8));
    const position = geometry.getAttribute("position");
    const rim = [];
    for (let i = 0; i < position.count; i++) {
        if (position.getZ(i) > 1e-9) rim.push(new THREE.Vector3().fromBufferAttribute(position, i));
    }
    const ring = new THREE.BufferGeometry().setFromPoints(rim);
    const line = new THREE.LineLoop(ring, new THREE.LineBasicMaterial({ color, transparent: true, depthTest: false, opacity: 0.9 }));
    line.renderOrder = 9;
    group.add(line);
    return group;
}

/** The forces of the fingers on the object as arrows that end at the contacts, in the object's frame. */
export class ForceArrows {
    /** `longest` is how long the arrow of the force `most` (N) is (m). */
    constructor(fingers, most, longest) {
        this.group = new THREE.Group();
        this.perNewton = longest / most;
        const shaft = new THREE.CylinderGeometry(1, 1, 1, 12).rotateX(Math.PI / 2).translate(0, 0, 0.5);
        const head = new THREE.ConeGeometry(1, 1, 18).rotateX(Math.PI / 2).translate(0, 0, -0.5);
        const [thin, wide] = [longest * 0.022, longest * 0.066];
        for (let f = 0; f < fingers; f++) {
            const look = { color: FINGER_COLORS[f % FINGER_COLORS.length], depthTest: false, transparent: true };
            const arrow = new THREE.Group();
            arrow.add(marked(shaft, new THREE.MeshBasicMaterial(look), 10), marked(head, new THREE.MeshBasicMaterial(look), 10));
            arrow.userData = { thin, wide, tall: longest * 0.17 };
            this.group.add(arrow);
        }
    }

    show(contacts, forces) {
        this.group.children.forEach((arrow, f) => {
            const force = forces?.[f];
            const length = force ? norm(force) * this.perNewton : 0;
            arrow.visible = Boolean(contacts[f]) && length > 0;
            if (!arrow.visible) return;
            const along = unit(force);
            place(arrow, { p: contacts[f].point, q: fromZ(along) });
            const { thin, wide, tall } = arrow.userData;
            const size = Math.min(tall, length * 0.6);
            const [shaft, head] = arrow.children;
            shaft.scale.set(thin, thin, Math.max(length - size, 1e-9));
            shaft.position.z = -length;
            head.scale.set((wide * size) / tall, (wide * size) / tall, size);
        });
    }
}

/** The traces of one finger's transfers on one surface, as ribbons; those up to the play head are drawn, the present one stronger. */
export class Trace {
    /**
     * `transfers` are lists of [point, normal] pairs, or empty where the finger does not hold; `firsts` the states they begin with.
     */
    constructor(transfers, firsts, color, width) {
        const positions = [];
        this.runs = transfers.map((points, i) => {
            const begin = positions.length / 3;
            ribbon(points, width, positions);
            return { first: firsts[i], begin, end: positions.length / 3 };
        });
        const geometry = new THREE.BufferGeometry();
        geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(positions), 3));
        const part = (opacity) => {
            const material = new THREE.MeshBasicMaterial({ color, side: THREE.DoubleSide, transparent: opacity < 1, opacity });
            material.polygonOffset = true;
            material.polygonOffsetFactor = -2;
            // Shared positions, each part with a range of its own.
            const own = new THREE.BufferGeometry();
            own.setAttribute("position", geometry.getAttribute("position"));
            const mesh = new THREE.Mesh(own, material);
            mesh.frustumCulled = false;
            return mesh;
        };
        [this.past, this.now] = [part(0.32), part(1)];
        this.group = new THREE.Group();
        this.group.add(this.past, this.now);
    }

    /** Draws what was rolled until `state`. */
    show(state) {
        const index = this.runs.findLastIndex((run) => run.first <= state);
        const run = this.runs[index];
        const done = run ? Math.min(run.begin + 6 * (state - run.first), run.end) : 0;
        this.past.geometry.setDrawRange(0, run ? run.begin : 0);
        this.now.geometry.setDrawRange(run ? run.begin : 0, run ? done - run.begin : 0);
    }
}

/** Two triangles for each step between points on a surface with these normals, just above it. */
function ribbon(points, width, positions) {
    const corners = points.map(([point, normal], i) => {
        const before = points[Math.max(i - 1, 0)][0];
        const after = points[Math.min(i + 1, points.length - 1)][0];
        const along = sub(after, before);
        const across = norm(along) > 1e-9 ? scale(unit(cross(normal, along)), width / 2) : [0, 0, 0];
        const lifted = add(point, scale(normal, width * 0.12));
        return [add(lifted, across), sub(lifted, across)];
    });
    for (let i = 0; i + 1 < corners.length; i++) {
        const [[a, b], [c, d]] = [corners[i], corners[i + 1]];
        positions.push(...a, ...b, ...c, ...c, ...b, ...d);
    }
}
