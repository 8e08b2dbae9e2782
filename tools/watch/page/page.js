// SPDX-License-Identifier: Apache-2.0
"use strict";
// Asks the server for what is new and draws it, also when the program or the server itself has been started again.

const POLL_MS = 100;
const RETRY_MS = 500;
const PANELS_MS = 500;

const strips = new Strips(document.getElementById("controls"), document.getElementById("strips"));
const panels = new Panels(document.getElementById("panels"));
const page = { epoch: "", row: 0, program: null, choice: 0, panelsAt: -PANELS_MS };

function showState([text, kind, why], answer) {
  const state = document.getElementById("state");
  state.textContent = text;
  state.className = kind;
  document.getElementById("reason").textContent = why;
  document.title = `${text} · ${page.program?.topology ?? "Hotfire"}`;
  document.documentElement.dataset.state = answer?.state ?? "no server";
}

function showFacts(answer) {
  const program = page.program;
  document.getElementById("subject").textContent = `· ${program.topology} on ${program.host}`;
  const fact = (name, value) => element("div", {}, element("dt", {}, name), element("dd", {}, String(value)));
  document.getElementById("facts").replaceChildren(fact("started", program.started.replace("T", " ").replace("Z", " UTC")),
    fact("period", `${program.period_us} µs`), fact("cycle", answer.cycle ?? "—"), fact("version", program.version));
}

/** Draws an answer. False if the page is to ask again at once. */
function take(answer, choice) {
  if (answer.program) {
    page.program = answer.program;
    strips.begin(answer.program.channels);
    panels.begin(answer.program);
  }
  showState(stateOf(answer, page.program), answer);
  if (!page.program) return true;
  if (performance.now() - page.panelsAt >= PANELS_MS || answer.program) {
    page.panelsAt = performance.now();
    showFacts(answer);
    panels.draw(answer);
  }
  // The choice of channels may have changed while the answer was on its way, or the program have others: then ask again.
  if (choice !== strips.choice || JSON.stringify(answer.sent) !== JSON.stringify(strips.shown)) {
    page.epoch = "";
    return false;
  }
  page.epoch = answer.epoch;
  page.row = answer.next;
  if (strips.append(answer.rows) && !document.documentElement.dataset.firstChart) {
    document.documentElement.dataset.firstChart = performance.now().toFixed(0);
  }
  return true;
}

/** The answer of the server; null if there is none. */
async function ask(choice) {
  const wanted = new URLSearchParams({ epoch: choice === page.choice ? page.epoch : "", row: page.row,
    channels: (strips.shown ?? []).join(",") });
  try {
    const response = await fetch(`data?${wanted}`, { cache: "no-store" });
    return response.ok ? await response.json() : null;
  } catch {
    return null;
  }
}

async function poll() {
  let wait = RETRY_MS;
  try {
    const choice = strips.choice;
    const answer = await ask(choice);
    page.choice = choice;
    if (answer === null) {
      showState(["NO SERVER", "bad", "hotfire watch does not answer; the page goes on when it does"], null);
    } else {
      wait = take(answer, choice) ? POLL_MS : 0;
    }
  } finally {
    setTimeout(poll, wait);
  }
}

poll();
