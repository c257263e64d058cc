// One function a chart; each gets a scenario, its shown cells and the width of its place.

/** Curves of the share of runs that are solved after a time. */
function solvedCurves(names, cells, width) {
  const times = cells.flatMap((cell) => cell.ecdf.map(([time]) => time));
  if (times.length === 0) return nothing("No run was solved.");
  const [left, right, top, bottom, height] = [38, width - 14, 8, 196, 222];
  const x = logScale(times, left, right);
  const y = (share) => bottom - (bottom - top) * share;
  const levels = [0, 0.25, 0.5, 0.75, 1].flatMap((share) => [
    drawn("line", { class: "rule", x1: left, x2: right, y1: y(share), y2: y(share) }),
    drawn("text", { class: "tick", x: left - 6, y: y(share) + 4, "text-anchor": "end" }, `${100 * share}`),
  ]);
  const curves = cells.filter((cell) => cell.ecdf.length > 0).map((cell) => {
    const steps = cell.ecdf.map(([time, share]) => `H${x.place(time).toFixed(1)}V${y(share).toFixed(1)}`);
    const { color, dashes } = look(cell.variant);
    const d = `M${left} ${y(0)}${steps.join("")}H${right}`;
    const end = percent(cell.ecdf.at(-1)[1]);
    const title = drawn("title", {}, `${names[cell.variant]}: ${end} solved`);
    return drawn("path", { class: "curve", d, stroke: color, "stroke-dasharray": dashes || null }, title);
  });
  const chart = picture(width, height, "share of runs solved after a time", ...levels, ...axis(x, top, bottom, tickLabel), ...curves);
  return element("div", {}, chart, lineKey(names, cells));
}

function lineKey(names, cells) {
  const entries = cells.map((cell) => {
    const { color, dashes } = look(cell.variant);
    const line = drawn("line", { x1: 0, x2: 22, y1: 5, y2: 5, stroke: color, "stroke-width": 2.5, "stroke-dasharray": dashes || null });
    return element("span", {}, drawn("svg", { viewBox: "0 0 22 10", "aria-hidden": "true" }, line), names[cell.variant]);
  });
  return element("div", { class: "key" }, ...entries);
}

/** Box plots of planning time on a logarithmic scale. */
function timeBoxes(names, cells, width) {
  const boxes = cells.filter((cell) => cell.box_plot).map((cell) => [cell.variant, cell.box_plot]);
  if (boxes.length === 0) return nothing("No run was solved.");
  return boxPlots("planning times", names, boxes, width, duration, logScale, tickLabel);
}

/** Box plots of another measure on a linear scale. */
function measureBoxes(names, measure, cells, width) {
  const shown = measure.boxes.filter(([variant]) => cells.some((cell) => cell.variant === variant));
  if (shown.length === 0) return nothing("No run has it.");
  const text = unitText(measure.unit);
  return boxPlots(measure.measure, names, shown, width, text, linearScale, text);
}

/** Box plots, a row a variant; where there is little room, names stand above their boxes. */
function boxPlots(title, names, boxes, width, text, scaleOf, tickText) {
  const longest = Math.max(...boxes.map(([variant]) => names[variant].length));
  const isNarrow = width < 480 || 6.6 * longest > 0.42 * width;
  const left = isNarrow ? 12 : 12 + 6.6 * longest;
  const [right, top, step] = [width - 18, isNarrow ? 0 : 4, isNarrow ? 42 : 28];
  const bottom = top + step * boxes.length;
  const values = boxes.flatMap(([, box]) => [...box.whiskers, ...box.outliers]);
  const x = scaleOf(values, left, right);
  const rows = boxes.map(([variant, box], row) => {
    const y = top + step * (row + 0.5) + (isNarrow ? 8 : 0);
    const place = isNarrow ? { x: 0, y: y - 14 } : { x: left - 10, y: y + 4, "text-anchor": "end" };
    const label = drawn("text", place, fitting(names[variant], isNarrow ? width : left));
    return drawn("g", { class: "box" }, label, ...boxPlot(box, variant, names[variant], x.place, y, text));
  });
  return picture(width, bottom + 26, title, ...axis(x, top, bottom, tickText), ...rows);
}

function boxPlot(box, variant, name, place, y, text) {
  const { color } = look(variant);
  const [first, median, third] = box.quartiles.map(place);
  const [low, high] = box.whiskers.map(place);
  const line = (x1, x2, dy1, dy2, width) => drawn("line", { x1, x2, y1: y + dy1, y2: y + dy2, stroke: color, "stroke-width": width });
  const title = `${name}: median ${text(box.quartiles[1])}, quartiles ${text(box.quartiles[0])} and ${text(box.quartiles[2])}`;
  const body = { x: first, y: y - 8, width: Math.max(1, third - first), height: 16, rx: 2, fill: color, "fill-opacity": 0.22, stroke: color, "stroke-width": 1.3 };
  return [
    drawn("title", {}, title),
    line(low, first, 0, 0, 1.3), line(third, high, 0, 0, 1.3), line(low, low, -4, 4, 1.3), line(high, high, -4, 4, 1.3),
    drawn("rect", body), line(median, median, -8, 8, 3),
    ...box.outliers.map((value) => drawn("circle", { cx: place(value), cy: y, r: 2, fill: "none", stroke: color })),
  ];
}

/** Shares of the planning time, stacked by who spent it, with the whole at the end. */
function roleBars(names, cells, roles, width) {
  const sum = (cell) => Object.values(cell.roles_s).reduce((all, time) => all + time, 0);
  const measured = cells.filter((cell) => sum(cell) > 0);
  if (measured.length === 0) return nothing("Times of roles were not measured.");
  const rows = measured.flatMap((cell) => {
    const bar = element("div", { class: "bar" }, ...rolePieces(cell, roles, sum(cell), 0.55 * width));
    return [element("div", { class: "name" }, names[cell.variant]), bar, element("em", {}, duration(sum(cell)))];
  });
  const used = roles.map((role, k) => [role, k]).filter(([role]) => measured.some((cell) => cell.roles_s[role] > 0));
  const key = used.map(([role, k]) => element("span", {}, element("i", { style: `background:var(--r${k})` }), role));
  return element("div", {}, element("div", { class: "bars" }, ...rows), element("div", { class: "key" }, ...key));
}

function rolePieces(cell, roles, whole, width) {
  const parts = roles.map((role, k) => [role, k, (cell.roles_s[role] || 0) / whole]).filter(([, , share]) => share > 0);
  return parts.map(([role, k, share]) => {
    const title = `${role}: ${duration(share * whole)}, ${percent(share)}`;
    // Grown by its share from nothing, so that gaps do not make the bar longer than others.
    const style = `flex:${share.toFixed(5)} 1 0;background:var(--r${k})`;
    const isDark = [1, 4, 5, 8].includes(k);
    return element("b", { title, style, class: isDark ? "dark" : null, "data-role": role }, share * width > 32 ? percent(share) : "");
  });
}

/** A table of rejections: rows are variants, columns causes, darker means more. */
function rejectionTable(names, cells, causes) {
  const count = (cell, cause) => Object.values(cell.rejections).reduce((all, slot) => all + (slot[cause] || 0), 0);
  const used = causes.filter((cause) => cells.some((cell) => count(cell, cause) > 0));
  if (used.length === 0) return nothing("Nothing was rejected.");
  const most = Math.max(...cells.flatMap((cell) => used.map((cause) => count(cell, cause))));
  const rows = cells.map((cell) => {
    const values = used.map((cause) => {
      const value = count(cell, cause);
      const slots = Object.entries(cell.rejections).filter(([, counts]) => counts[cause] > 0);
      const title = slots.map(([slot, counts]) => `${slot}: ${digits(counts[cause])}`).join("\n");
      const shade = value > 0 ? 0.06 + (0.5 * Math.log1p(value)) / Math.log1p(most) : 0;
      return element("td", { title, style: `background:rgba(var(--many), ${shade.toFixed(3)})` }, value > 0 ? digits(value) : "·");
    });
    return element("tr", {}, element("th", { scope: "row" }, names[cell.variant]), ...values);
  });
  return table(["", ...used], rows, "rejections");
}

/** Every question in every measure, with the verdict that the sentences tell. */
function verdictMatrix(matrix, isShownRow) {
  const rows = matrix.rows.filter(isShownRow).map((row) => {
    const cells = row.answers.map(({ text, title, shown, better }) => {
      const color = better > 0 ? "faster" : "slower";
      const style = shown ? `background:rgba(var(--${better === 0 ? "many" : color}), ${better === 0 ? 0.12 : 0.3})` : null;
      return element("td", { title, class: shown ? null : "none", style }, text);
    });
    return element("tr", {}, element("th", { scope: "row" }, row.subject), ...cells);
  });
  return table(["", ...matrix.measures], rows, "matrix");
}

/** The figures themselves. */
function figureTable(names, scenario, cells) {
  const text = (value) => (value === null ? "–" : String(value));
  const ends = (estimate, form) => (estimate ? `${form(estimate.low)} to ${form(estimate.high)}` : "–");
  const rows = cells.map((cell) => {
    const failures = Object.entries(cell.failures).map(([status, count]) => `${count} ${status}`).join(", ");
    const values = [`${cell.successes}/${cell.runs}`, ends(cell.success, percent), failures || "–", cell.planning_s ? duration(cell.planning_s.value) : "–", ends(cell.planning_s, duration), cell.memory === null ? "–" : size(cell.memory), text(cell.generated), text(cell.graph), text(cell.regrasps)];
    return element("tr", {}, element("th", { scope: "row" }, names[cell.variant]), ...values.map((value) => element("td", {}, value)));
  });
  const { paper } = scenario;
  if (paper) {
    const values = ["–", "–", "–", duration(paper.time_s), "–", "–", paper.generated_nodes, paper.graph_nodes, "–"];
    rows.push(element("tr", { class: "paper" }, element("th", { scope: "row" }, `published (${paper.example}), averages`), ...values.map((value) => element("td", {}, String(value)))));
  }
  const head = ["", "solved", "95 %", "not solved", "median time", "95 %", "memory", "generated nodes", "graph nodes", "regrasps"];
  return table(head, rows, "plain");
}

function table(head, rows, kind) {
  const cells = head.map((text) => element("th", { scope: "col" }, text));
  const body = element("table", { class: kind }, element("thead", {}, element("tr", {}, ...cells)), element("tbody", {}, ...rows));
  return element("div", { class: "scroll" }, body);
}

function nothing(text) {
  return element("p", { class: "quiet small" }, text);
}
