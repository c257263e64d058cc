// The hand's bodies in the scene.

import * as THREE from "three";
import { FINGER_COLORS, axes, place, shapeMesh } from "./bodies.js";

export const fingerColor = (f) => FINGER_COLORS[f % FINGER_COLORS.length];

export class HandBody {
    constructor(stage, hand) {
        this.stage = stage;
        this.root = new THREE.Group();
        this.materials = [];
        const size = hand.tip_radius;
        this.palm = new THREE.Group();
        const neutral = this.material({ color: "#98a0ab" }, { roughness: 0.65, metalness: 0.1 });
        hand.palm.forEach((shape) => this.palm.add(shapeMesh(shape, neutral)));
        this.root.add(this.palm);
        this.fingers = hand.fingers.map((finger, f) => this.finger(finger, f, size));
    }

    material(look, fine) {
        const material = this.stage.surface(look, fine);
        this.materials.push(material);
        return material;
    }

    finger(finger, f, size) {
        const skin = new THREE.Color("#c3c8d0").lerp(new THREE.Color(fingerColor(f)), 0.16);
        const material = this.material({ color: skin }, { roughness: 0.5, metalness: 0.15 });
        const shapes = finger.joints.map((joint) => joint.shapes.map((shape) => shapeMesh(shape, material)));
        const links = shapes.map((own) => {
            const link = new THREE.Group();
            own.forEach((shape) => link.add(shape));
            this.root.add(link);
            return link;
        });
        const rubber = this.material({ color: fingerColor(f) }, { roughness: 0.45 });
        const tip = new THREE.Mesh(new THREE.SphereGeometry(size, 32, 20), rubber);
        tip.position.set(...finger.tip);
        tip.castShadow = true;
        links.at(-1).add(tip);
        return { links, shapes: shapes.flat(), tip, rubber };
    }

    /** Adds the frames of palm and fingertips: x red, y green, z blue. */
    frames(hand) {
        const size = hand.tip_radius;
        const palm = axes(size * 4);
        this.root.add(palm);
        this.stage.layer("frames", palm);
        this.fingers.forEach(({ links }, f) => {
            const frame = axes(size * 2.2);
            frame.position.set(...hand.fingers[f].tip);
            links.at(-1).add(frame);
            this.stage.layer("frames", frame);
        });
    }

    /** Puts the links where they are; `moving` is the finger that a regrasp moves. */
    pose(links, moving = null) {
        this.fingers.forEach((finger, f) => {
            finger.links.forEach((link, j) => place(link, links[f][j]));
            finger.rubber.emissive.set(moving === f ? "#5a1a1a" : "#000000");
        });
    }

    /** What a body of the problem is in the scene: `palm`, a link, a fingertip. */
    part(body) {
        if (body === "palm") return this.palm;
        if (body.link) return this.fingers[body.link[0]]?.links[body.link[1]];
        return body.fingertip === undefined ? null : this.fingers[body.fingertip]?.tip;
    }

    /** All that has a size, for the camera. */
    solids() {
        return [this.palm, ...this.fingers.flatMap((finger) => finger.links)];
    }
}
