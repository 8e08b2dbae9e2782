// SPDX-License-Identifier: Apache-2.0
"use strict";
// What is on paper and not on the screen: every channel of every record instead of the one that is looked at, and a running foot.

// Width of the sheet in the style sheet's print part; strips so tall that three channels are on a page of Letter; and twice as
// fine as the screen where a browser prints a canvas as its pixels.
const SHEET = { width: 976, height: 0.55, pixelRatio: 2 };

/** A CSS string that holds the text, whatever is in it: no character that a style or a page could take for its own is left. */
const cssString = (text) => `"${text.replace(/[^\p{L}\p{N} .,:()·_-]/gu, (each) => `\\${each.codePointAt(0).toString(16)} `)}"`;

/** Name, date and version at the foot of every page, beside the page's number. */
function runningFoot(report) {
  const footer = ["Hotfire report", report.name || report.model, report.date].filter(isFilled).join(" · ");
  const style = element("style");
  style.textContent = `@page { @bottom-left { content: ${cssString(footer)}; } }`;
  document.head.append(style);
}

/** Draws all records before printing and takes them away after it. `host` is where. */
function printAllRecords(host, records) {
  let drawn = [];
  window.addEventListener("beforeprint", () => {
    if (drawn.length) return;
    document.documentElement.classList.add("printing");
    drawn = records.flatMap((record) => record.channels.map((channel) => {
      const sheet = element("div", { class: "together", style: `width:${SHEET.width}px` });
      host.append(sheet);
      return new Traces(sheet, [record], { channel: channel.name }, SHEET);
    }));
  });
  window.addEventListener("afterprint", () => {
    for (const traces of drawn) traces.destroy();
    drawn = [];
    host.replaceChildren();
    document.documentElement.classList.remove("printing");
  });
}
