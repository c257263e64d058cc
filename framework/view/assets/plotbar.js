// Which plots are shown, and the legend that they share.

import { element, id } from "./dom.js";
import { Chart } from "./chart.js";
import { plots } from "./curves.js";

/** How wide (px) a window must be for each plot that is shown at first. */
const WIDTH_OF_PLOT = 400;
/** Below this width (px) the page scrolls, and all plots are shown below each other. */
const SCROLLS = 760;

export class PlotBar {
    constructor(player) {
        this.player = player;
        this.chosen = null;
    }

    /** Builds the plots of a plan; `others` are plans beside it. */
    open(shown, others) {
        this.list = plots(shown, others);
        const first = innerWidth <= SCROLLS ? this.list.length : Math.max(2, Math.floor(innerWidth / WIDTH_OF_PLOT));
        this.chosen ??= new Set(this.list.slice(0, first).map(({ key }) => key));
        const { segments } = shown.motion;
        const bands = segments.filter((segment) => segment.kind === "regrasp");
        const span = [this.player.begin, this.player.end];
        id("curves").replaceChildren();
        this.charts = this.list.map((plot) => {
            const chart = new Chart(id("curves"), { ...plot, bands, span, seek: (time) => this.player.seek(time) });
            chart.figure.hidden = !this.chosen.has(plot.key);
            return chart;
        });
        id("plot-bar").replaceChildren(...this.chips(), this.legend(shown, others, bands));
        id("plots").hidden = !this.list.length;
    }

    chips() {
        return this.list.map(({ key, name }, i) => {
            const chip = element("button", { type: "button", class: "chip", "aria-pressed": this.chosen.has(key), text: name });
            chip.addEventListener("click", () => {
                const shown = !this.chosen.delete(key);
                if (shown) this.chosen.add(key);
                chip.setAttribute("aria-pressed", shown);
                this.charts[i].figure.hidden = !shown;
                this.charts[i].draw();
                if (this.time !== undefined) this.charts[i].show(this.time);
            });
            return chip;
        });
    }

    legend({ motion }, others, bands) {
        const entry = (kind, text, color) => element("span", {}, element("i", { class: kind, style: color ? `--own:${color}` : null }), text);
        const entries = [entry("dashed", "limit"), entry("ring", "worst value")];
        if (bands.length) entries.unshift(entry("shade", "regrasp"));
        const curves = this.list.find(({ sets }) => sets[0].series.length > 1 && !sets[0].series.some((s) => s.faint));
        curves?.sets[0].series.forEach(({ name, color }) => entries.push(entry("stroke", name, color)));
        others.forEach(({ label, color }) => entries.push(entry("stroke", label, color)));
        return element("p", { class: "legend plot-legend", "aria-label": "Legend of the plots" }, ...entries);
    }

    show(time) {
        this.time = time;
        this.charts.forEach((chart) => chart.figure.hidden || chart.show(time));
    }
}
