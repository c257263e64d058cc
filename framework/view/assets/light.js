// Sun, sky and ground.

import * as THREE from "three";

/** Lights a stage whose centre, radius and box are known; gives its sun and its grid. */
export function lights({ scene, center, radius: r, box, quick }) {
    const sun = new THREE.DirectionalLight("#fff6e8", 2.3);
    sun.position.copy(center).add(new THREE.Vector3(0.9 * r, -1.1 * r, 3.2 * r));
    sun.target.position.copy(center);
    sun.castShadow = !quick;
    sun.shadow.mapSize.set(1024, 1024);
    Object.assign(sun.shadow.camera, { left: -1.6 * r, right: 1.6 * r, top: 1.6 * r, bottom: -1.6 * r, near: 0.1 * r, far: 8 * r });
    sun.shadow.bias = -0.0005;
    sun.shadow.normalBias = r * 0.004;
    const fill = new THREE.DirectionalLight("#dfe9ff", 0.7);
    fill.position.set(-2 * r, 1.5 * r, r);
    const ground = new THREE.Mesh(new THREE.CircleGeometry(4 * r, 96), new THREE.ShadowMaterial({ opacity: 0.22 }));
    ground.position.set(center.x, center.y, box.min.z - 0.002 * r);
    ground.receiveShadow = true;
    const grid = new THREE.GridHelper(6 * r, 24).rotateX(Math.PI / 2);
    grid.position.copy(ground.position);
    grid.material.transparent = true;
    scene.add(new THREE.HemisphereLight("#ffffff", "#8a8f99", 1.7), sun, sun.target, fill, ground, grid);
    return { sun, grid };
}
