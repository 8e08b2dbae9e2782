// SPDX-License-Identifier: Apache-2.0
"use strict";
// Building the page. Text only ever becomes a text node, so nothing that a file or a channel is called can turn into markup.

/** An element with attributes and children; children are nodes, texts, or null for none. */
function element(tag, attributes = {}, ...children) {
  return filled(document.createElement(tag), attributes, children);
}

// The namespace is read off an element of the page: written out, it would be the page's one web address.
const SVG_NAMESPACE = document.querySelector("svg").namespaceURI;

function drawing(tag, attributes = {}, ...children) {
  return filled(document.createElementNS(SVG_NAMESPACE, tag), attributes, children);
}

function filled(node, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function") node.addEventListener(name, value);
    else if (value !== null && value !== undefined && value !== false) node.setAttribute(name, value === true ? "" : value);
  }
  node.append(...children.flat(Infinity).filter((child) => child !== null && child !== undefined && child !== ""));
  return node;
}

/**
 * A table without the columns that no row fills. A column is {title, cell(row), number, text, type}; a cell is text, a node
 * or an empty string. `rowClass(row)` may name a class.
 */
function table(columns, rows, rowClass = () => null) {
  const cells = rows.map((row) => columns.map((column) => column.cell(row) ?? ""));
  const used = columns.map((column, index) => cells.some((row) => row[index] !== ""));
  const kind = (column) => [column.number && "number", column.text && "text", column.type].filter(Boolean).join(" ") || null;
  const heads = columns.map((column) => element("th", { class: kind(column), scope: "col" }, column.title));
  const body = rows.map((row, index) => element("tr", { class: rowClass(row, rows[index - 1]) },
    columns.map((column, at) => (used[at] ? element("td", { class: kind(column) }, cells[index][at]) : null))));
  return element("div", { class: "scroll" }, element("table", {},
    element("thead", {}, element("tr", {}, heads.filter((head, index) => used[index]))), element("tbody", {}, body)));
}

const isFilled = (value) => value !== null && value !== undefined && value !== "" &&
  !(typeof value === "object" && Object.keys(value).length === 0);
