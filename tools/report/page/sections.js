// SPDX-License-Identifier: Apache-2.0
"use strict";
// The sections of the page in the order in which they are read. Each takes the report and returns nodes, or null where the
// report has nothing to say.

const VERDICTS = {
  explained: ["Explained", "The effects named below are missing in the declared model; with them it follows the records."],
  "nothing-missing": ["Nothing missing", "The declared model already fits the records down to the noise: no effect is missing."],
  "partly-explained": ["Partly explained", "A part of the declared model's error is explained; something else is left in it."],
  "unlisted-effect": ["Unlisted effect", "An effect is missing in the declared model, and none of the known effects explains it."],
  undecided: ["Undecided", "The search did not come to an end: more than noise is left, and nothing is known to explain it."],
};
const STAGES = [{ key: "before", title: "declared model", colour: "declared" },
  { key: "calibrated", title: "calibrated model", colour: "calibrated" }, { key: "after", title: "explained model", colour: "explained" }];

// Friction laws that carry a name.
const LAWS = { coulomb: "Coulomb", dahl: "Dahl", lugre: "LuGre" };

const PROFILED = "Interval from the profile likelihood, not symmetric";

/** Digits of a SHA-256 that are shown: two files that agree in 64 bits are one. */
const SHOWN_DIGITS = 16;
const section = (title, ...content) => element("section", {}, element("h2", {}, title), content);
const paragraph = (text, kind) => (isFilled(text) ? element("p", { class: kind ?? null }, text) : null);
const code = (text) => element("code", {}, text);
const percent = (value) => (Number.isFinite(value) ? `${number(value, 3)} %` : "");
const withLaw = (each) => [words(each.name ?? each.candidate ?? ""), isFilled(each.law) && `(${LAWS[each.law] ?? words(each.law)})`].filter(Boolean).join(" ");

/** On a logarithmic scale from the smallest to the largest ratio of all rows: from the noise (1) to an error. */
function ratioStrip(row, [low, high]) {
  const place = (ratio) => 8 + (164 * Math.log(ratio / low)) / Math.log(high / low);
  return drawing("svg", { width: 180, height: 20, viewBox: "0 0 180 20", "aria-hidden": "true" },
    drawing("path", { d: `M${place(1)} 10H${place(row.ratio)}`, stroke: COLOURS[row.colour], "stroke-width": 4 }),
    drawing("circle", { cx: place(row.ratio), cy: 10, r: 5, fill: COLOURS[row.colour] }),
    drawing("path", { d: `M${place(1)} 0V20`, stroke: "#1b1f24", "stroke-width": 2 }));
}

/** A row per channel and stage; what belongs to the channel is in its first row. */
function errorRows(channels) {
  return Object.entries(channels).flatMap(([name, channel]) => {
    const stages = STAGES.filter((stage) => isFilled(channel[stage.key]));
    const display = displayUnit(channel.unit ?? "", typicalSize([channel.noise, ...stages.flatMap((stage) =>
      [channel[stage.key].rms, channel[stage.key].max])]));
    return stages.map((stage, index) => ({ ...stage, ...channel[stage.key], name, display, first: index === 0, noise: channel.noise,
      ratio: channel.noise > 0 && channel.noise_source !== "floor" && channel[stage.key].rms > 0 ? channel[stage.key].rms / channel.noise : NaN }));
  });
}

function noiseNote(channels) {
  const estimated = Object.keys(channels).filter((name) => channels[name].noise_source !== "declared").map(words);
  const declared = Object.values(channels).some((channel) => channel.noise_source === "declared");
  if (!estimated.length) return declared ? "The noise (rms) is the declared one." : "";
  return `The noise (rms) is estimated from the records${declared ? ` for ${estimated.join(", ")}, otherwise declared` : ""}.`;
}

function errorTable(title, channels) {
  const rows = errorRows(channels);
  if (!rows.length) return null;
  const ratios = finite(rows.map((row) => row.ratio));
  const range = [Math.min(0.8, ...ratios), Math.max(1.25, ...ratios)];
  const shown = (key) => (row) => (Number.isFinite(row[key]) ? number(row[key] * row.display.factor) : "");
  const grid = table([
    { title: "channel", cell: (row) => (row.first ? element("strong", {}, words(row.name)) : "") },
    { title: "unit", cell: (row) => (row.first ? row.display.label : "") },
    { title: "noise", number: true, cell: (row) => (row.first ? shown("noise")(row) : "") },
    { title: "model", cell: (row) => legendKey(row.title, COLOURS[row.colour]) },
    { title: "rms error", number: true, cell: shown("rms") },
    { title: "largest error", number: true, cell: shown("max") },
    { title: "mean error", number: true, cell: shown("bias") },
    { title: "fit %", number: true, cell: (row) => (Number.isFinite(row.fit_percent) ? fixed(row.fit_percent, 2) : "") },
    { title: "rms over noise", number: true, cell: (row) => (Number.isFinite(row.ratio) ? number(row.ratio) : "") },
    { title: "", type: "strip", cell: (row) => (Number.isFinite(row.ratio) ? ratioStrip(row, range) : "") },
  ], rows, (row) => (row.first ? "round" : null));
  return section(title, grid, paragraph("Fit: 100 % less the rms error over the measurement's rms " +
    `about its mean. Calibrated: declared parameters moved within their tolerances. ${noiseNote(channels)}`, "note"));
}

/** The zero and the noise that each record's channels have; null where no record has a zero. */
function zeroTable(records) {
  const rows = (records ?? []).flatMap((record) => Object.entries(record.channels ?? {})
    .filter(([, channel]) => Number.isFinite(channel.zero)).map(([name, channel]) => ({ record: record.path, name, ...channel })));
  if (!rows.length) return null;
  return section("Sensor offsets of the records", table([
    { title: "record", cell: (row) => row.record },
    { title: "channel", cell: (row) => words(row.name) },
    { title: "offset", number: true, cell: (row) => number(row.zero) },
    { title: "noise", number: true, cell: (row) => number(row.noise) },
  ], rows), paragraph("Measured minus modelled, in the channel's unit. An offset belongs to the record and not to the plant. An offset of the " +
    "command has the same effect.", "note"));
}

/** On held-out blocks of the records, then on every record that was kept back whole. */
const errorTables = (report) => [
  errorTable("Error on data that no fit has seen", report.channels),
  paragraph("These errors are those of the fit without the held-out blocks. explained.toml comes from a last fit to all blocks.", "note"),
  isFilled(report.baseline?.sentence) ? paragraph(report.baseline.sentence, report.baseline.better_than_explained ? "warning" : "note") : null,
  zeroTable(report.records),
  ...(report.held_out_records ?? []).map((record) =>
    errorTable(`Error on ${record.path}, which no fit and no decision has used`, record.channels))];

/** The interval of a parameter; one from a profile carries a mark, for which `parameterTable` has a footnote. */
function intervalOf(row) {
  if (row.identified === false) return element("span", { class: "tag alert" }, "not determined by the data");
  return row.profiled ? element("span", { title: PROFILED }, row.text.interval, element("span", { class: "mark" }, "†"))
    : row.text.interval;
}

function parameterTable(parameters) {
  const rows = Object.entries(parameters).map(([name, parameter]) => {
    const text = quantity(parameter.value, parameter.identified === false ? null : parameter.ci95, parameter.unit);
    return { name, ...parameter, text, profiled: parameter.interval_from === "profile" && text.interval !== "" };
  });
  return [table([
    { title: "parameter", cell: (row) => [code(row.name), isFilled(row.meaning) ? element("div", { class: "note" }, row.meaning) : ""],
      text: true },
    { title: "value", number: true, cell: (row) => row.text.value },
    { title: "unit", cell: (row) => row.text.unit },
    { title: "95 % interval", number: true, cell: intervalOf },
  ], rows, (row) => (row.identified === false ? "undetermined" : null)),
  rows.some((row) => row.profiled) ? paragraph(`† ${PROFILED}.`, "note") : null];
}

function evidenceText(evidence) {
  const { held_out_error_drop_percent: drop, delta_bic: bic, ...others } = evidence ?? {};
  return [Number.isFinite(drop) && `Error on held-out data falls by ${percent(drop)}`,
    Number.isFinite(bic) && `BIC changes by ${number(bic, 3)} (negative: supported)`,
    ...Object.entries(others).filter(([, value]) => Number.isFinite(value)).map(([key, value]) => `${words(key)} ${number(value, 3)}`),
  ].filter(Boolean).map((text) => `${text}.`).join(" ");
}

function alternativesTable(effect) {
  if (!isFilled(effect.alternatives)) return null;
  return [element("h3", {}, "What else could it be"), table([
    { title: "instead of it", cell: withLaw },
    { title: "BIC against it", number: true, cell: (each) => (Number.isFinite(each.delta_bic)
      ? (each.delta_bic > 0 ? "+" : "") + number(each.delta_bic, 3) : "") },
    { title: "held-out error falls by", number: true, cell: (each) => percent(each.held_out_error_drop_percent) },
  ], effect.alternatives)];
}

/** The reconstructed points belong to the curve of the same quantities at the same site. */
const belongs = (trace, effect) => isFilled(trace?.points) && isFilled(effect.curve) && trace.site === effect.site &&
  ["x_label", "x_unit", "y_label", "y_unit"].every((key) => trace.points[key] === effect.curve[key]);

function effects(report) {
  if (!isFilled(report.effects)) return null;
  const traced = report.effects.find((effect) => belongs(report.trace, effect));
  return section(report.effects.length > 1 ? "The effects found" : "The effect found", report.effects.map((effect) => element("div",
    { class: "together" },
    element("h3", {}, sentenceCase(withLaw(effect)), element("span", { class: "note" }, "  at ", code(effect.site ?? ""),
      isFilled(effect.axis) ? ` of the ${effect.axis} axis` : "")),
    paragraph(effect.meaning), isFilled(effect.looks_like) ? paragraph(`${sentenceCase(effect.looks_like)}.`) : null,
    paragraph(effect.is_not), paragraph(evidenceText(effect.evidence)),
    element("div", { class: "figures" },
      isFilled(effect.curve) ? element("figure", {}, curveChart(effect.curve, effect === traced ? report.trace.points : null)) : null,
      element("div", { class: "beside" }, isFilled(effect.parameters) ? parameterTable(effect.parameters) : null,
        alternativesTable(effect))))));
}

function trace(report) {
  if (!isFilled(report.trace)) return null;
  const drawn = (report.effects ?? []).find((effect) => belongs(report.trace, effect));
  const points = report.trace.points;
  return section("Where the declared model falls short", element("div", { class: "together" },
    paragraph(report.trace.text), isFilled(report.trace.site) ? element("p", { class: "note" }, "It enters at ",
      code(report.trace.site), drawn ? `; its points are drawn under the curve of ${words(drawn.name)}.` : ".") : null,
    isFilled(points) && !drawn ? element("figure", {}, curveChart(null, points)) : null));
}

/** What no fit can decide from these records, whatever it found. */
function identifiability(report) {
  const sentences = (report.identifiability ?? []).filter((each) => isFilled(each?.text));
  return sentences.length ? section("What the data cannot separate",
    element("ul", { class: "sentences" }, sentences.map((each) => element("li", {}, each.text)))) : null;
}

/** How many tolerances a value has moved: a bar from the middle, one tolerance shaded, clipped at four. */
function movedBar(moved) {
  const place = (tolerances) => 80 + 18 * Math.max(-4.2, Math.min(4.2, tolerances));
  const [left, right] = [place(Math.min(0, moved)), place(Math.max(0, moved))];
  return drawing("svg", { width: 160, height: 20, viewBox: "0 0 160 20", "aria-hidden": "true" },
    drawing("rect", { x: place(-1), width: 36, y: 2, height: 16, fill: "#e4e8ec" }),
    drawing("rect", { x: left, width: Math.max(1.5, right - left), y: 6, height: 8,
      fill: Math.abs(moved) > 2 ? COLOURS.declared : COLOURS.explained }),
    drawing("path", { d: "M80 1V19", stroke: "#1b1f24" }));
}

function calibration(report) {
  if (!isFilled(report.calibration)) return null;
  const rows = Object.entries(report.calibration).map(([key, each]) => {
    const text = quantity(each.value, each.ci95, each.unit);
    const moved = (each.value - each.declared) / Math.abs(each.tolerance * each.declared);
    return { key, ...each, text, moved, before: number(each.declared * text.factor, 4) };
  });
  return section("Declared parameters, calibrated", table([
    { title: "parameter", cell: (row) => [code(row.key), row.pressed ? element("div", {},
      element("span", { class: "tag alert" }, "more than 2.5 tolerances from the declared value, or at a bound")) : ""] },
    { title: "declared", number: true, cell: (row) => row.before },
    { title: "calibrated", number: true, cell: (row) => row.text.value },
    { title: "unit", cell: (row) => row.text.unit },
    { title: "95 % interval", number: true, cell: (row) => row.text.interval },
    { title: "tolerance", number: true, cell: (row) => (row.tolerance > 0 ? `${number(100 * row.tolerance, 2)} %` : "") },
    { title: "moved, in tolerances", number: true, cell: (row) => (Number.isFinite(row.moved) ? fixed(row.moved, 1) : "") },
    { title: "", type: "strip", cell: (row) => (Number.isFinite(row.moved) ? movedBar(row.moved) : "") },
  ], rows), paragraph("Shaded: one tolerance (one sigma) to either side.", "note"));
}

function data(report) {
  if (!isFilled(report.records) && !isFilled(report.held_out)) return null;
  const blocksOf = (record) => (report.held_out ?? []).filter((block) => String(block).startsWith(`${record.name}@`));
  const records = (report.records ?? []).map((record) => ({ ...record, name: String(record.path ?? record.name ?? "").split("/").pop() }));
  const unplaced = (report.held_out ?? []).filter((block) => !records.some((record) => blocksOf(record).includes(block)));
  return section("Records and held-out blocks", table([
    { title: "record", cell: (row) => code(row.path ?? row.name), text: true },
    { title: "rows", number: true, cell: (row) => (Number.isFinite(row.rows) ? fixed(row.rows, 0) : "") },
    { title: "rate [Hz]", number: true, cell: (row) => (row.period > 0 ? number(1 / row.period, 4) : "") },
    { title: "length [s]", number: true, cell: (row) => (row.period > 0 ? number(row.rows * row.period, 4) : "") },
    { title: "held out [s]", text: true, cell: (row) => blocksOf(row).map((block) => String(block).slice(row.name.length + 1)
      .replace(/(\d)-(?=[\d.])/, "$1 … ")).join(", ") },
    { title: "SHA-256", cell: (row) => (row.sha256 ? code(row.sha256.slice(0, SHOWN_DIGITS)) : "") },
  ], records), report.model_sha256 ? paragraph(`The first ${SHOWN_DIGITS} digits; those of the declared model: ` +
    `${report.model_sha256.slice(0, SHOWN_DIGITS)}. report.json has all.`, "note") : null,
  unplaced.length ? paragraph(`Held out: ${unplaced.join(", ")}.`) : null);
}
