// SPDX-License-Identifier: Apache-2.0
"use strict";
// What is left of the error, and where it is: correlations, bands of frequency, amplitudes. Each section takes the report and
// returns a node, or null where the report has nothing to say.

const LINES = [{ key: "before", name: "declared model", colour: COLOURS.declared },
  { key: "after", name: "explained", colour: COLOURS.explained }];
const NOISE_LINE = { key: "noise", name: "noise", colour: COLOURS.noise, dashed: true };

/** Channels of which the report has this view of the residual: [name, view] where the list at `key` and one of a model are filled. */
const channelsWith = (report, view, key) => Object.entries(report.residual?.[view] ?? {})
  .filter(([, each]) => isFilled(each?.[key]) && LINES.some((line) => isFilled(each[line.key])));

const smallCharts = (title, note, figures) => {
  if (!figures.length) return null;
  const node = section(title, paragraph(note, "note"), element("div", { class: "figures small" }, figures));
  node.classList.add("together");
  return node;
};

/** `rangeOf(values, band)` is the range of the vertical axis; `title` its title; `remark(view)` comes after the channel's name. */
function correlationFigures(report, view, { title, rangeOf, remark = () => null }) {
  return channelsWith(report, view, "lag_s").map(([name, each]) => {
    const lag = displayUnit("s", Math.max(...extent(each.lag_s, 0).map(Math.abs)));
    const series = LINES.filter((line) => isFilled(each[line.key])).map((line) => ({ ...line, x: sample(each.lag_s, lag.factor),
      y: sample(each[line.key], 1) }));
    return element("figure", {}, element("h3", {}, sentenceCase(words(name)), " ", remark(each)), chart({ series,
      band: each.bound99, size: SMALL, yRange: rangeOf(series.flatMap((line) => line.y), each.bound99 ?? 0),
      titles: { x: axisTitle("lag", lag.label), y: title } }));
  });
}

function autocorrelation(report) {
  return smallCharts("What is left: autocorrelation of the residual",
    "A residual that holds nothing but noise stays inside the grey band at 99 % of the lags.",
    correlationFigures(report, "autocorrelation", { title: "autocorrelation",
      rangeOf: (values) => [Math.min(-0.25, extent(values, 0)[0] * 1.1), 1.05] }));
}

function independence({ independent }) {
  if (typeof independent !== "boolean") return null;
  return independent ? element("span", { class: "tag" }, "independent of the input")
    : element("span", { class: "tag alert" }, "depends on the input");
}

function inputCorrelation(report) {
  return smallCharts("What is left: correlation with the input", "Cross-correlation of the residual with the past input " +
    "(command or force). A residual that is independent of the input is inside the grey band at 99 % of the lags. Outside the band, " +
    "the model misses a response to the input.",
  correlationFigures(report, "input_correlation", { title: "correlation with the input", remark: independence,
    rangeOf: (values, band) => extent([...values, band, -band], 0.06) }));
}

/** A step for each band; on the logarithmic axis a band that begins at zero is drawn down to half of its end. */
function steps(bands, values) {
  const edges = bands.from_hz.flatMap((from, band) => [from > 0 ? from : bands.to_hz[band] / 2, bands.to_hz[band]]);
  return { x: edges, y: values.flatMap((value) => [value, value]) };
}

function byFrequency(report) {
  const channels = channelsWith(report, "by_frequency", "from_hz");
  const figures = channels.map(([name, each]) => {
    const lines = [...LINES, NOISE_LINE].filter((line) => isFilled(each[line.key]));
    const error = displayUnit(report.channels[name]?.unit ?? "", typicalSize(lines.flatMap((line) => each[line.key])));
    const frequency = displayUnit("Hz", typicalSize([...each.from_hz, ...each.to_hz]));
    const series = lines.map((line) => {
      const { x, y } = steps(each, each[line.key]);
      return { ...line, x: sample(x, frequency.factor), y: sample(y, error.factor) };
    });
    return element("figure", {}, element("h3", {}, sentenceCase(words(name))), chart({ series, size: SMALL,
      scale: { x: LOGARITHMIC, y: LOGARITHMIC },
      titles: { x: axisTitle("frequency", frequency.label), y: axisTitle("rms error in the band", error.label) } }));
  });
  const fromZero = channels.some(([, each]) => each.from_hz.includes(0));
  return smallCharts("Where the error is: by frequency", "Rms of the residual in bands of frequency. Where the explained model lies on " +
    `the dashed line, nothing but white noise of the sensor is left.${fromZero ? " The lowest band begins at 0 Hz." : ""}`, figures);
}

/** A row per channel and range of amplitudes; what belongs to the channel is in its first row. */
function amplitudeRows(report) {
  return channelsWith(report, "by_amplitude", "from").flatMap(([name, each]) => {
    const unit = report.channels[name]?.unit ?? "";
    const amplitude = displayUnit(unit, typicalSize([...each.from, ...each.to]));
    const error = displayUnit(unit, typicalSize([...(each.before ?? []), ...(each.after ?? [])]));
    return each.from.map((from, index) => ({ name, amplitude, error, first: index === 0, from, to: each.to[index],
      before: each.before?.[index], after: each.after?.[index], seconds: each.seconds?.[index] }));
  });
}

function byAmplitude(report) {
  const rows = amplitudeRows(report);
  if (!rows.length) return null;
  const once = (cell) => (row) => (row.first ? cell(row) : "");
  const shown = (value, { factor }) => (Number.isFinite(value) ? number(value * factor) : "");
  const ofError = ({ key, name, colour }) => ({ title: legendKey(name, colour), number: true, cell: (row) => shown(row[key], row.error) });
  return section("Where the error is: by amplitude", table([
    { title: "channel", cell: once((row) => element("strong", {}, words(row.name))) },
    { title: "amplitude", number: true, cell: (row) => `${shown(row.from, row.amplitude)} … ${shown(row.to, row.amplitude)}` },
    { title: "unit", cell: once((row) => row.amplitude.label) },
    ...LINES.map(ofError),
    { title: "unit", cell: once((row) => row.error.label) },
    { title: "error left [%]", number: true, cell: (row) => (row.before > 0 && Number.isFinite(row.after)
      ? number((100 * row.after) / row.before) : "") },
    { title: "data [s]", number: true, cell: (row) => (Number.isFinite(row.seconds) ? number(row.seconds) : "") },
  ], rows, (row) => (row.first ? "round" : null)), paragraph("Rms of the residual on held-out stretches, by the amplitude (half of " +
    "peak to peak) of what was measured in the stretch.", "note"));
}

const residual = (report) => [autocorrelation(report), inputCorrelation(report), byFrequency(report), byAmplitude(report)];
