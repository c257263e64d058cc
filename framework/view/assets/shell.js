// What all pages have round their scene: theme, layers, tabs, keyboard, help.

import { element, id } from "./dom.js";

export function complain(text) {
    id("problem").hidden = false;
    id("problem").textContent = text;
}

/** Dark or light, as the system has it until somebody chooses. */
export class Theme {
    constructor(stage) {
        this.stage = stage;
        const preferred = matchMedia("(prefers-color-scheme: dark)");
        preferred.addEventListener("change", () => this.stored() || this.set(preferred.matches));
        id("theme").addEventListener("click", () => this.flip());
        this.set(this.stored() ? this.stored() === "dark" : preferred.matches);
    }

    stored() {
        try {
            return localStorage.getItem("regrasp-theme");
        } catch {
            return null; // Some browsers keep nothing for pages from files.
        }
    }

    set(dark) {
        this.dark = dark;
        document.documentElement.dataset.theme = dark ? "dark" : "light";
        const style = getComputedStyle(document.documentElement);
        this.stage.theme(style.getPropertyValue("--stage").trim(), style.getPropertyValue("--grid").trim());
        id("theme").setAttribute("aria-label", dark ? "Switch to light" : "Switch to dark");
    }

    flip() {
        this.set(!this.dark);
        try {
            localStorage.setItem("regrasp-theme", this.dark ? "dark" : "light");
        } catch {
            // Then it lasts as long as the page.
        }
    }
}

/** The boxes that show and hide layers of the scene; `layers` hold key, name, letter, whether shown at first. */
export class Layers {
    constructor(stage, layers) {
        this.stage = stage;
        this.boxes = {};
        for (const [key, name, letter, shown] of layers) {
            const box = element("input", { type: "checkbox", onchange: () => stage.toggle(key, box.checked) });
            box.checked = shown;
            stage.toggle(key, shown);
            this.boxes[key] = box;
            id("layers").append(element("label", { title: `key ${letter}` }, box, element("span", { text: name })));
        }
    }

    set(key, shown) {
        this.boxes[key].checked = shown;
        this.stage.toggle(key, shown);
    }

    toggle(key) {
        this.set(key, !this.boxes[key].checked);
    }
}

/** Tabs of the panel beside the scene; `names` hold the panel's id and the tab's name. */
export class Tabs {
    constructor(names, opened = () => {}) {
        this.opened = opened;
        this.buttons = names.map(([panel, name]) => {
            const button = element("button", { type: "button", role: "tab", id: `tab-${panel}`, "aria-controls": panel, text: name });
            button.addEventListener("click", () => this.open(panel));
            id("tabs").append(button);
            return button;
        });
        id("tabs").addEventListener("keydown", (event) => {
            const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
            if (!step) return;
            const next = (this.buttons.indexOf(document.activeElement) + step + names.length) % names.length;
            this.open(names[next][0]);
            this.buttons[next].focus();
        });
    }

    open(panel) {
        for (const button of this.buttons) {
            const chosen = button.id === `tab-${panel}`;
            button.setAttribute("aria-selected", chosen);
            button.tabIndex = chosen ? 0 : -1;
            id(button.getAttribute("aria-controls")).hidden = !chosen;
        }
        document.body.dataset.tab = panel;
        this.opened(panel);
    }
}

/** Keys that turn the scene, on every page. */
export function cameraKeys(stage) {
    const turn = 0.12;
    return [
        [["Shift+ArrowLeft"], "Turn the view to the left", () => stage.orbit(-turn, 0)],
        [["Shift+ArrowRight"], "Turn the view to the right", () => stage.orbit(turn, 0)],
        [["Shift+ArrowUp"], "Look from higher up", () => stage.orbit(0, -turn)],
        [["Shift+ArrowDown"], "Look from lower down", () => stage.orbit(0, turn)],
        [["PageUp"], "Nearer", () => stage.zoom(0.85)],
        [["PageDown"], "Farther", () => stage.zoom(1 / 0.85)],
        [["0"], "Camera as at first", () => stage.resetCamera()],
    ];
}

/** Keys for layers. */
export const layerKeys = (layers, boxes) => layers.map(([key, name, letter]) => [[letter], `${name} on or off`, () => boxes.toggle(key)]);

const NAMES = { " ": "space", ArrowLeft: "←", ArrowRight: "→", ArrowUp: "↑", ArrowDown: "↓" };
const keyName = (key) => key.split("+").map((part) => NAMES[part] ?? part).join(" ") || "+";

/** Writes the help, and listens; `list` holds keys, what the help says, and what is done. */
export function keyboard(list) {
    for (const [keys, text] of list) {
        id("help-list").append(element("dt", {}, ...keys.map((key) => element("kbd", { text: keyName(key) }))), element("dd", { text }));
    }
    id("help-button").addEventListener("click", () => id("help").showModal());
    document.addEventListener("keydown", (event) => {
        if (event.ctrlKey || event.metaKey || event.altKey || document.querySelector("dialog[open]")) return;
        const target = event.target;
        if (target.closest("select, textarea, input:not([type=range]):not([type=checkbox])")) return;
        // Space, Enter and the arrows keep their meaning on buttons, boxes, tabs and sliders; the play head's slider leaves them to us.
        if (event.key === " " && target.closest("button, summary, input[type=checkbox], [role=button]")) return;
        if (event.key.startsWith("Arrow") && target.closest("[role=tablist]")) return;
        if (/^(Arrow|Home|End|Page)/.test(event.key) && target.closest("input[type=range]:not(#scrub)")) return;
        const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
        const name = event.shiftKey && event.key.length > 1 ? `Shift+${key}` : key;
        const found = list.find(([keys]) => keys.includes(name));
        if (!found) return;
        event.preventDefault();
        found[2]();
    });
}

/** Reads a page's data. */
export const pageData = () => JSON.parse(id("data").textContent);
