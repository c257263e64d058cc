// The keyboard.

import { LAYERS } from "./stage.js";

/** Speeds that the keys and the menu offer. */
export const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4, 8];

/** What each key does: keys, what it says in the help, action. */
export function bindings(app) {
    const { player } = app;
    const faster = (step) => () => {
        const place = Math.min(Math.max(SPEEDS.indexOf(player.speed) + step, 0), SPEEDS.length - 1);
        player.setSpeed(SPEEDS[place]);
    };
    const layers = LAYERS.filter(([key]) => app.has(key)).map(([key, name, letter]) => [[letter], `${name} on or off`, () => app.toggle(key)]);
    return [
        [[" ", "k"], "Play or pause", () => player.togglePlay()],
        [["ArrowLeft"], "To the start of the segment, then of the one before", () => player.stepSegment(-1)],
        [["ArrowRight"], "To the end of the segment", () => player.stepSegment(1)],
        [[","], "One state back", () => player.stepState(-1)],
        [["."], "One state on", () => player.stepState(1)],
        [["Home"], "To the beginning", () => player.seek(app.motion.begin)],
        [["End"], "To the end", () => player.seek(app.motion.end)],
        [["-", "ArrowDown"], "Slower", faster(-1)],
        [["+", "=", "ArrowUp"], "Faster", faster(1)],
        ...layers,
        [["0"], "Camera as at first", () => app.stage.resetCamera()],
        [["d"], "Dark or light", () => app.switchTheme()],
        [["?", "h"], "This help", () => app.help()],
    ];
}

const NAMES = { " ": "space", ArrowLeft: "←", ArrowRight: "→", ArrowUp: "↑", ArrowDown: "↓" };
export const keyName = (key) => NAMES[key] ?? key;

export function listen(app, list) {
    document.addEventListener("keydown", (event) => {
        if (event.ctrlKey || event.metaKey || event.altKey || document.querySelector("dialog[open]")) return;
        const target = event.target;
        if (target.closest("select, textarea, input:not([type=range]):not([type=checkbox])")) return;
        // Space and the arrows keep their meaning on buttons, boxes and tabs; the slider leaves them to us.
        if (event.key === " " && target.closest("button, input[type=checkbox], [role=button]")) return;
        if (event.key.startsWith("Arrow") && target.closest("[role=tablist]")) return;
        const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
        const found = list.find(([keys]) => keys.includes(key));
        if (!found) return;
        event.preventDefault();
        found[2]();
    });
}
