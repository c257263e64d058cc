// A plan in the scene: its hand, object and obstacles, and the marks at its contacts.

import * as THREE from "three";
import { axes, meshGeometry, painted, place, shapeMesh } from "./bodies.js";
import { HandBody, fingerColor } from "./handbody.js";
import { ContactMarks, ForceArrows, Trace } from "./marks.js";
import { norm, poseAt, unit } from "./pose.js";

/** What can be shown and hidden: key, name, letter on the keyboard, whether it is shown at first. */
export const LAYERS = [
    ["contacts", "Contacts", "c", true],
    ["forces", "Forces", "n", true],
    ["cones", "Friction cones", "f", false],
    ["traces", "Rolled traces", "t", true],
    ["ends", "Start and goals", "g", false],
    ["axes", "Object axes", "a", true],
    ["frames", "Hand frames", "p", false],
    ["obstacles", "Obstacles", "o", true],
    ["facets", "Facets", "w", false],
    ["replay", "Simulated object", "r", true],
];

/** How much of a plan beside the chosen one can be seen where both are in one picture. */
const FAINT = 0.34;

export class Actor {
    constructor(stage, data, motion) {
        Object.assign(this, { stage, data, motion });
        const size = data.hand.tip_radius;
        this.root = new THREE.Group();
        this.marked = new THREE.Group();
        this.hand = new HandBody(stage, data.hand);
        this.own = this.hand.materials;
        const rough = this.material({ color: "#8d7f6d", transparent: true, opacity: 0.85 }, { roughness: 0.9 });
        this.obstacles = data.obstacles.map(({ shape }) => shapeMesh(shape, rough));
        stage.endless.push(...this.obstacles.filter((part) => part.userData.endless));
        stage.layer("obstacles", ...this.obstacles);
        this.root.add(this.hand.root, ...this.obstacles);
        this.object(data);
        this.marks = new ContactMarks(this.hand.fingers.length, data.cone, size);
        this.marked.add(this.marks.points, this.marks.cones);
        stage.layer("contacts", this.marks.points);
        stage.layer("cones", this.marks.cones);
        this.arrows(data);
        this.body.add(this.marked);
        this.traces(data, size);
        stage.scene.add(this.root);
        if (motion.states.count) this.show(motion.at(motion.begin));
    }

    material(look, fine) {
        return this.hand.material(look, fine);
    }

    object(data) {
        this.geometry = meshGeometry(data.object);
        this.body = new THREE.Group();
        const paint = painted(this.stage, this.geometry);
        this.own.push(paint);
        this.skin = new THREE.Mesh(this.geometry, paint);
        this.skin.castShadow = this.skin.receiveShadow = true;
        this.body.add(this.skin);
        this.geometry.computeBoundingSphere();
        this.bodyRadius = this.geometry.boundingSphere.radius;
        this.root.add(this.body);
        if (data.replay) this.ghost = this.shadow("replay", "#ff5da2");
    }

    /** A second, translucent object that goes or stands elsewhere. */
    shadow(layer, color, pose = null) {
        const material = this.stage.surface({ color, transparent: true, opacity: 0.42, depthWrite: false });
        // Where both are in the same place, this one is in front.
        Object.assign(material, { polygonOffset: true, polygonOffsetFactor: -4, polygonOffsetUnits: -4 });
        const shadow = new THREE.Mesh(this.geometry, material);
        shadow.renderOrder = 5;
        if (pose) place(shadow, pose);
        this.root.add(shadow);
        this.stage.layer(layer, shadow);
        return shadow;
    }

    arrows(data) {
        const all = (data.grip?.forces ?? []).flat().filter((force) => force.length);
        this.mostForce = all.reduce((most, force) => Math.max(most, norm(force)), 0);
        if (!this.mostForce) return;
        this.forces = new ForceArrows(this.hand.fingers.length, this.mostForce, this.bodyRadius * 1.6);
        this.marked.add(this.forces.group);
        this.stage.layer("forces", this.forces.group);
    }

    /** What the arrows' length means, in words. */
    arrowScale() {
        return this.forces ? `1 cm of an arrow is ${Number((0.01 / this.forces.perNewton).toPrecision(2))} N` : "";
    }

    traces(data, size) {
        const { states, segments } = this.motion;
        const transfers = segments.filter((segment) => segment.kind === "transfer");
        const firsts = transfers.map((segment) => segment.first);
        [this.trails, this.holders] = [[], []];
        this.hand.fingers.forEach((finger, f) => {
            const points = transfers.map((segment) => contactsOf(states, segment, f));
            const onObject = points.map((list) => list.map((c) => [c.point, c.normal]));
            const tip = data.hand.fingers[f].tip;
            const onTip = points.map((list) => list.map((c) => [c.onTip.map((x, i) => x + tip[i]), unit(c.onTip)]));
            const first = new Trace(onObject, firsts, fingerColor(f), size * 0.16);
            const second = new Trace(onTip, firsts, "#14181d", size * 0.1);
            const holder = new THREE.Group();
            holder.add(second.group);
            this.marked.add(first.group);
            finger.links.at(-1).add(holder);
            this.holders.push(holder);
            this.stage.layer("traces", first.group, second.group);
            this.trails.push(first, second);
        });
    }

    /** Takes into `box` what is to be seen at first: hand, object where it begins, and where it is to go, obstacles. */
    measure(box) {
        this.root.updateMatrixWorld(true);
        const finite = (part) => !part.userData.endless;
        const palm = this.hand.palm.children.filter(finite);
        const links = this.hand.fingers.flatMap((finger) => finger.links);
        [...links, ...palm, this.skin, ...this.obstacles.filter(finite)].forEach((part) => box.expandByObject(part));
        for (const goal of this.data.goals) {
            const center = new THREE.Vector3(...poseAt(goal).p);
            box.union(new THREE.Box3().setFromCenterAndSize(center, new THREE.Vector3().setScalar(1.6 * this.bodyRadius)));
        }
    }

    /** Adds what must not count for the first view: frames, and the object where it starts and where it is to go. */
    finish() {
        const arrows = axes(this.bodyRadius * 1.3);
        const lines = new THREE.LineBasicMaterial({ color: "#101418", transparent: true, opacity: 0.35 });
        const wire = new THREE.LineSegments(new THREE.WireframeGeometry(this.geometry), lines);
        this.stage.layer("axes", arrows);
        this.stage.layer("facets", wire);
        this.body.add(arrows, wire);
        this.hand.frames(this.data.hand);
        if (this.motion.states.count) this.shadow("ends", "#2f7de1", this.motion.states.object(0));
        this.data.goals.forEach((goal) => this.shadow("ends", "#1f9d55", poseAt(goal)));
    }

    /** Beside the chosen plan this one is faint and has no marks. */
    setFaint(faint) {
        [this.marked, ...this.holders].forEach((marks) => (marks.visible = !faint));
        for (const material of this.own) {
            material.userData.opacity ??= [material.transparent, material.opacity];
            const [transparent, opacity] = material.userData.opacity;
            Object.assign(material, { transparent: faint || transparent, opacity: faint ? FAINT : opacity, depthWrite: !faint, needsUpdate: true });
        }
    }

    show(snapshot) {
        place(this.body, snapshot.object);
        this.hand.pose(snapshot.links, snapshot.moving);
        this.marks.show(snapshot.contacts);
        this.forces?.show(snapshot.contacts, snapshot.forces);
        this.trails.forEach((trail) => trail.show(snapshot.state ?? -1));
        this.stage.stale = true;
    }

    showReplay(pose) {
        if (this.ghost && pose) place(this.ghost, pose);
    }

    /** What a body of the problem is in the scene. */
    part(body) {
        if (body === "object") return this.skin;
        return body.obstacle === undefined ? this.hand.part(body) : this.obstacles[body.obstacle];
    }
}

/** Marks bodies of an actor, one at a time of being asked. */
export class Spotlight {
    constructor(stage) {
        this.stage = stage;
        this.glow = new THREE.MeshBasicMaterial({ color: "#ff2d55", transparent: true, opacity: 0.38, depthTest: false, depthWrite: false });
        this.marks = [];
    }

    clear() {
        this.marks.forEach((mark) => mark.removeFromParent());
        this.marks = [];
        this.stage.stale = true;
    }

    /** Lights these parts up and looks at the place they share. */
    on(parts) {
        this.clear();
        const boxes = parts.map((part) => new THREE.Box3().setFromObject(part));
        for (const part of parts) {
            const meshes = [];
            part.traverse((mesh) => mesh.isMesh && mesh.material.isMeshBasicMaterial !== true && meshes.push(mesh));
            for (const mesh of meshes) {
                const mark = new THREE.Mesh(mesh.geometry, this.glow);
                mark.renderOrder = 20;
                mesh.add(mark);
                this.marks.push(mark);
            }
        }
        if (!boxes.length) return;
        const [a, b] = [boxes[0], boxes.at(-1)];
        // Between two bodies: the middle of where their boxes come nearest.
        const near = a.clone().intersect(b);
        const place = near.isEmpty() ? a.clampPoint(b.getCenter(new THREE.Vector3()), new THREE.Vector3()) : near.getCenter(new THREE.Vector3());
        const sizes = boxes.map((box) => box.getSize(new THREE.Vector3()).length() / 2);
        this.stage.lookAt(place, Math.min(Math.max(...sizes), this.stage.radius) * 1.3);
        this.stage.stale = true;
    }
}

function contactsOf(states, segment, finger) {
    const list = [];
    for (let k = segment.first; k <= segment.last; k++) {
        const contact = states.contact(k, finger);
        if (contact) list.push(contact);
    }
    return list.length === segment.count ? list : [];
}
