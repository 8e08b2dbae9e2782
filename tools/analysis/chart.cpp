// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

#include "tools/files/exchange/xml_text.hpp"

namespace hotfire::analysis {

namespace {

constexpr double kWidth = 760.0;
constexpr double kPanelHeight = 230.0;
constexpr double kLeft = 72.0;
constexpr double kRight = 20.0;
constexpr double kTop = 44.0;
constexpr double kGap = 26.0;
constexpr double kBottom = 48.0;
// Distinguished by colour-blind readers: Okabe and Ito.
constexpr std::array<const char*, 7> kColours{"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000"};

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void see(double value) {
    if (std::isfinite(value)) {
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
  /// With room to either side, and never empty.
  Range widened(double share) const {
    if (!(low <= high)) {
      return {0.0, 1.0};
    }
    const double room = high > low ? share * (high - low) : std::max(1e-12, 0.1 * std::abs(high));
    return {low - room, high + room};
  }
};

/// Round numbers over a range, four to eight of them.
std::vector<double> ticks(const Range& range) {
  const double rough = (range.high - range.low) / 5.0;
  const double decade = std::pow(10.0, std::floor(std::log10(rough)));
  const double share = rough / decade;
  const double step = decade * (share < 1.5 ? 1.0 : share < 3.5 ? 2.0 : share < 7.5 ? 5.0 : 10.0);
  std::vector<double> marks;
  for (double k = std::ceil(range.low / step); k * step <= range.high; k += 1.0) {
    marks.push_back(k * step + 0.0);  // no negative zero
  }
  return marks;
}

/// 1, 2 and 5 of every decade.
std::vector<double> logarithmic_ticks(const Range& range) {
  std::vector<double> marks;
  for (double decade = std::floor(range.low); decade <= range.high; decade += 1.0) {
    for (const double digit : {1.0, 2.0, 5.0}) {
      const double mark = decade + std::log10(digit);
      if (mark >= range.low && mark <= range.high) {
        marks.push_back(mark);
      }
    }
  }
  return marks;
}

class Drawing {
 public:
  explicit Drawing(const Chart& chart) : chart_(chart) {
    for (const Panel& panel : chart.panels) {
      for (const Curve& curve : panel.curves) {
        std::for_each(curve.x.begin(), curve.x.end(), [this](double x) { x_.see(abscissa(x)); });
      }
    }
    x_ = x_.widened(0.01);
    const double height = kTop + static_cast<double>(chart.panels.size()) * (kPanelHeight + kGap) - kGap + kBottom;
    add("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" "
        "font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"{0}\" height=\"{1}\" fill=\"white\"/>\n",
        kWidth, height);
    add("<text x=\"{}\" y=\"18\" font-size=\"14\" font-weight=\"bold\">{}</text>\n", kLeft, escaped(chart.title));
    draw_legend();
    for (std::size_t p = 0; p < chart.panels.size(); ++p) {
      draw_panel(chart.panels[p], kTop + static_cast<double>(p) * (kPanelHeight + kGap));
    }
    add("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n</svg>\n", 0.5 * (kLeft + kWidth - kRight), height - 10.0,
        escaped(chart.abscissa));
  }

  const std::string& text() const { return text_; }

 private:
  template <class... Values>
  void add(fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Values>(values)...);
  }

  /// Zero has no logarithm: minus infinity, which is no point of a curve.
  double abscissa(double x) const { return chart_.logarithmic ? std::log10(x) : x; }
  double across(double x) const { return kLeft + (x - x_.low) / (x_.high - x_.low) * (kWidth - kLeft - kRight); }

  const char* colour_of(const std::string& label) {
    const auto known = std::find(labels_.begin(), labels_.end(), label);
    const auto index = static_cast<std::size_t>(known - labels_.begin());
    if (known == labels_.end()) {
      labels_.push_back(label);
    }
    return kColours[index % kColours.size()];
  }

  void draw_legend() {
    double x = kLeft;
    for (const Curve& curve : chart_.panels.front().curves) {
      const bool is_named = std::find(labels_.begin(), labels_.end(), curve.label) != labels_.end();
      if (!curve.label.empty() && !is_named) {
        add("<text x=\"{:.0f}\" y=\"36\" fill=\"{}\">{}</text>\n", x, colour_of(curve.label), escaped(curve.label));
        x += 20.0 + 6.6 * static_cast<double>(curve.label.size());
      }
    }
  }

  void draw_panel(const Panel& panel, double top) {
    Range y;
    for (const Curve& curve : panel.curves) {
      std::for_each(curve.y.begin(), curve.y.end(), [&y](double own) { y.see(own); });
    }
    y = y.widened(0.06);
    const auto down = [&](double own) { return top + kPanelHeight * (y.high - own) / (y.high - y.low); };
    const double end = kWidth - kRight;
    for (const double mark : ticks(y)) {
      add("<path d=\"M{} {:.1f}H{}\" stroke=\"#ddd\"/><text x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{:g}</text>\n", kLeft,
          down(mark), end, kLeft - 6.0, down(mark) + 4.0, mark);
    }
    for (const double mark : chart_.logarithmic ? logarithmic_ticks(x_) : ticks(x_)) {
      add("<path d=\"M{0:.1f} {1}V{2}\" stroke=\"#ddd\"/><text x=\"{0:.1f}\" y=\"{3}\" "
          "text-anchor=\"middle\">{4:.6g}</text>\n",
          across(mark), top, top + kPanelHeight, top + kPanelHeight + 15.0,
          chart_.logarithmic ? std::pow(10.0, mark) : mark);
    }
    add("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"#888\"/>\n", kLeft, top, end - kLeft,
        kPanelHeight);
    add("<text transform=\"translate(16 {}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n", top + 0.5 * kPanelHeight,
        escaped(panel.ordinate));
    for (const Curve& curve : panel.curves) {
      draw_curve(curve, down);
    }
  }

  template <class Down>
  void draw_curve(const Curve& curve, Down&& down) {
    const char* colour = colour_of(curve.label);
    std::string path;
    for (std::size_t k = 0; k < curve.x.size(); ++k) {
      const double x = abscissa(curve.x[k]);
      if (!std::isfinite(x) || !std::isfinite(curve.y[k])) {
        continue;
      }
      if (curve.dots) {
        add("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\" fill=\"{}\"/>\n", across(x), down(curve.y[k]), colour);
      } else {
        fmt::format_to(std::back_inserter(path), "{}{:.1f} {:.1f}", path.empty() ? "M" : "L", across(x), down(curve.y[k]));
      }
    }
    if (!path.empty()) {
      add("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.6\"/>\n", path, colour);
    }
  }

  const Chart& chart_;
  Range x_;
  std::vector<std::string> labels_;
  std::string text_;
};

}  // namespace

std::string svg(const Chart& chart) { return Drawing(chart).text(); }

}  // namespace hotfire::analysis
