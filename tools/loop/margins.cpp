// SPDX-License-Identifier: Apache-2.0
#include "tools/loop/margins.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hotfire::loop {

namespace {

/// What crosses zero at a margin: the logarithm of the size, or the imaginary part over the size.
double size_of(Complex own) { return std::log(std::abs(own)); }
double across(Complex own) { return own.imag() / std::abs(own); }

/// The frequency and the loop where `value` of it is zero, between two of different signs: regula falsi with halved ends
/// (Illinois) on the logarithm of the frequency [Dowell and Jarratt 1971, BIT 11].
std::optional<std::pair<double, Complex>> root_between(double (*value)(Complex), const OpenLoop& loop, double low,
                                                       double high, double at_low, double at_high, double accuracy) {
  constexpr int kMostRounds = 100;
  double a = std::log(low);
  double b = std::log(high);
  std::optional<std::pair<double, Complex>> found;
  for (int k = 0; k < kMostRounds; ++k) {
    const double next = k % 8 == 7 ? 0.5 * (a + b) : (a * at_high - b * at_low) / (at_high - at_low);
    const std::optional<Complex> own = loop(std::exp(next));
    if (!own) {
      return {};
    }
    const double before = found ? std::log(found->first) : a;
    found.emplace(std::exp(next), *own);
    const double at = value(*own);
    if (at == 0.0 || std::abs(b - a) < accuracy || std::abs(next - before) < 0.1 * accuracy) {
      break;
    }
    if ((at > 0.0) == (at_low > 0.0)) {
      a = next;
      at_low = at;
      at_high *= 0.5;
    } else {
      b = next;
      at_high = at;
      at_low *= 0.5;
    }
  }
  return found;
}

}  // namespace

Margins margins_of(const OpenLoop& loop, const std::vector<double>& frequencies, double accuracy) {
  Margins margins;
  std::optional<Complex> last;
  for (std::size_t k = 0; k < frequencies.size(); ++k) {
    const std::optional<Complex> own = loop(frequencies[k]);
    if (own && last) {
      const double low = frequencies[k - 1];
      const double high = frequencies[k];
      const auto root = [&](double (*value)(Complex)) {
        const double at_low = value(*last);
        const double at_high = value(*own);
        return (at_low > 0.0) == (at_high > 0.0) ? std::nullopt
                                                 : root_between(value, loop, low, high, at_low, at_high, accuracy);
      };
      if (const auto at = root(size_of)) {
        margins.phase.push_back({at->first, std::remainder(std::arg(at->second) - std::numbers::pi, kTurn) * 360.0 / kTurn});
      }
      if (const auto at = root(across); at && at->second.real() < 0.0) {
        margins.gain.push_back({at->first, -20.0 * std::log10(std::abs(at->second))});
      }
    }
    last = own;
  }
  return margins;
}

}  // namespace hotfire::loop
