// The verifier's checks as a table: sorted by any column, each with its place in time and in the scene.

import { element, number, quantity } from "./dom.js";

/** How much of its limit a check uses up: 1 at the limit, more beyond. */
export function used({ ok, worst, limit, sign }) {
    if (worst === null) return -Infinity;
    if (limit === 0) return ok ? 0 : Infinity;
    return sign === "≤" ? worst / limit : limit / worst;
}

const COLUMNS = [
    ["check", "Check", (check) => check.name],
    ["worst", "Worst", (check) => used(check)],
    ["limit", "Limit", (check) => check.unit + check.limit],
    ["time", "Time", (check) => check.time ?? Infinity],
];

export class CheckTable {
    /** `visit` is called with the check whose place is asked for. */
    constructor(parent, checks, visit) {
        this.rows = checks.map((check) => ({ check, body: this.row(check, visit) }));
        this.heads = COLUMNS.map(([key, name]) => {
            const button = element("button", { type: "button", class: "sorter", title: "Sort", onclick: () => this.sort(key) }, name);
            return element("th", { scope: "col", class: key }, button);
        });
        this.table = element("table", { class: "checks" }, element("caption", { text: "Click a time to see the place." }), element("thead", {}, element("tr", {}, ...this.heads)));
        this.table.append(...this.rows.map(({ body }) => body));
        parent.append(this.table);
    }

    row(check, visit) {
        const where = check.place.replaceAll("`", "");
        const mark = element("span", { class: "mark", "aria-hidden": "true", text: check.ok ? "✓" : "✗" });
        const name = element("th", { scope: "row" }, mark, element("span", { class: "unseen", text: check.ok ? "ok: " : "FAILED: " }), check.name);
        const time = check.time === null
            ? element("span", { text: "–" })
            : element("button", { type: "button", class: "link", "aria-label": `Show ${check.name}: ${where}`, text: `${check.time.toFixed(2)} s`, onclick: () => visit(check) });
        const cells = [
            name,
            element("td", { text: quantity(check.worst, check.unit), title: `${number(check.worst)} ${check.unit}` }),
            element("td", { text: `${check.sign} ${quantity(check.limit, check.unit)}`, title: `${number(check.limit)} ${check.unit}` }),
            element("td", {}, time),
        ];
        const state = check.ok ? "" : "failed";
        const rows = [element("tr", { class: state }, ...cells)];
        if (where) rows.push(element("tr", { class: `where ${state}` }, element("td", { colspan: 4, text: where })));
        return element("tbody", { "data-check": check.name }, ...rows);
    }

    sort(key) {
        const up = !(this.sorted === key && this.up);
        [this.sorted, this.up] = [key, up];
        const value = COLUMNS.find(([column]) => column === key)[2];
        const compare = (a, b) => {
            const [x, y] = [value(a.check), value(b.check)];
            if (x === y) return 0;
            return x < y === up ? -1 : 1;
        };
        this.table.append(...[...this.rows].sort(compare).map(({ body }) => body));
        this.heads.forEach((head, i) => {
            if (COLUMNS[i][0] === key) head.setAttribute("aria-sort", up ? "ascending" : "descending");
            else head.removeAttribute("aria-sort");
        });
    }
}
