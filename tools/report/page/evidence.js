// SPDX-License-Identifier: Apache-2.0
"use strict";
// The chain of evidence: what was tried in which order, what each candidate reached, why it was kept or dropped; and who says so.

const timesNoise = (channels, stage) => Object.entries(channels)
  .filter(([, channel]) => channel.noise > 0 && channel.noise_source !== "floor" && Number.isFinite(channel[stage]?.rms))
  .map(([name, channel]) => `${words(name)} ${number(channel[stage].rms / channel.noise)}`).join(", ");

const countOf = (number, singular, plural = `${singular}s`) => `${number} ${number === 1 ? singular : plural}`;

/** The rounds of the search in their order, axis by axis, each with its rows. */
function roundsOf(rows) {
  const rounds = new Map();
  for (const row of rows) {
    const key = `${row.axis ?? ""} ${row.round}`;
    rounds.set(key, [...(rounds.get(key) ?? []), row]);
  }
  const axes = [...new Set(rows.map((row) => row.axis))];
  const place = ([row]) => axes.indexOf(row.axis);
  return [...rounds.values()].sort((first, second) => place(first) - place(second) || first[0].round - second[0].round);
}

const isFittedJointly = (row) => Number.isFinite(row.held_out_rms_ratio);

function roundText(rows) {
  const [{ round, axis }] = rows;
  const tried = rows.filter((row) => row.decision !== "taken out");
  const effectsTried = new Set(tried.map((row) => row.candidate)).size;
  const joint = tried.filter(isFittedJointly).length;
  const nameOf = (row) => `${withLaw(row)}${row.reason ? ` (${row.reason})` : ""}`;
  const named = (decision) => rows.filter((row) => row.decision === decision).map(nameOf).join("; ");
  const kept = named("kept");
  const name = `Round ${round}${isFilled(axis) ? ` of the ${axis} axis` : ""}`;
  return [`${name}: ${countOf(tried.length, "candidate")} of ${countOf(effectsTried, "effect")} screened, ` +
    `${joint || "none"} of them fitted together with everything else.`,
    kept ? `Kept: ${kept}.` : "None was kept.", named("tied") && `Not separated from it: ${named("tied")}.`,
    named("taken out") && `Taken out again: ${named("taken out")}.`].filter(Boolean).join(" ");
}

/** Every step from the declared model to the verdict, a line each. */
function chain(report) {
  const moved = Object.entries(report.calibration ?? {});
  const steps = [["As declared, rms error over noise on held-out data: ", timesNoise(report.channels, "before")],
    [moved.length ? `${countOf(moved.length, "declared parameter")} calibrated within tolerance, without any effect: ` : "Calibrated: ",
      timesNoise(report.channels, "calibrated")],
    ...roundsOf(report.search ?? []).map((round) => ["", roundText(round)]),
    ["With what was kept: ", isFilled(report.effects) ? timesNoise(report.channels, "after") : ""],
    ["Verdict: ", `${(VERDICTS[report.verdict] ?? [words(report.verdict)])[0].toLowerCase()}`]];
  return element("ol", { class: "chain" }, steps.filter(([, result]) => result).map(([step, result]) =>
    element("li", {}, step, result, result.endsWith(".") ? "" : ".")));
}

function searchTable(report) {
  const isNext = (row, previous) => previous && (row.round !== previous.round || row.axis !== previous.axis);
  const rowClass = (row, previous) => [row.decision === "kept" && "kept", isNext(row, previous) && "round"]
    .filter(Boolean).join(" ") || null;
  const ofAxes = report.search.some((row) => isFilled(row.axis));
  return [table([
    ...(ofAxes ? [{ title: "axis", cell: (row) => String(row.axis ?? "") }] : []),
    { title: "round", number: true, cell: (row) => String(row.round ?? "") },
    { title: "candidate", cell: withLaw },
    { title: "judged by", cell: (row) => (isFittedJointly(row) ? "joint fit" : "screening") },
    { title: "held-out error, ratio", number: true, cell: (row) => (isFittedJointly(row) ? fixed(row.held_out_rms_ratio, 3) : "") },
    { title: "BIC change", number: true, cell: (row) => (Number.isFinite(row.delta_bic) ? number(row.delta_bic, 3) : "") },
    { title: "time [s]", number: true, cell: (row) => (Number.isFinite(row.seconds) ? number(row.seconds, 2) : "") },
    { title: "decision", cell: (row) => words(row.decision ?? "") },
    { title: "why", text: true, cell: (row) => row.reason ?? "" },
  ], report.search, rowClass), paragraph("Rounds in the order in which they were made, the candidates of a round by what screening " +
    "promised. Ratio: held-out error with the candidate over the error without it.", "note")];
}

function evidence(report) {
  return isFilled(report.search) ? section("Chain of evidence: what was tried", chain(report), searchTable(report)) : null;
}

/** For paper: who made the report, who checked it, who answers for it. */
function signatures() {
  const line = (role) => element("tr", {}, element("td", {}, role), element("td"), element("td"), element("td"));
  return element("section", { class: "print-only together signatures" }, element("h2", {}, "Signatures"), element("table", {},
    element("thead", {}, element("tr", {}, ["", "name", "date", "signature"].map((title) => element("th", { scope: "col" }, title)))),
    element("tbody", {}, ["prepared", "reviewed", "approved"].map(line))));
}
