// SPDX-License-Identifier: Apache-2.0
"use strict";
// Measured against model over time, the residual under it, and the command: three dygraphs that zoom as one.

const MODELS = [
  { key: "declared", title: "declared model", colour: COLOURS.declared, width: 1.4 },
  { key: "calibrated", title: "calibrated model", colour: COLOURS.calibrated, width: 1.4, dashes: [6, 3] },
  { key: "after", title: "explained model", colour: COLOURS.explained, width: 1.4 },
];

// Wider than the models' lines, so that a model which lies on it leaves a dark edge.
const MEASURED = { key: "measured", title: "measured", colour: COLOURS.measured, width: 2.8 };

function bytesOf(base64) {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let index = 0; index < text.length; index += 1) bytes[index] = text.charCodeAt(index);
  return new DataView(bytes.buffer);
}

function floats(base64, factor) {
  const view = bytesOf(base64);
  return Float64Array.from({ length: view.byteLength / 4 }, (unused, index) => view.getFloat32(4 * index, true) * factor);
}

/** Times of the rows that the page holds. */
function timesOf(record) {
  const at = (row) => record.start + row * record.period;
  if (!record.kept) return Float64Array.from({ length: record.rows }, (unused, index) => at(index));
  const view = bytesOf(record.kept);
  return Float64Array.from({ length: view.byteLength / 4 }, (unused, index) => at(view.getUint32(4 * index, true)));
}

/** dygraphs draws null as a gap. */
const rowsOf = (times, columns) => Array.from(times, (time, row) =>
  [time, ...columns.map((column) => (Number.isNaN(column[row]) ? null : column[row]))]);

const tickText = (value, digits) => String(Number(value.toPrecision(digits))).replace("-", "−");

class Traces {
  /**
   * `host` gets the charts; `view` {record, channel, from, to} says what to open with. On paper, `sheet` {height, pixelRatio}
   * says how tall a strip is against the screen and how finely it is drawn.
   */
  constructor(host, records, view, sheet = { height: 1 }) {
    this.host = host;
    this.sheet = sheet;
    this.records = records;
    this.graphs = [];
    this.hidden = new Set();
    this.record = Math.max(0, records.findIndex((record) => record.name === view.record));
    this.channel = view.channel ?? records[this.record].channels[0].name;
    host.append(this.controls = element("div", { class: "controls" }), this.strips = element("div"));
    this.draw();
    if (Number.isFinite(view.from) && view.to > view.from) this.zoom([view.from, view.to]);
  }

  zoom(window) {
    this.graphs[0].updateOptions({ dateWindow: window });
  }

  wholeRecord() {
    for (const graph of this.graphs) graph.resetZoom();
  }

  /** A fiftieth of the record, half a second at least, around the declared model's largest error. */
  largestError() {
    const record = this.records[this.record];
    let [largest, worst] = [0, 0];
    this.errors[0].forEach((value, row) => {
      if (Math.abs(value) > largest) [largest, worst] = [Math.abs(value), row];
    });
    const half = Math.max(0.25, record.rows * record.period * 0.01);
    this.zoom([this.times[worst] - half, this.times[worst] + half]);
  }

  destroy() {
    for (const graph of this.graphs) graph.destroy();
  }

  draw() {
    this.destroy();
    const record = this.records[this.record];
    const channel = record.channels.find((each) => each.name === this.channel) ?? record.channels[0];
    this.channel = channel.name;
    this.models = MODELS.filter((model) => channel.errors[model.key]);
    this.times = timesOf(record);
    this.drawControls(record);
    this.strips.replaceChildren();
    this.graphs = [this.drawSignal(record, channel), this.models.length ? this.drawErrors(record, channel) : null,
      record.input ? this.drawInput(record) : null].filter(Boolean);
    if (this.graphs.length > 1) Dygraph.synchronize(this.graphs, { zoom: true, selection: true, range: false });
  }

  drawControls(record) {
    const option = (chosen) => (name) => element("option", { selected: name === chosen, value: name }, name);
    const choice = (title, names, chosen, act) => element("label", { class: "screen-only" }, `${title} `, names.length < 2
      ? element("strong", {}, names[0]) : element("select", { change: (event) => act(event.target) }, names.map(option(chosen))));
    const toggles = [MEASURED, ...this.models].map((line) =>
      element("label", {}, element("input", { type: "checkbox", checked: !this.hidden.has(line.key),
        change: (event) => this.toggle(line.key, event.target.checked) }),
      legendKey(line.title, line.colour, line.dashes ? "dashed" : "")));
    this.controls.replaceChildren(
      choice("Record", this.records.map((each) => each.name), record.name, (select) => {
        this.record = select.selectedIndex;
        this.draw();
      }),
      choice("Channel", record.channels.map((each) => each.name), this.channel, (select) => {
        this.channel = select.value;
        this.draw();
      }),
      element("button", { type: "button", click: () => this.wholeRecord() }, "Whole record"),
      this.models.length ? element("button", { type: "button", click: () => this.largestError() }, "Largest error") : "",
      ...toggles,
      record.held_out.length ? element("span", {}, element("span", { class: "key block" }), "held out") : "");
  }

  toggle(key, shown) {
    if (shown) this.hidden.delete(key);
    else this.hidden.add(key);
    const [signal, errors] = this.graphs;
    signal.updateOptions({ visibility: this.shown([MEASURED, ...this.models]) });
    if (this.models.length) errors.updateOptions({ visibility: this.shown(this.models) });
  }

  shown(lines) {
    return lines.map((line) => !this.hidden.has(line.key));
  }

  /** One strip: title, read-out under the cursor, canvas. */
  strip(title, unit, height, columns, lines, record) {
    const readout = element("span", { class: "readout" });
    const canvas = element("div", { class: "traces", style: `height:${Math.round(height * this.sheet.height)}px` });
    this.strips.append(element("div", { class: "together" },
      element("p", { class: "strip-title" }, axisTitle(title, unit), readout), canvas));
    return new Dygraph(canvas, rowsOf(this.times, columns), {
      labels: ["time", ...lines.map((line) => line.title)],
      colors: lines.map((line) => line.colour),
      visibility: this.shown(lines),
      series: Object.fromEntries(lines.map((line) => [line.title,
        { strokeWidth: line.width, strokePattern: line.dashes ?? null, stepPlot: Boolean(line.steps) }])),
      labelsDiv: readout,
      pixelRatio: this.sheet.pixelRatio ?? null,
      legend: "onmouseover",
      legendFormatter: (legend) => (legend.x === undefined ? "" : [`${number(legend.x, 6)} s`, ...legend.series
        .filter((line) => line.isVisible && Number.isFinite(line.y)).map((line) => `${line.label} ${number(line.y, 4)}`)].join(" · ")),
      axes: { y: { axisLabelWidth: 62, pixelsPerLabel: height < 150 ? 13 : 28, axisLabelFormatter: (value) => tickText(value, 6) },
        x: { axisLabelFormatter: (value) => `${tickText(value, 9)} s` } },
      gridLineColor: "#e4e8ec",
      axisLineColor: "#8c959f",
      highlightCircleSize: 3,
      underlayCallback: (context, area, graph) => {
        context.fillStyle = "#f5efd6";
        for (const [from, to] of record.held_out) {
          const left = Math.max(area.x, graph.toDomXCoord(from));
          const right = Math.min(area.x + area.w, graph.toDomXCoord(to));
          if (right > left) context.fillRect(left, area.y, right - left, area.h);
        }
      },
    });
  }

  drawSignal(record, channel) {
    const measured = floats(channel.measured, 1);
    const display = displayUnit(channel.unit, Math.max(...extent(measured, 0).map(Math.abs)));
    const shown = measured.map((value) => value * display.factor);
    const models = this.models.map((model) => floats(channel.errors[model.key], -display.factor)
      .map((error, row) => shown[row] + error));
    return this.strip(`${words(channel.name)} in ${record.name}, measured and model`, display.label, 300, [shown, ...models], [MEASURED, ...this.models],
      record);
  }

  drawErrors(record, channel) {
    const plain = this.models.map((model) => floats(channel.errors[model.key], 1));
    const display = displayUnit(channel.unit, Math.max(...extent(plain[0], 0).map(Math.abs)));
    this.errors = plain.map((values) => values.map((value) => value * display.factor));
    return this.strip("residual: measured minus model", display.label, 190, this.errors, this.models, record);
  }

  drawInput(record) {
    const values = floats(record.input.values, 1);
    const display = displayUnit(record.input.unit, Math.max(...extent(values, 0).map(Math.abs)));
    // dygraphs writes the names of lines as markup: they are words of this file and never of the record.
    const line = { title: "input", colour: "#57606a", width: 1.2, steps: true };
    return this.strip(words(record.input.name), display.label, 110, [values.map((value) => value * display.factor)], [line], record);
  }
}
