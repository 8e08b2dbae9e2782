#include "tools/explain/terms/unlisted_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tools/explain/terms/periodic.hpp"
#include "tools/explain/terms/unlisted.hpp"

namespace hotfire::explain {

namespace {

/// Share of a curve's square from which on it is called by one property alone.
constexpr double kMostly = 0.9;

double at(const FittedTable& table, double x) {
  const auto above = std::upper_bound(table.x.begin(), table.x.end(), x);
  if (above == table.x.begin()) {
    return table.y.front();
  }
  if (above == table.x.end()) {
    return table.y.back();
  }
  const auto k = static_cast<std::size_t>(above - table.x.begin());
  const double share = (x - table.x[k - 1]) / (table.x[k] - table.x[k - 1]);
  return table.y[k - 1] + share * (table.y[k] - table.y[k - 1]);
}

}  // namespace

std::string in_words(const FittedTable& table) {
  const auto [least, most] = std::minmax_element(table.y.begin(), table.y.end());
  std::string text = fmt::format(
      "{} from {:.3g} to {:.3g} {} over {} from {:.3g} to {:.3g} {} (its bounds: beyond them the value at the end holds)",
      table.meaning, *least, *most, table.y_unit, table.x_name, table.x.front(), table.x.back(), table.x_unit);
  constexpr int kSamples = 101;
  const double reach = std::min(std::abs(table.x.front()), std::abs(table.x.back()));
  const bool two_sided = table.x.front() < 0.0 && table.x.back() > 0.0;
  double mean = 0.0;
  double square = 0.0;
  double odd = 0.0;
  double even = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    const double place = static_cast<double>(i) / (kSamples - 1);
    const double y = at(table, table.x.front() + place * (table.x.back() - table.x.front()));
    mean += y / kSamples;
    square += y * y / kSamples;
    const double forward = at(table, reach * place);
    const double backward = at(table, -reach * place);
    odd += 0.25 * (forward - backward) * (forward - backward);
    even += 0.25 * (forward + backward) * (forward + backward);
  }
  if (square > 0.0 && mean * mean > kMostly * square) {
    text += "; mostly constant";
  } else if (two_sided && odd > kMostly * (odd + even)) {
    text += "; odd";
    const double near_zero = at(table, 0.1 * reach) - at(table, -0.1 * reach);
    const double whole = table.y.back() - table.y.front();
    if (std::abs(near_zero) > 0.5 * std::abs(whole)) {
      text += ", with most of it in a jump about zero, as dry friction has";
    }
  } else if (two_sided && even > kMostly * (odd + even)) {
    text += "; even";
  }
  const bool rises = std::is_sorted(table.y.begin(), table.y.end());
  const bool falls = std::is_sorted(table.y.rbegin(), table.y.rend());
  if (rises != falls) {
    text += rises ? "; rises throughout" : "; falls throughout";
  }
  return text;
}

std::string law_in_words(const Candidate& candidate) {
  if (is_periodic(candidate)) {
    return "a sinusoid of one frequency and one amplitude over the whole of every record, whatever the axis does";
  }
  if (candidate.option_name == "creep") {
    return "a share of the deflection that follows the load late, at one time constant, and goes back as late";
  }
  if (candidate.option_name == "deflection_rate") {
    return "a damper beside the load spring: a further spring that relaxes with one time constant, which slow motion does "
           "not meet";
  }
  if (candidate.option_name == "lag") {
    return "a command that goes through a first-order lag before it acts: later and, where it is fast, smaller";
  }
  if (candidate.option_name == "slew") {
    return "a spool that goes no faster than so, however much is asked of it";
  }
  if (candidate.option_name == "slip") {
    return "a joint beside the load spring that sticks, and slips once it is stretched so far: a loop between force and "
           "deflection whose width does not depend on how fast it is run through";
  }
  if (candidate.name == model::UnlistedWiperPlay::name) {
    return "a reading that stays where it is until the motion has gone on by a play: a wiper that sticks, a slack linkage";
  }
  return "";
}

std::string dependence_in_words(const Candidate& candidate) {
  if (is_periodic(candidate)) {
    return "of one frequency";
  }
  if (!candidate.choices.empty()) {
    return "that is a " + candidate.option_name;
  }
  if (candidate.name == model::UnlistedWiperPlay::name) {
    return "that is a play";
  }
  if (candidate.name == model::UnlistedReading::name) {
    return "over what it reads";
  }
  if (candidate.name == model::UnlistedDrift::name) {
    return "over the time of the record";
  }
  std::string quantity = candidate.option_name;
  std::replace(quantity.begin(), quantity.end(), '_', ' ');
  return "that is told by " + quantity;
}

}  // namespace hotfire::explain
