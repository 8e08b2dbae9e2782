// SPDX-License-Identifier: Apache-2.0
"use strict";
// Strip charts: one dygraph a channel. A row has the extremes of its cycles as a band, and their last value as a line.

const shortNumber = (value) => (Number.isFinite(value) ? String(Number(value.toPrecision(5))).replace("-", "−") : "—");

class Strip {
  constructor(channel) {
    this.channel = channel;
    this.rows = [];
    this.readout = element("output", {});
    this.plot = element("div", { class: "strip" });
    this.node = element("div", {}, element("p", { class: "strip-title" },
      element("span", {}, `${channel.group} · ${channel.name}${channel.unit ? ` [${channel.unit}]` : ""}`), this.readout), this.plot);
  }

  /** dygraphs draws null as a gap. */
  append(time, least, greatest, last) {
    this.rows.push([time, [least, last, greatest]]);
  }

  draw(window) {
    if (this.rows.length < 2) return false;
    const until = this.rows[this.rows.length - 1][0];
    const gone = this.rows.findIndex(([time]) => time >= until - window);
    if (gone > 0) this.rows.splice(0, gone);
    this.readout.textContent = `${shortNumber(this.rows[this.rows.length - 1][1][1])} ${this.channel.unit}`;
    // A program that is younger than the window fills it from the left.
    const from = Math.max(until - window, 0);
    const view = { file: this.rows, dateWindow: [from, from + window] };
    if (this.graph) {
      this.graph.updateOptions(view);
      return true;
    }
    this.graph = new Dygraph(this.plot, this.rows, { labels: ["time", this.channel.name], customBars: true, colors: ["#0066aa"],
      dateWindow: view.dateWindow, fillAlpha: 0.25, strokeWidth: 1.3, legend: "never", interactionModel: {}, axisLabelFontSize: 12,
      gridLineColor: "#e6e9ec", axes: { x: { axisLabelFormatter: (time) => `${Number(time.toFixed(2))} s` },
        y: { axisLabelWidth: 76, pixelsPerLabel: 26, axisLabelFormatter: (value, granularity, options, graph) => {
          const [low, high] = graph.yAxisRange(0);
          const digits = Math.max(2, Math.ceil(Math.log10(Math.max(Math.abs(low), Math.abs(high)) / (high - low) || 1)) + 2);
          return String(Number(value.toPrecision(Math.min(digits, 15)))).replace("-", "−");
        } } } });
    return true;
  }

  destroy() {
    if (this.graph) this.graph.destroy();
  }
}

/** The charts of the chosen channels, and the choice itself, which the address of the page keeps. */
class Strips {
  constructor(controls, host) {
    this.controls = controls;
    this.host = host;
    this.strips = [];
    this.channels = [];
    const kept = new URLSearchParams(location.hash.replace(/^#/, ""));
    this.wanted = kept.has("channels") ? kept.get("channels").split(";") : null;
    this.window = Number(kept.get("seconds")) || 30;
    /** Counts up when rows that the page does not have are wanted. */
    this.choice = 0;
  }

  /** Another program: the charts begin again, with the channels of the same names. */
  begin(channels) {
    const same = JSON.stringify(channels) === JSON.stringify(this.channels);
    this.channels = channels;
    if (!same) this.drawControls();
    this.restart();
  }

  static keyOf(channel) {
    return `${channel.group}/${channel.name}`;
  }

  /** Indices of the wanted channels; those of the first actuator if nobody has chosen. */
  chosen() {
    const chosen = this.channels.flatMap((channel, index) =>
      (this.wanted ? this.wanted.includes(Strips.keyOf(channel)) : channel.group === "actuator 1") ? [index] : []);
    return this.wanted ? chosen : chosen.slice(0, 4);
  }

  restart() {
    for (const strip of this.strips) strip.destroy();
    this.shown = this.chosen();
    this.strips = this.shown.map((index) => new Strip(this.channels[index]));
    this.host.replaceChildren(...this.strips.map((strip) => strip.node));
  }

  choose(change) {
    change();
    location.replace(`#${new URLSearchParams({ channels: this.wanted.join(";"), seconds: this.window })}`);
    this.choice += 1;
    this.restart();
  }

  drawControls() {
    this.wanted ??= null;
    const groups = [...new Set(this.channels.map((channel) => channel.group))];
    const chosen = new Set(this.chosen());
    const box = (channel, index) => element("label", {}, element("input", { type: "checkbox", checked: chosen.has(index),
      "data-channel": Strips.keyOf(channel), change: () => this.choose(() => this.takeBoxes()) }), ` ${channel.name}`);
    const option = (seconds) => element("option", { value: seconds, selected: seconds === this.window }, `${seconds} s`);
    this.controls.replaceChildren(
      element("details", {}, element("summary", {}, "Channels"), element("div", { class: "choice" }, groups.map((group) =>
        element("fieldset", {}, element("legend", {}, group), this.channels.map((channel, index) =>
          (channel.group === group ? box(channel, index) : null)))))),
      element("label", {}, "Last ", element("select", { change: (event) => this.choose(() => {
        this.takeBoxes();
        this.window = Number(event.target.value);
      }) }, [10, 30, 60, 300].map(option))));
  }

  takeBoxes() {
    this.wanted = [...this.controls.querySelectorAll("input:checked")].map((input) => input.dataset.channel);
  }

  /** Rows of an answer, whose columns are those of the shown channels. True if something is drawn. */
  append(rows) {
    for (const row of rows) {
      this.strips.forEach((strip, index) => strip.append(row[0], ...row.slice(1 + 3 * index, 4 + 3 * index)));
    }
    return this.strips.map((strip) => strip.draw(this.window)).some(Boolean);
  }
}
