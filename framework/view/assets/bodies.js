// Shapes and the object as meshes of three.js.

import * as THREE from "three";
import { cross, norm, scale, sub, unit, add, fromZ } from "./pose.js";

/** Colours of the fingers: told apart by people who see few colours (M. Okabe, K. Ito, "Color universal design", 2008). */
export const FINGER_COLORS = ["#e69f00", "#56b4e9", "#009e73", "#cc79a7", "#d55e00", "#f0e442", "#0072b2", "#8c8c8c"];

/** Facets that meet at less than this are one smooth surface (cosine). */
const CREASE = Math.cos((32 * Math.PI) / 180);

export function place(object, pose) {
    object.position.set(...pose.p);
    object.quaternion.set(pose.q[1], pose.q[2], pose.q[3], pose.q[0]);
}

/** A mesh for a shape of the plan, in the frame of what it belongs to. */
export function shapeMesh(shape, material) {
    const mesh = new THREE.Mesh(shapeGeometry(shape), material);
    const group = new THREE.Group();
    const [x, y, z, w, i, j, k] = shape.pose;
    place(group, { p: [x, y, z], q: [w, i, j, k] });
    if (shape.kind === "capsule") {
        place(mesh, { p: scale(add(shape.from, shape.to), 0.5), q: fromZ(unit(sub(shape.to, shape.from))) });
    } else if (shape.kind === "half-space") {
        const normal = unit(shape.normal);
        place(mesh, { p: scale(normal, shape.offset), q: fromZ(normal) });
        group.userData.endless = { normal, offset: shape.offset };
    }
    mesh.castShadow = !group.userData.endless;
    mesh.receiveShadow = true;
    group.add(mesh);
    return group;
}

function shapeGeometry(shape) {
    switch (shape.kind) {
        case "sphere":
            return new THREE.SphereGeometry(shape.radius, 32, 20);
        case "box":
            return new THREE.BoxGeometry(...shape.size);
        case "capsule": {
            const geometry = new THREE.CapsuleGeometry(shape.radius, norm(sub(shape.to, shape.from)), 8, 24);
            return geometry.rotateX(Math.PI / 2);
        }
        case "half-space":
            return new THREE.CircleGeometry(1, 64);
        default:
            return meshGeometry(shape);
    }
}

/** A mesh with the normals that look right: smooth over blunt edges, flat at sharp ones. */
export function meshGeometry({ vertices, facets }) {
    const corners = facets.length;
    const [normals, lengths] = facetNormals(vertices, facets);
    const [begins, around] = facetsAround(vertices.length / 3, facets);
    const [positions, shading] = [new Float32Array(3 * corners), new Float32Array(3 * corners)];
    for (let i = 0; i < corners; i++) {
        const own = 3 * Math.floor(i / 3);
        let [x, y, z] = [0, 0, 0];
        for (let a = begins[facets[i]]; a < begins[facets[i] + 1]; a++) {
            const other = 3 * around[a];
            const cosine = normals[own] * normals[other] + normals[own + 1] * normals[other + 1] + normals[own + 2] * normals[other + 2];
            if (cosine <= CREASE && other !== own) continue;
            x += normals[other] * lengths[around[a]];
            y += normals[other + 1] * lengths[around[a]];
            z += normals[other + 2] * lengths[around[a]];
        }
        const length = Math.hypot(x, y, z) || 1;
        for (let k = 0; k < 3; k++) positions[3 * i + k] = vertices[3 * facets[i] + k];
        [shading[3 * i], shading[3 * i + 1], shading[3 * i + 2]] = [x / length, y / length, z / length];
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
    geometry.setAttribute("normal", new THREE.BufferAttribute(shading, 3));
    return geometry;
}

/** Each facet's unit normal, three numbers a facet, and twice its area. */
function facetNormals(vertices, facets) {
    const count = facets.length / 3;
    const [normals, lengths] = [new Float64Array(3 * count), new Float64Array(count)];
    const vertex = (i) => [vertices[3 * i], vertices[3 * i + 1], vertices[3 * i + 2]];
    for (let f = 0; f < count; f++) {
        const a = vertex(facets[3 * f]);
        const normal = cross(sub(vertex(facets[3 * f + 1]), a), sub(vertex(facets[3 * f + 2]), a));
        lengths[f] = norm(normal);
        normals.set(unit(normal), 3 * f);
    }
    return [normals, lengths];
}

/** The facets around each vertex: those of vertex v are `around[begins[v]]` to `around[begins[v + 1] - 1]`. */
function facetsAround(count, facets) {
    const begins = new Uint32Array(count + 1);
    for (const v of facets) begins[v + 1]++;
    for (let v = 0; v < count; v++) begins[v + 1] += begins[v];
    const [next, around] = [begins.slice(0, count), new Uint32Array(facets.length)];
    facets.forEach((v, i) => (around[next[v]++] = Math.floor(i / 3)));
    return [begins, around];
}

/** The paint of the object: eight octants, the four dark ones of different colours, so that no turn leaves it as it was. */
export function painted(stage, geometry) {
    geometry.computeBoundingBox();
    const center = geometry.boundingBox.getCenter(new THREE.Vector3());
    const material = stage.surface({}, { roughness: 0.55, metalness: 0 });
    const color = (hex) => ({ value: new THREE.Color(hex) });
    const paint = {
        bodyCenter: { value: center },
        paintLight: color("#f1ede4"),
        paintA: color("#2f3e5c"),
        paintB: color("#5d7391"),
        paintC: color("#8f9bb0"),
        paintD: color("#b5525c"),
    };
    material.onBeforeCompile = (shader) => {
        Object.assign(shader.uniforms, paint);
        shader.vertexShader = shader.vertexShader
            .replace("#include <common>", "#include <common>\nvarying vec3 bodyPoint;")
            .replace("#include <begin_vertex>", "#include <begin_vertex>\nbodyPoint = position;");
        shader.fragmentShader = shader.fragmentShader
            .replace("#include <common>", `#include <common>\n${PAINT_HEADER}`)
            .replace("#include <color_fragment>", PAINT);
    };
    return material;
}

const PAINT_HEADER = `
varying vec3 bodyPoint;
uniform vec3 bodyCenter, paintLight, paintA, paintB, paintC, paintD;`;

const PAINT = `
vec3 octant = bodyPoint - bodyCenter;
vec3 soft = max(fwidth(octant), vec3(1e-7));
vec3 side = clamp(octant / soft, -1.0, 1.0);
vec3 dark = octant.x > 0.0 ? (octant.y > 0.0 ? paintA : paintB) : (octant.y > 0.0 ? paintC : paintD);
diffuseColor.rgb = mix(paintLight, dark, 0.5 - 0.5 * side.x * side.y * side.z);`;

/** Three arrows along the axes of a frame: red x, green y, blue z. */
export function axes(length) {
    const group = new THREE.Group();
    const turns = [[0.7071, 0, 0.7071, 0], [0.7071, -0.7071, 0, 0], [1, 0, 0, 0]];
    ["#e5484d", "#46a758", "#3e7bfa"].forEach((color, i) => {
        const material = new THREE.MeshBasicMaterial({ color });
        const shaft = new THREE.CylinderGeometry(length * 0.014, length * 0.014, length, 10).rotateX(Math.PI / 2);
        const head = new THREE.ConeGeometry(length * 0.045, length * 0.14, 16).rotateX(Math.PI / 2);
        const arrow = new THREE.Group();
        arrow.add(new THREE.Mesh(shaft.translate(0, 0, length / 2), material));
        arrow.add(new THREE.Mesh(head.translate(0, 0, length), material));
        place(arrow, { p: [0, 0, 0], q: turns[i] });
        group.add(arrow);
    });
    return group;
}
