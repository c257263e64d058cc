// The page: what is shown, which filters are set, and drawing again where they or the width change.

const data = JSON.parse(document.getElementById("data").textContent);
const names = data.variants.map((variant) => variant.name);
/** What is filtered away: levels by slot, and scenarios. */
const hidden = { levels: new Map(data.varied.map((slot) => [slot, new Set()])), scenarios: new Set() };

function level(variant, slot) {
  return variant.levels[slot] ?? "as in the scenario";
}

function isShown(variant) {
  return data.varied.every((slot) => !hidden.levels.get(slot).has(level(data.variants[variant], slot)));
}

function shownScenarios() {
  return data.scenarios.filter((scenario) => !hidden.scenarios.has(scenario.name));
}

function shownCells(scenario) {
  return scenario.cells.filter((cell) => isShown(cell.variant));
}

function drawHead() {
  const all = data.scenarios.flatMap((scenario) => scenario.cells);
  const [runs, successes] = ["runs", "successes"].map((key) => all.reduce((sum, cell) => sum + cell[key], 0));
  const many = (count, noun) => `${count} ${noun}${count === 1 ? "" : "s"}`;
  const title = `${many(data.variants.length, "variant")} on ${many(data.scenarios.length, "scenario")}`;
  const machines = data.machines.map((machine) => [machine.host, machine.cpu, many(machine.threads, "run") + " at once"].filter(Boolean).join(", "));
  const date = new Date(1e3 * data.started_s).toISOString().slice(0, 16).replace("T", " ");
  document.title = `Regrasp study: ${title}`;
  document.getElementById("head").append(
    element("h1", {}, title),
    element("p", { class: "quiet" }, `${many(runs, "run")} with ${many(data.seeds, "seed")}, ${successes} solved and verified. Planning times on one thread, verification not counted.`),
    element("p", { class: "quiet small" }, `Regrasp ${data.version}, ${date} UTC; ${machines.join("; ")}`),
    element("pre", {}, element("code", {}, data.command)));
}

/** A group of buttons, each of which hides something; the last one that is shown stays. */
function group(title, values, away) {
  const buttons = values.map((value) => {
    const button = element("button", { type: "button", "aria-pressed": "true" }, value);
    button.addEventListener("click", () => {
      if (away.has(value)) away.delete(value);
      else if (away.size + 1 < values.length) away.add(value);
      button.setAttribute("aria-pressed", String(!away.has(value)));
      draw();
    });
    return button;
  });
  return element("fieldset", {}, element("legend", {}, title), ...buttons);
}

function drawFilters() {
  const groups = data.varied.map((slot) => {
    const levels = [...new Set(data.variants.map((variant) => level(variant, slot)))];
    return [slot, levels, hidden.levels.get(slot)];
  });
  groups.push(["scenario", data.scenarios.map((scenario) => scenario.name), hidden.scenarios]);
  const useful = groups.filter(([, values]) => values.length > 1);
  document.getElementById("filters").append(...useful.map(([title, values, away]) => group(title, values, away)));
}

/** Which combination wins where: rows are variants, columns scenarios. */
function winners(scenarios) {
  const shown = data.variants.map((_, k) => k).filter(isShown);
  const rows = shown.map((variant) => {
    const cells = scenarios.map((scenario) => winnerCell(scenario, variant));
    return element("tr", {}, element("th", { scope: "row" }, names[variant]), ...cells);
  });
  return table(["", ...scenarios.map((scenario) => scenario.name)], rows, "winners");
}

function winnerCell(scenario, variant) {
  const cell = scenario.cells.find((other) => other.variant === variant);
  if (!cell) return element("td", { class: "none", title: "left out" }, "–");
  const solved = element("small", {}, `${cell.successes}/${cell.runs}`);
  if (cell.median_of_all_s === null) return element("td", { class: "none", title: "half of the runs or more failed" }, "–", solved);
  const fastest = Math.min(...scenario.cells.map((other) => other.median_of_all_s ?? Infinity));
  const place = scenario.best.indexOf(variant);
  const shade = 0.55 * Math.max(0, 1 - Math.log2(cell.median_of_all_s / fastest) / 2.5);
  const title = ["the fastest at the median", "not shown to differ from the fastest"][Math.min(place, 1)] ?? `median ${digits(cell.median_of_all_s / fastest)} times that of the fastest`;
  return element("td", { class: ["best", "tie"][Math.min(place, 1)] ?? null, title, style: `background:rgba(var(--heat), ${shade.toFixed(3)})` }, duration(cell.median_of_all_s), solved);
}

function drawOverview() {
  const scenarios = shownScenarios();
  document.getElementById("overview").replaceChildren(
    element("h2", {}, data.variants.length > 1 ? "Which combination wins where" : "All scenarios"),
    element("p", { class: "quiet small" }, "Median time over all runs, one that fails counting as endless, and how many were solved. Thick frame: the fastest of the scenario; thin frame: compared with it, and no difference in time or in solving is shown. The stronger the colour, the closer to the fastest."),
    winners(scenarios),
    ...remark());
}

/** Whether the paper's remark holds, that most of the time goes to stability and collision. */
function remark() {
  if (!data.remark) return [];
  const { variant, stability, collision, holds, scenarios } = data.remark;
  const both = stability + collision;
  const verdict = holds === scenarios ? "it holds here" : holds === 0 ? "it does not hold here" : `it holds for ${holds} of ${scenarios} scenarios`;
  const text = `The paper remarks that most of its time is spent for checking stability and collision: ${verdict}. With “${variant}” collision and distance take ${percent(collision)} of the planning time and stability tests ${percent(stability)}, together ${percent(both)} (mean of the scenarios' shares).`;
  return [element("p", { id: "remark", style: "margin-top:14px" }, text)];
}

function chart(title, content, kind = "chart") {
  return element("figure", { class: kind, style: "margin:0" }, element("h3", {}, title), content);
}

function scenarioCard(scenario) {
  const cells = shownCells(scenario);
  const card = element("section", { class: "card" });
  const facts = element("div", {}, element("h2", {}, scenario.name), element("p", {}, scenario.summary), findingOf(scenario.finding),
    ...scenario.left_out.map((pair) => element("p", { class: "quiet small" }, `Not planned by “${pair.variant}”: ${pair.reason}`)),
    element("p", { class: "quiet small" }, scenario.source));
  const strip = element("div", { class: "strip" });
  if (scenario.strip) strip.innerHTML = scenario.strip; // made by the program, with no text of users in it
  card.append(element("div", { class: "about" }, facts, strip));
  if (cells.length === 0) return card;
  const width = Math.max(280, chartWidth());
  card.append(element("div", { class: "charts" },
    chart("solved after a time (% of all runs)", solvedCurves(names, cells, width)),
    chart("planning time of solved runs", timeBoxes(names, cells, width)),
    chart("planning time by who spent it (mean of the solved runs)", roleBars(names, cells, data.roles, width)),
    chart("rejections by cause, mean of a run", rejectionTable(names, cells, data.causes)),
    scenario.matrix.rows.length > 0 ? chart("differences (a number: shown; same: within the band; not shown; too few seeds)", verdictMatrix(scenario.matrix, isShownRow), "chart wide") : null,
    chart("figures", figureTable(names, scenario, cells), "chart wide"),
    ...furtherBoxes(scenario, cells, width)));
  return card;
}

/** What may be said, in words. */
function findingOf({ lead, lines }) {
  const list = lines.map((line) => element("li", {}, line));
  return element("div", { class: "finding" }, element("p", {}, lead), list.length > 0 ? element("ul", {}, ...list) : null);
}

/** Whether all variants that a row of the matrix is about are shown. */
function isShownRow(row) {
  return row.variants.every(isShown);
}

function furtherBoxes(scenario, cells, width) {
  return scenario.boxes.map((measure) => chart(`${measure.measure}, solved runs`, measureBoxes(names, measure, cells, width), "chart further"));
}

/** Width of one of two columns, or of the only one on a narrow page. */
function chartWidth() {
  const all = document.querySelector("main").clientWidth;
  return matchMedia("(max-width: 760px)").matches ? all : (all - 32) / 2;
}

function drawNotes() {
  const notes = [
    ...(data.family ? [data.family] : []),
    "Solved: the plan reaches all goals and the verifier accepts it. Intervals hold 95 %: Wilson's for shares, bootstrap for medians.",
    "Each measure is compared seed by seed by Wilcoxon's signed-rank test; who solves more by McNemar's exact test; factors by the same test on contrasts within a seed. Differences are estimates of Hodges and Lehmann (of shares: Newcombe's), each with the interval that belongs to its corrected test: it leaves out zero where a difference is shown, and nowhere else. Where none is shown there may be one all the same. Planning times: a run that fails counts as the whole time limit, or without one as the longest run. Other measures: seeds on which both succeeded.",
    "Box plots: median, quartiles, whiskers to the last run within 1.5 boxes (on the logarithmic scale). Point at anything for its figures; all of them are in summary.csv, comparisons.csv and runs.csv.",
  ];
  document.getElementById("notes").append(element("h3", {}, "How to read this"), ...notes.map((text) => element("p", { class: "quiet small" }, text)));
}

function draw() {
  drawOverview();
  document.getElementById("scenarios").replaceChildren(...shownScenarios().map(scenarioCard));
}

drawHead();
drawFilters();
drawNotes();
draw();
let lastWidth = innerWidth;
addEventListener("resize", () => {
  if (innerWidth !== lastWidth) draw();
  lastWidth = innerWidth;
});
