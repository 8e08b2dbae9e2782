// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace hotfire::analysis {

/// One curve of a panel; points that are not finite are left out.
struct Curve {
  std::string label;
  std::vector<double> x;
  std::vector<double> y;
  bool dots = false;  ///< points as dots, without a line
};

/// One panel of a chart. Panels are below each other over the same abscissa.
struct Panel {
  std::string ordinate;  ///< "gain [dB]"
  std::vector<Curve> curves;
};

struct Chart {
  std::string title;
  std::string abscissa;      ///< "frequency [Hz]"
  bool logarithmic = false;  ///< abscissa
  std::vector<Panel> panels;
};

/// The chart as a self-contained SVG picture. Curves with the same label have the same colour in every panel; a legend names
/// those of the first.
std::string svg(const Chart& chart);

}  // namespace hotfire::analysis
