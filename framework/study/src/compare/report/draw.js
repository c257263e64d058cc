"use strict";
// Elements, numbers and scales: what all charts are made of.

/** An element with attributes and children; text becomes text, never HTML. */
function element(name, attributes = {}, ...children) {
  return filled(document.createElement(name), attributes, children);
}

/** The same for SVG. */
function drawn(name, attributes = {}, ...children) {
  return filled(document.createElementNS("http://www.w3.org/2000/svg", name), attributes, children);
}

function filled(node, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (value !== null && value !== undefined) node.setAttribute(name, value);
  }
  node.append(...children.flat().filter((child) => child !== null && child !== undefined));
  return node;
}

/** An SVG picture of this size, with a title for those who cannot see it. */
function picture(width, height, title, ...children) {
  return drawn("svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": title }, ...children);
}

/** Three significant digits, or all before the point. */
function digits(value) {
  if (value === 0) return "0";
  const after = Math.min(6, Math.max(0, 2 - Math.floor(Math.log10(Math.abs(value)))));
  return value.toFixed(after);
}

/** Seconds as a person reads them. */
function duration(s) {
  if (s < 1e-3) return `${digits(1e6 * s)} µs`;
  return s < 1 ? `${digits(1e3 * s)} ms` : `${digits(s)} s`;
}

/** Bytes as a person reads them, in powers of ten. */
function size(bytes) {
  return bytes < 1e6 ? `${digits(1e-3 * bytes)} kB` : `${digits(1e-6 * bytes)} MB`;
}

/** Seconds on an axis: no digit that says nothing. */
function tickLabel(s) {
  return duration(s).replace(/\.?0+ /, (zeros) => (zeros.startsWith(".") ? " " : zeros));
}

function percent(share) {
  return `${(100 * share).toFixed(0)} %`;
}

/** A p-value: never 0. */
function pValue(p) {
  return p < 0.001 ? "p < 0.001" : `p = ${p.toFixed(p < 0.0995 ? 3 : 2)}`;
}

/** A logarithmic scale from these values to the paper, ends at 1, 2 or 5 times a power of ten, with its ticks. */
function logScale(values, low, high) {
  const [least, most] = [Math.min(...values), Math.max(...values)];
  const steps = [];
  for (let power = Math.floor(Math.log10(least)) - 1; power <= Math.log10(most) + 1; power += 1) {
    steps.push(...[1, 2, 5].map((step) => step * 10 ** power));
  }
  const from = steps.filter((step) => step <= least * (1 + 1e-9)).at(-1);
  const to = steps.find((step) => step >= most * (1 - 1e-9) && step > from);
  const place = (value) => low + ((high - low) * Math.log(value / from)) / Math.log(to / from);
  let ticks = steps.filter((step) => step >= from && step <= to);
  // Room for about one tick in 55 units: else only powers of ten, and the ends if there are none.
  if (ticks.length > 1 + (high - low) / 55) {
    const tens = ticks.filter((step) => Math.abs(Math.log10(step) - Math.round(Math.log10(step))) < 1e-9);
    ticks = tens.length > 1 ? tens : [from, to];
  }
  return { place, ticks, from, to };
}

/** A linear scale from these values to the paper, with ticks at 1, 2 or 5 times a power of ten. */
function linearScale(values, low, high) {
  let [from, to] = [Math.min(...values), Math.max(...values)];
  if (to - from < 1e-9 * Math.max(Math.abs(from), Math.abs(to), 1e-9)) {
    const room = 0.1 * Math.abs(to) || 1;
    [from, to] = [from - room, to + room];
  }
  const rough = (to - from) / Math.max(2, (high - low) / 70);
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((factor) => factor * power).find((width) => width >= rough);
  const room = 0.04 * (to - from);
  const place = (value) => low + ((high - low) * (value - from + room)) / (to - from + 2 * room);
  const ticks = [];
  for (let k = Math.ceil((from - room) / step); k * step <= to + room; k += 1) ticks.push(k * step);
  return { place, ticks, from, to };
}

/** How numbers of a unit are told. */
function unitText(unit) {
  const plain = (value) => (value < 0 ? `-${digits(-value)}` : digits(value)).replace(/(\.\d*?)0+$/, "$1").replace(/\.$/, "");
  if (unit === "s") return (s) => (s === 0 ? "0 s" : tickLabel(s));
  if (unit === "m") return (m) => `${plain(1e3 * m)} mm`;
  if (unit === "bytes") return (bytes) => (bytes === 0 ? "0" : size(bytes));
  if (unit === "share") return (share) => `${plain(1e2 * share)} %`;
  return (value) => (unit ? `${plain(value)} ${unit}` : plain(value));
}

/** The axis of a scale, with lines up to `top`. */
function axis(scale, top, bottom, text) {
  return scale.ticks.flatMap((tick) => {
    const x = scale.place(tick);
    const label = drawn("text", { class: "tick", x, y: bottom + 16, "text-anchor": "middle" }, text(tick));
    return [drawn("line", { class: "rule", x1: x, x2: x, y1: top, y2: bottom }), label];
  });
}

/** Colour and dashes of a variant: seven colours, then the same with dashes. */
function look(variant) {
  const dashes = ["", "6 3", "2 3", "8 3 2 3", "1 2"];
  return { color: `var(--v${variant % 7})`, dashes: dashes[Math.floor(variant / 7) % dashes.length] };
}

/** As much of a name as fits, its width estimated. */
function fitting(name, width) {
  const most = Math.max(4, Math.floor(width / 6.4));
  return name.length <= most ? name : `${name.slice(0, most - 1)}…`;
}
