// SPDX-License-Identifier: Apache-2.0
"use strict";
// How the axis of a chart is divided: the range of its values, where in the range a value lies, and the numbers written at it.

/** Round numbers from low to high, about `count` of them. */
function ticks(low, high, count) {
  const raw = (high - low) / count;
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 2.5, 5, 10].map((each) => each * power).find((each) => each >= raw * 0.999);
  const first = Math.ceil(low / step - 1e-9);
  const last = Math.floor(high / step + 1e-9);
  const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9) + (step / power === 2.5 ? 1 : 0));
  return Array.from({ length: last - first + 1 }, (unused, index) => (first + index) * step)
    .map((value) => ({ value, text: fixed(value, decimals) }));
}

/** Smallest and largest, widened by a share of their distance; a single value gets room around it. */
function extent(values, margin) {
  let low = Infinity;
  let high = -Infinity;
  for (const value of values) {
    if (!Number.isFinite(value)) continue;
    low = Math.min(low, value);
    high = Math.max(high, value);
  }
  if (low > high) return [0, 1];
  const room = (high - low) * margin || Math.abs(high) * 0.1 || 1;
  return [low - room, high + room];
}

/** As extent(), in ratios and of positive values only. A decade at least, so that there are round numbers to write. */
function logarithmicExtent(values, margin) {
  const [low, high] = extent(values.map((value) => Math.log10(value)), margin);
  const room = Math.max(0, (1 - (high - low)) / 2);
  return [10 ** (low - room), 10 ** (high + room)];
}

/** 1, 2 and 5 of each decade; over many decades only the 1 has a text, and the lines of the others show how the axis runs. */
function logarithmicTicks(low, high) {
  const first = Math.floor(Math.log10(low));
  const decades = Array.from({ length: Math.floor(Math.log10(high)) - first + 1 }, (unused, index) => 10 ** (first + index));
  const texts = high / low > 200 ? [1] : [1, 2, 5];
  return decades.flatMap((decade) => [1, 2, 5].map((step) => ({ value: step * decade,
    text: texts.includes(step) ? number(step * decade, 1) : "" }))).filter(({ value }) => value >= low && value <= high);
}

const LINEAR = { extent, ticks, share: (value, [low, high]) => (value - low) / (high - low) };
const LOGARITHMIC = { extent: logarithmicExtent, ticks: logarithmicTicks,
  share: (value, [low, high]) => Math.log(value / low) / Math.log(high / low) };
