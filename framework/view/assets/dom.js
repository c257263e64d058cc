// Elements of the page, and numbers as people read them.

const SVG = "http://www.w3.org/2000/svg";

export const id = (name) => document.getElementById(name);

export function element(name, attributes = {}, ...children) {
    const node = document.createElement(name);
    for (const [key, value] of Object.entries(attributes)) {
        if (key === "text") node.textContent = value;
        else if (key.startsWith("on")) node.addEventListener(key.slice(2), value);
        else if (value !== null && value !== undefined) node.setAttribute(key, value);
    }
    node.append(...children);
    return node;
}

export function drawing(name, attributes = {}, ...children) {
    const node = document.createElementNS(SVG, name);
    for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
    node.append(...children);
    return node;
}

/** A figure with as many digits as tell it. */
export function number(x) {
    if (x === null || x === undefined) return "–";
    const size = Math.abs(x);
    if (x === 0) return "0";
    if (size < 1e-3 || size >= 1e5) return x.toExponential(2);
    return String(Number(x.toPrecision(4)));
}

/** A figure with its unit, in the unit that people use: metres as millimetres, radians as degrees, parts as per cent. */
export function quantity(x, unit) {
    if (x === null || x === undefined) return "–";
    if (unit === "m") {
        const size = Math.abs(x);
        return size > 0 && size < 9.5e-5 ? `${number(x * 1e6)} µm` : `${number(x * 1e3)} mm`;
    }
    if (unit === "rad") return `${number((x * 180) / Math.PI)}°`;
    if (unit === "of the limit") return `${number(x * 100)} %`;
    if (unit === "faults" || unit === "force" || !unit) return number(x);
    return `${number(x)} ${unit}`;
}

/** How many facets a mesh has, and with how many it is drawn where these are fewer. */
export function facets({ facets, count }) {
    const drawn = facets.length / 3;
    return drawn < count ? `${count} facets (drawn with ${drawn})` : `${count} facets`;
}

/** Names and values below each other. */
export function factList(rows) {
    const list = element("dl", { class: "facts" });
    for (const [name, value] of rows) list.append(element("dt", { text: name }), element("dd", { text: value }));
    return list;
}

/** Gives a file to the user. */
export function download(blob, name) {
    const url = URL.createObjectURL(blob);
    element("a", { href: url, download: name }).click();
    setTimeout(() => URL.revokeObjectURL(url), 60_000);
}

export const rests = () => matchMedia("(prefers-reduced-motion: reduce)").matches;
