// SPDX-License-Identifier: Apache-2.0
"use strict";
// Small charts of one quantity over another, drawn as SVG: they may double back (hysteresis) and print sharply.

const COLOURS = { measured: "#1b1f24", declared: "#d55e00", calibrated: "#8a6fa8", explained: "#0066aa", trace: "#8c959f",
  noise: "#57606a" };
const CURVE_COLOURS = [COLOURS.explained, "#d55e00", "#009e73", "#8a6fa8", "#56b4e9", "#806000"];
const MARGIN = { left: 66, right: 14, top: 12, bottom: 48 };
const LARGE = { ...MARGIN, width: 556, height: 330 };
const SMALL = { ...MARGIN, width: 360, height: 240 };

const sample = (values, factor) => values.map((value) => (value === null ? NaN : value * factor));

/** The path of a line, broken where a value is missing; of points, a zero-length stroke each. */
function pathOf(series, place) {
  let pen = false;
  let path = "";
  for (let index = 0; index < series.x.length; index += 1) {
    const [x, y] = place(series.x[index], series.y[index]);
    if (!Number.isFinite(x) || !Number.isFinite(y)) {
      pen = false;
      continue;
    }
    path += `${pen && !series.points ? "L" : "M"}${x.toFixed(1)} ${y.toFixed(1)}${series.points ? "h0" : ""}`;
    pen = true;
  }
  return path;
}

function axes(xRange, yRange, place, titles, size, scale) {
  const { width, height, left, right, top, bottom } = size;
  const lines = [];
  for (const tick of scale.x.ticks(...xRange, size.width / 90)) {
    const [x] = place(tick.value, yRange[0]);
    lines.push(drawing("path", { d: `M${x} ${top}V${height - bottom}`, stroke: tick.value === 0 ? "#8c959f" : "#e4e8ec" }),
      drawing("text", { x, y: height - bottom + 16, "text-anchor": "middle" }, tick.text));
  }
  for (const tick of scale.y.ticks(...yRange, 5)) {
    const [, y] = place(xRange[0], tick.value);
    lines.push(drawing("path", { d: `M${left} ${y}H${width - right}`, stroke: tick.value === 0 ? "#8c959f" : "#e4e8ec" }),
      drawing("text", { x: left - 7, y: y + 4, "text-anchor": "end" }, tick.text));
  }
  lines.push(
    drawing("text", { x: (left + width - right) / 2, y: height - 10, "text-anchor": "middle" }, titles.x),
    drawing("text", { x: 0, y: 0, transform: `translate(14 ${(top + height - bottom) / 2}) rotate(-90)`, "text-anchor": "middle" },
      titles.y));
  return lines;
}

/**
 * A chart. `series` are {name, x, y, colour, points, dashed}; `titles` {x, y}; `band` a half-width around zero to shade; `yRange`
 * fixes the axis; `scale` {x, y} says how the axes run. Two or more named series get a key.
 */
function chart({ series, titles, band, yRange, scale = { x: LINEAR, y: LINEAR }, size = LARGE }) {
  const { width, height, left, right, top, bottom } = size;
  const xs = scale.x.extent(series.flatMap((each) => each.x), 0.02);
  const ys = yRange ?? scale.y.extent(series.flatMap((each) => each.y), 0.06);
  const place = (x, y) => [left + scale.x.share(x, xs) * (width - left - right),
    height - bottom - scale.y.share(y, ys) * (height - top - bottom)];
  const shaded = band ? drawing("rect", { x: left, width: width - left - right, y: place(0, band)[1],
    height: place(0, -band)[1] - place(0, band)[1], fill: "#dfe5ea" }) : null;
  const lines = series.map((each) => drawing("path", { d: pathOf(each, place), fill: "none", stroke: each.colour,
    "stroke-width": each.points ? 2.6 : 2, "stroke-linecap": "round", "stroke-linejoin": "round",
    "stroke-opacity": each.points ? 0.55 : 1, "stroke-dasharray": each.dashed ? "6 4" : null }));
  const picture = drawing("svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": `${titles.y} over ${titles.x}` },
    shaded, axes(xs, ys, place, titles, size, scale), lines,
    drawing("path", { d: `M${left} ${top}V${height - bottom}H${width - right}`, fill: "none", stroke: "#57606a" }));
  const named = series.filter((each) => each.name);
  return [picture, named.length > 1 ? element("div", { class: "controls" }, named.map((each) => legendKey(each.name, each.colour,
    each.points ? "dotted" : each.dashed ? "dashed" : ""))) : null];
}

/** `kind`: "dashed", "dotted" or nothing. */
function legendKey(name, colour, kind = "") {
  return element("span", {}, element("span", { class: `key ${kind}`.trim(), style: `color:${colour}` }), name);
}

/** Curve of an effect ({x_label, x_unit, ...}) with the reconstructed points, if any, under it. */
function curveChart(curve, points) {
  const all = [...(points ? [{ ...points, name: "reconstructed from the records", points: true, colour: COLOURS.trace }] : []),
    ...(curve?.series ?? []).map((each, index) => ({ ...each, colour: CURVE_COLOURS[index % CURVE_COLOURS.length] }))];
  const labels = curve ?? points;
  const largest = (values) => Math.max(...extent(values, 0).map(Math.abs));
  const xUnit = displayUnit(labels.x_unit ?? "", largest(all.flatMap((each) => each.x)));
  const yUnit = displayUnit(labels.y_unit ?? "", largest(all.flatMap((each) => each.y)));
  const series = all.map((each) => ({ ...each, x: sample(each.x, xUnit.factor), y: sample(each.y, yUnit.factor) }));
  return chart({ series, titles: { x: axisTitle(labels.x_label, xUnit.label), y: axisTitle(labels.y_label, yUnit.label) } });
}
