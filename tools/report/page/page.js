// SPDX-License-Identifier: Apache-2.0
"use strict";
// Fills the page from the JSON that it carries.

/** What of the page to open: report.html#record=steps.csv&channel=engine&from=2&to=4 */
function viewOf(hash) {
  const wanted = new URLSearchParams(hash.replace(/^#/, ""));
  return { record: wanted.get("record"), channel: wanted.get("channel"), from: parseFloat(wanted.get("from")),
    to: parseFloat(wanted.get("to")) };
}

function fillHeader(report, series) {
  const [title, meaning] = VERDICTS[report.verdict] ?? [sentenceCase(words(report.verdict)), ""];
  const badge = document.getElementById("verdict");
  badge.textContent = title;
  if (VERDICTS[report.verdict]) badge.classList.add(report.verdict);
  const headline = document.querySelector("h1");
  if (!headline.textContent) headline.textContent = meaning;
  document.getElementById("subject").textContent = [report.name, report.model].filter(isFilled).join(" · ");
  const length = (report.records ?? []).reduce((sum, record) => sum + record.rows * record.period, 0);
  const heldOut = series.records.flatMap((record) => record.held_out).reduce((sum, [from, to]) => sum + to - from, 0);
  const facts = [
    ["error left unexplained", percent(report.residual?.unexplained_percent)],
    ["residual", report.residual?.white === true ? "white: only noise is left" : report.residual?.white === false ? "not white" : ""],
    ["held out", heldOut > 0 ? `${number(heldOut, 3)} s` : ""],
    ["records", isFilled(report.records) ? `${report.records.length}, together ${number(length, 3)} s` : ""],
    ["made", [report.date, report.hotfire && `Hotfire ${report.hotfire}`].filter(Boolean).join(", ")],
  ];
  document.getElementById("facts").append(...facts.filter(([, value]) => value).map(([name, value]) =>
    element("div", {}, element("dt", {}, name), element("dd", {}, value))));
}

function timeSection(report, series) {
  if (!series.records.length) return null;
  const host = element("div", { class: "on-screen" });
  const paper = element("div", { class: "print-only" });
  const thinned = series.kept < series.rows ? `Of ${fixed(series.rows, 0)} rows a channel the page holds ${fixed(series.kept, 0)}: ` +
    "those at which input, measurement or residual is smallest or largest in a short stretch of time, so no peak is lost. " : "";
  return { host, paper, node: section("Measured against model", host, paper, element("p", { class: "note" }, thinned,
    element("span", { class: "screen-only" }, "Drag to zoom, shift-drag to move, double-click for the whole record."))) };
}

function fillPage({ report, series }) {
  fillHeader(report, series);
  const time = timeSection(report, series);
  const next = report.residual?.next_experiment;
  const sections = [
    (report.warnings ?? []).map((warning) => paragraph(warning, "warning")),
    ...errorTables(report), isFilled(next) ? element("p", { class: "next" }, element("strong", {}, "Next experiment: "), next) : null,
    time?.node, trace(report), effects(report), identifiability(report), residual(report), calibration(report), evidence(report),
    data(report), signatures()];
  document.getElementById("main").append(...sections.flat().filter(Boolean));
  if (time) {
    window.traces = new Traces(time.host, series.records, viewOf(window.location.hash));
    printAllRecords(time.paper, series.records);
  }
  runningFoot(report);
  document.getElementById("footer").append(...[
    [`Hotfire ${report.hotfire ?? ""}`.trim(), Number.isFinite(report.seconds) && `${number(report.seconds, 3)} s`].filter(Boolean).join(", "),
    report.command_line].filter(isFilled).map((text) => element("p", {}, text)));
}

fillPage(JSON.parse(document.getElementById("data").textContent));
document.documentElement.dataset.state = "ready";
