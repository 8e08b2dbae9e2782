// SPDX-License-Identifier: Apache-2.0
"use strict";
// Numbers and units as an engineer writes them.

const SMALL_PREFIXES = [["p", 1e-12], ["n", 1e-9], ["µ", 1e-6], ["m", 1e-3], ["", 1]];
const ALL_PREFIXES = [...SMALL_PREFIXES, ["k", 1e3], ["M", 1e6], ["G", 1e9]];
const PREFIXES_OF = { m: SMALL_PREFIXES, s: SMALL_PREFIXES, rad: SMALL_PREFIXES, deg: SMALL_PREFIXES.slice(2), N: ALL_PREFIXES,
  Pa: ALL_PREFIXES, V: ALL_PREFIXES, A: ALL_PREFIXES, W: ALL_PREFIXES, J: ALL_PREFIXES, Hz: ALL_PREFIXES };
const SUPERSCRIPTS = { "-": "⁻", 0: "⁰", 1: "¹", 2: "²", 3: "³", 4: "⁴", 5: "⁵", 6: "⁶", 7: "⁷", 8: "⁸", 9: "⁹" };

const superscript = (digits) => [...String(digits)].map((digit) => SUPERSCRIPTS[digit]).join("");

/** A UDUNITS-2 unit in print: "kg.m^2" becomes kg·m². */
function printedUnit(unit) {
  return unit.replace(/\^?(-?\d)(?=$|[./ ])/g, (match, digits, at) => (at === 0 ? match : superscript(digits))).replace(/\./g, "·");
}

const finite = (values) => values.filter((value) => Number.isFinite(value));

/** Between the smallest and the largest of the values, in ratio: what a prefix for all of them should suit. */
function typicalSize(values) {
  const sizes = finite(values).map(Math.abs).filter((size) => size > 0);
  return sizes.length ? Math.sqrt(Math.min(...sizes) * Math.max(...sizes)) : 0;
}

/**
 * How to show values of this size: multiply by `factor` and write `label`. Angles are shown in degrees; other units take a
 * prefix where one is usual (not before a power such as m^3), else a power of ten where the number needs it.
 */
function displayUnit(unit, size) {
  let base = unit && unit !== "1" ? unit : "";
  let scale = 1;
  if (base === "rad") {
    base = "deg";
    scale = 180 / Math.PI;
  }
  const shown = size * scale;
  const [, symbol, rest] = base.match(/^([A-Za-z]+)(?![\d^A-Za-z-])(.*)$/) ?? [null, "", base];
  const prefixes = PREFIXES_OF[symbol];
  if (prefixes && shown > 0) {
    // 0.4 deg is read more easily than 400 mdeg; with the other units it is the other way round.
    const least = symbol === "deg" ? 0.0999 : 0.9995;
    const [prefix, step] = prefixes.filter(([, each]) => shown >= each * least).pop() ?? prefixes[0];
    return { factor: scale / step, label: prefix + symbol + printedUnit(rest) };
  }
  const label = printedUnit(base);
  if (shown === 0 || (shown >= 1e-3 && shown < 1e5)) return { factor: scale, label };
  const exponent = 3 * Math.floor(Math.log10(shown) / 3);
  return { factor: scale / 10 ** exponent, label: `10${superscript(exponent)}${label ? ` ${label}` : ""}` };
}

const inUnit = (label) => (label ? ` ${label}` : "");
const axisTitle = (label, unit) => [label, unit && `[${unit}]`].filter(Boolean).join(" ");

/** Fixed decimals, a true minus sign, thousands apart. */
function fixed(value, decimals) {
  if (!Number.isFinite(value)) return "–";
  const text = Math.abs(value).toFixed(decimals);
  const [whole, part] = text.split(".");
  const grouped = whole.length > 4 ? whole.replace(/\B(?=(\d{3})+$)/g, "\u202f") : whole;
  return (value < 0 && Number(text) !== 0 ? "−" : "") + grouped + (part ? `.${part}` : "");
}

/** A number to so many significant digits. */
function number(value, digits = 3) {
  if (!Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const exponent = Math.floor(Math.log10(Math.abs(value)));
  if (exponent < -4 || exponent > 6) {
    return `${fixed(value / 10 ** exponent, digits - 1)}×10${superscript(exponent)}`;
  }
  return fixed(value, Math.max(0, digits - 1 - exponent));
}

/** Decimals that show two digits of an interval's half-width, or four of the value where there is no interval. */
function decimalsFor(value, halfWidth) {
  const last = halfWidth > 0 ? Math.floor(Math.log10(halfWidth)) - 1 : Math.floor(Math.log10(Math.abs(value) || 1)) - 3;
  return Math.min(8, Math.max(0, -last));
}

/** A value with its 95 % interval in one unit and to the same digit: {value, interval, unit}; interval "" if there is none. */
function quantity(value, interval, unit) {
  const usable = Array.isArray(interval) && interval.every((bound) => Number.isFinite(bound));
  const display = displayUnit(unit ?? "", Math.abs(value));
  const shown = Number.isFinite(value) ? value * display.factor : NaN;
  const [low, high] = usable ? interval.map((bound) => bound * display.factor) : [shown, shown];
  const decimals = decimalsFor(shown, (high - low) / 2);
  return { value: fixed(shown, decimals), unit: display.label,
    interval: usable ? `${fixed(low, decimals)} … ${fixed(high, decimals)}` : "", factor: display.factor };
}

/** "gimbal_friction" becomes "gimbal friction". */
const words = (name) => String(name).replace(/_/g, " ");
const sentenceCase = (text) => text.charAt(0).toUpperCase() + text.slice(1);
