// SPDX-License-Identifier: Apache-2.0
"use strict";
// Beside the charts: the state in large, faults with their sections of docs/faults.md, timing, recording, counters.

const INTERLOCK = { safe: "", armed: "alert", running: "good", stopping: "alert", faulted: "bad" };

/** The state of an answer: [what is written in large, class, why]. A state of an interlock that is not of now is not shown. */
function stateOf(answer, program) {
  const fault = answer.interlock?.fault;
  const known = program?.faults.find((each) => each.number === fault);
  const faultText = fault ? `fault ${fault}, ${known?.name ?? "unknown"}: ${known?.meaning ?? ""}` : "";
  switch (answer.state) {
    case "absent": return ["WAITING", "", `no program shows itself at ${answer.file} yet`];
    case "refused": return ["REFUSED", "bad", answer.why];
    case "silent": return ["NO CYCLES", "bad", "the program is there and shows no cycle"];
    case "died": return ["PROGRAM GONE", "bad", "it has ended without a message: killed, or failed"];
    case "ended": return ["ENDED", "", [answer.why, faultText].filter(Boolean).join(" · ")];
    default:
      return answer.interlock ? [answer.interlock.state.toUpperCase(), INTERLOCK[answer.interlock.state] ?? "", faultText]
        : ["RUNNING", "good", ""];
  }
}

/** Sections of docs/faults.md by number. */
function faultSections(markdown) {
  const sections = new Map();
  for (const part of markdown.split(/^## /m).slice(1)) {
    const [title, ...paragraphs] = part.split(/\n\n+/);
    sections.set(Number.parseInt(title, 10), { title: title.trim(), paragraphs });
  }
  return sections;
}

/** `code` and **strong** of a paragraph. */
const inline = (text) => text.split(/(`[^`]+`|\*\*[^*]+\*\*)/).map((part) => {
  if (part.startsWith("`")) return element("code", {}, part.slice(1, -1));
  return part.startsWith("**") ? element("strong", {}, part.slice(2, -2)) : part.replace(/\[([^\]]*)\]\([^)]*\)/g, "$1");
});

/** A power of ten of microseconds. */
const durationText = (us) => (us < 1000 ? `${Number(us.toPrecision(1))} µs` : `${Number((us / 1000).toPrecision(1))} ms`);

class Panels {
  constructor(host) {
    this.sections = faultSections(document.getElementById("faults").textContent);
    this.host = host;
  }

  begin(program) {
    this.program = program;
    this.fault = element("div", { id: "fault" });
    this.timing = element("div", { id: "timing" });
    this.recording = element("div", { id: "recording" });
    this.counters = element("div", { id: "counters" });
    this.host.replaceChildren(this.fault, this.timing, this.recording, this.counters);
    this.shownFault = undefined;
  }

  draw(answer) {
    if (!this.program || !answer.counters) return;
    const counters = this.program.counters.map((counter, index) => ({ ...counter, value: answer.counters[index] }));
    this.drawFaults(answer.interlock?.fault ?? null, counters.filter((counter) => counter.group === "faults"));
    this.drawTiming(answer);
    this.drawRecording(counters.filter((counter) => counter.group === "recording"));
    this.drawCounters(counters.filter((counter) => counter.group !== "faults" && counter.group !== "recording"));
  }

  drawFaults(first, counts) {
    const key = JSON.stringify([first, counts.map((count) => count.value)]);
    if (counts.length === 0 || key === this.shownFault) return;
    this.shownFault = key;
    const nameOf = (number) => this.program.faults.find((fault) => fault.number === number)?.name ?? "";
    const seen = counts.filter((count) => count.value > 0);
    const section = this.sections.get(first);
    this.fault.replaceChildren(element("h2", {}, "Faults"),
      section ? element("div", { class: "fault", "data-fault": first }, element("h3", {}, section.title),
        section.paragraphs.map((text) => element("p", {}, inline(text)))) : "",
      seen.length === 0 ? element("p", { class: "note" }, "None since the program started.")
        : element("table", {}, seen.map((count) => element("tr", {},
          element("td", {}, `${count.name} ${nameOf(Number(count.name))}`), element("td", {}, `first: ${count.value}`)))));
  }

  drawTiming(answer) {
    this.timing.replaceChildren(element("h2", {}, "Timing"), ...this.histogram("wake-up latency", answer.wake_up),
      ...this.histogram("step time", answer.step),
      element("p", { class: "note" }, "Of the cycles since this page's server has followed the program",
        answer.missed > 0 ? `; it came too late for ${answer.missed} of them.` : ", all of them."));
  }

  histogram(title, times) {
    const { least_us: least, bins_of_decade: perDecade } = this.program.histogram;
    const used = times.counts.flatMap((count, bin) => (count > 0 ? [bin] : []));
    const from = Math.floor(Math.min(...used, perDecade) / perDecade) * perDecade;
    const to = Math.min(Math.ceil((Math.max(...used, perDecade) + 1) / perDecade) * perDecade, times.counts.length);
    // A single late cycle among millions has to be seen: heights are logarithmic.
    const most = Math.log10(Math.max(...times.counts, 1) + 1);
    const [width, height] = [360, 70];
    const step = width / (to - from);
    const bars = used.map((bin) => {
      const tall = (height * Math.log10(times.counts[bin] + 1)) / most;
      return drawing("rect", { x: (bin - from) * step, y: height - tall, width: Math.max(step - 0.5, 0.5), height: tall });
    });
    const ticks = [];
    for (let bin = from; bin <= to; bin += perDecade) {
      ticks.push(drawing("text", { x: (bin - from) * step, y: height + 13,
        "text-anchor": bin === from ? "start" : bin === to ? "end" : "middle" }, durationText(least * 10 ** (bin / perDecade))));
    }
    return [element("h3", {}, `${title}: median ${shortNumber(times.median)} µs, 99 % ${shortNumber(times.p99)} µs, greatest ${shortNumber(times.greatest)} µs`),
      drawing("svg", { class: "histogram", viewBox: `0 0 ${width} ${height + 17}`, role: "img", "aria-label": `histogram of the ${title}` }, bars, ticks)];
  }

  drawRecording(counters) {
    if (counters.length === 0) return;
    const of = (name) => counters.find((counter) => counter.name === name).value;
    this.recording.replaceChildren(element("h2", {}, "Recording"),
      element("meter", { min: 0, max: of("room"), low: of("room") * 0.25, high: of("room") * 0.75, optimum: 0, value: of("waiting for the disk"),
        "aria-label": "share of the recorder's memory in use" }),
      element("table", {}, this.row("cycles", of("cycles")), this.row("waiting for the disk", `${of("waiting for the disk")} of ${of("room")}`),
        this.row("dropped", of("dropped"), of("dropped") > 0)));
  }

  row(name, value, alert = false) {
    return element("tr", { class: alert ? "alert" : null }, element("td", {}, name), element("td", {}, String(value)));
  }

  drawCounters(counters) {
    const groups = [...new Set(counters.map((counter) => counter.group))];
    this.counters.replaceChildren(element("h2", {}, "Counters"), ...groups.flatMap((group) => [element("h3", {}, group),
      element("table", {}, counters.filter((counter) => counter.group === group).map((counter) => this.row(counter.name, counter.value)))]));
  }
}
