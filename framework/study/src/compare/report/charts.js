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
  const chart = picture(width, height, "share of runs solved after a time", ...levels, ...timeAxis(x, top, bottom), ...curves);
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

/** Box plots of planning time on a logarithmic scale; where there is little room, names stand above their boxes. */
function boxPlots(names, cells, width) {
  const boxes = cells.filter((cell) => cell.box_plot);
  if (boxes.length === 0) return nothing("No run was solved.");
  const longest = Math.max(...boxes.map((cell) => names[cell.variant].length));
  const isNarrow = width < 480 || 6.6 * longest > 0.42 * width;
  const left = isNarrow ? 12 : 12 + 6.6 * longest;
  const [right, top, step] = [width - 18, isNarrow ? 0 : 4, isNarrow ? 42 : 28];
  const bottom = top + step * boxes.length;
  const values = boxes.flatMap(({ box_plot: box }) => [...box.whiskers, ...box.outliers]);
  const x = logScale(values, left, right);
  const rows = boxes.map((cell, row) => {
    const y = top + step * (row + 0.5) + (isNarrow ? 8 : 0);
    const place = isNarrow ? { x: 0, y: y - 14 } : { x: left - 10, y: y + 4, "text-anchor": "end" };
    const label = drawn("text", place, fitting(names[cell.variant], isNarrow ? width : left));
    return drawn("g", { class: "box" }, label, ...boxPlot(cell, names[cell.variant], x.place, y));
  });
  return picture(width, bottom + 26, "planning times", ...timeAxis(x, top, bottom), ...rows);
}

function boxPlot(cell, name, place, y) {
  const { box_plot: box } = cell;
  const { color } = look(cell.variant);
  const [first, median, third] = box.quartiles.map(place);
  const [low, high] = box.whiskers.map(place);
  const line = (x1, x2, dy1, dy2, width) => drawn("line", { x1, x2, y1: y + dy1, y2: y + dy2, stroke: color, "stroke-width": width });
  const title = `${name}: median ${duration(box.quartiles[1])}, quartiles ${duration(box.quartiles[0])} and ${duration(box.quartiles[2])}, ${cell.successes} runs`;
  const body = { x: first, y: y - 8, width: Math.max(1, third - first), height: 16, rx: 2, fill: color, "fill-opacity": 0.22, stroke: color, "stroke-width": 1.3 };
  return [
    drawn("title", {}, title),
    line(low, first, 0, 0, 1.3), line(third, high, 0, 0, 1.3), line(low, low, -4, 4, 1.3), line(high, high, -4, 4, 1.3),
    drawn("rect", body), line(median, median, -8, 8, 3),
    ...box.outliers.map((time) => drawn("circle", { cx: place(time), cy: y, r: 2, fill: "none", stroke: color })),
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

/** Every variant against every other: time of the row's divided by that of the column's. */
function pairMatrix(names, cells, pairs) {
  const found = new Map(pairs.flatMap((pair) => [[`${pair.a},${pair.b}`, { pair, turned: false }], [`${pair.b},${pair.a}`, { pair, turned: true }]]));
  const rows = cells.map((row) => {
    const values = cells.map((column) => pairCell(names, row, column, found.get(`${row.variant},${column.variant}`)));
    return element("tr", {}, element("th", { scope: "row" }, names[row.variant]), ...values);
  });
  const matrix = table(["", ...cells.map((cell) => names[cell.variant])], rows, "matrix");
  // Even if all seeds point one way, p is 2 / 2^seeds, times the number of pairs.
  const needed = Math.floor(Math.log2((2 * pairs.length) / 0.05)) + 1;
  const isHopeless = Math.max(...pairs.map((pair) => pair.both)) < needed;
  const warning = `With ${pairs.length} pairs no difference can show in fewer than ${needed} seeds that both solved.`;
  return element("div", {}, isHopeless ? element("p", { class: "quiet small" }, warning) : null, matrix);
}

function pairCell(names, row, column, entry) {
  if (!entry) return element("td", { class: "none" }, "");
  const { pair, turned } = entry;
  const [mine, theirs] = turned ? [pair.only[1], pair.only[0]] : pair.only;
  const solving = `${pair.both} seeds solved by both, ${mine} by ${names[row.variant]} alone, ${theirs} by ${names[column.variant]} alone (${pValue(pair.solved_p)})`;
  const shownSolving = pair.solved_p < 0.05 ? element("small", {}, mine > theirs ? "solves more" : "solves less") : null;
  if (!pair.ratio) return element("td", { class: "none", title: `too few to compare times; ${solving}` }, "–", shownSolving);
  const ratio = turned ? 1 / pair.ratio.value : pair.ratio.value;
  const ends = turned ? [1 / pair.ratio.high, 1 / pair.ratio.low] : [pair.ratio.low, pair.ratio.high];
  const title = `${names[row.variant]} takes ${digits(ratio)} (${ends.map(digits).join(" to ")}) times as long as ${names[column.variant]}, ${pValue(pair.time_p)}; ${solving}`;
  const shown = pair.time_p < 0.05;
  const strength = Math.min(0.6, 0.12 + 0.28 * Math.abs(Math.log2(ratio)));
  const color = `rgba(var(--${ratio < 1 ? "faster" : "slower"}), ${strength.toFixed(3)})`;
  return element("td", { title, class: shown ? null : "none", style: shown ? `background:${color}` : null }, shown ? `× ${digits(ratio)}` : `≈ ${digits(ratio)}`, shownSolving);
}

/** The figures themselves. */
function figureTable(names, scenario, cells) {
  const text = (value) => (value === null ? "–" : String(value));
  const ends = (estimate, form) => (estimate ? `${form(estimate.low)} to ${form(estimate.high)}` : "–");
  const rows = cells.map((cell) => {
    const failures = Object.entries(cell.failures).map(([status, count]) => `${count} ${status}`).join(", ");
    const values = [`${cell.successes}/${cell.runs}`, ends(cell.success, percent), failures || "–", cell.planning_s ? duration(cell.planning_s.value) : "–", ends(cell.planning_s, duration), text(cell.generated), text(cell.graph), text(cell.regrasps)];
    return element("tr", {}, element("th", { scope: "row" }, names[cell.variant]), ...values.map((value) => element("td", {}, value)));
  });
  const { paper } = scenario;
  if (paper) {
    const values = ["–", "–", "–", duration(paper.time_s), "–", paper.generated_nodes, paper.graph_nodes, "–"];
    rows.push(element("tr", { class: "paper" }, element("th", { scope: "row" }, `published (${paper.example}), averages`), ...values.map((value) => element("td", {}, String(value)))));
  }
  const head = ["", "solved", "95 %", "not solved", "median time", "95 %", "generated nodes", "graph nodes", "regrasps"];
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
