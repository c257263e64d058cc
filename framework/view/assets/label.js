// Words in the scene.

import * as THREE from "three";

/** A word that always faces the camera, `height` metres tall, in front of everything. */
export function word(text, height, color) {
    const canvas = document.createElement("canvas");
    const context = canvas.getContext("2d");
    const font = "600 44px system-ui, sans-serif";
    context.font = font;
    [canvas.width, canvas.height] = [Math.ceil(context.measureText(text).width) + 36, 64];
    context.font = font;
    context.fillStyle = "#ffffffe6";
    context.beginPath();
    context.roundRect(0, 0, canvas.width, canvas.height, 18);
    context.fill();
    context.fillStyle = color;
    context.fillRect(0, 54, canvas.width, 10);
    context.fillStyle = "#14181d";
    context.textBaseline = "middle";
    context.fillText(text, 18, 29);
    const texture = new THREE.CanvasTexture(canvas);
    texture.colorSpace = THREE.SRGBColorSpace;
    const sprite = new THREE.Sprite(new THREE.SpriteMaterial({ map: texture, depthTest: false, transparent: true }));
    sprite.scale.set((height * canvas.width) / canvas.height, height, 1);
    sprite.renderOrder = 30;
    return sprite;
}
