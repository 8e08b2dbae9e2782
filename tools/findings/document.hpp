// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tools/findings/finding.hpp"

namespace hotfire::findings {

/// A finding and what it came to.
struct Row {
  const Finding* finding = nullptr;
  Outcome outcome = {};
};

/// The pages of the documentation about the findings, by their path in docs/: findings.md with the table of all, and pages
/// of ten findings each with their figures.
std::map<std::string, std::string> pages(const std::vector<Row>& rows);

/// Whether a number of the parameter sets was tuned to this figure.
bool is_tuned(const Finding& finding, const Figure& figure);

/// Path of a finding's picture among those of all: "f1-f10/F1.svg".
std::string picture_name(const Finding& finding);

/// "9.51 Hz", four digits.
std::string figure_text(double value, const std::string& unit);

}  // namespace hotfire::findings
