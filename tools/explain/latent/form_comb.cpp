// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/latent/form_comb.hpp"

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "tools/explain/fit/curve_points.hpp"
#include "tools/explain/latent/correlation.hpp"

namespace hotfire::explain {

namespace {

using model::Argument;
using model::Memory;
using model::Site;

/// Points of a curve in front of a memory: as many as a term holds.
constexpr int kCurvePoints = model::kUnlistedPoints;
/// Those of a curve by which a memory is screened, and the fewest that are not a straight line.
constexpr int kRoughPoints = 5;
constexpr std::size_t kFewestPoints = 3;
/// Share of a smoothed signal's variance that no function follows: what a smoother adds.
constexpr double kLeastScatter = 1e-3;
/// Widths at which a straight line may bend, over the 99th percentile of the argument: from what play and noise hide.
constexpr double kNarrowestKink = 0.02;
constexpr int kKinks = 10;
/// Share of a quantity's values on either side that its curve's ends leave out.
constexpr double kEnds = 5e-4;
/// Ends of the combs of times and frequencies, in time constants of the servo: of the reference axis 0.1, 10 and 1 s, and 1
/// to 30 Hz.
constexpr double kLongestDelay = 1.7;
constexpr double kLongestLag = 170.0;
constexpr double kLongestWashout = 17.0;
constexpr double kSlowestCycles = 0.059;
constexpr double kFastestCycles = 1.77;
/// The record separates two delays that differ by an eighth of a period of the fastest that the axis does, 25 Hz.
constexpr double kDelayStep = 0.085;
/// Widths of stop operators, over the 99th percentile of the argument.
constexpr std::array kStopWidths{0.05, 0.15, 0.35, 0.7};
/// Half widths of one play or stop, over the same: from what the noise hides to what hardly moves.
constexpr double kNarrowestPlay = 0.04;
constexpr double kWidestPlay = 0.7;
constexpr int kPlays = 5;
/// The longest time for which a signal is held, in time constants of the servo, of the reference axis 0.1 s, and about how
/// many times there are up to it.
constexpr double kLongestHold = 1.7;
constexpr int kHolds = 50;
/// Phases of the samples: at an eighth of a period from the right one most of a held signal shows.
constexpr int kPhasesHeld = 4;
/// The finest ripple over a quantity, and the finest quantum of a signal that is rounded: four times the number of periods
/// in the range of the quantity.
constexpr int kFinestRipple = 40;
constexpr int kFinestQuantum = 800;
/// Exponents in the comb of powers.
constexpr int kPowers = 5;
/// The slowest limit of a slew, over the 99th percentile of the argument's rate, and the fastest, over its largest: a limit
/// above that takes hardly anything off. Two neighbours differ by the factor.
constexpr double kSlowestSlew = 0.03;
constexpr double kFastestSlew = 0.8;
constexpr double kSlewFactor = 1.8;

/// Sorted values of what a form is a law of.
std::vector<double> sorted_values(const FormRegression& regression, const Form& form) {
  std::vector<double> values;
  for (const Eigen::MatrixXd& quantities : regression.quantities()) {
    const Eigen::VectorXd own = argument_of(form, quantities);
    values.insert(values.end(), own.begin(), own.end());
  }
  std::ranges::sort(values);
  return values;
}

/// What enters the form's memory, by row of an experiment.
Eigen::VectorXd entering_of(const Form& form, const Eigen::MatrixXd& quantities) {
  return argument_of(form, quantities).unaryExpr([&](double value) { return form.entering(value); });
}

/// The 99th percentile of the size of what enters a memory: what its widths, quanta and pitches are measured by.
double size_of(const FormRegression& regression, const Form& form) {
  std::vector<double> sizes;
  for (const Eigen::MatrixXd& quantities : regression.quantities()) {
    const Eigen::VectorXd own = entering_of(form, quantities).cwiseAbs();
    sizes.insert(sizes.end(), own.begin(), own.end());
  }
  return quantile_of_unsorted(sizes, 0.99);
}

/// How fast that changes [1/s].
struct Rate {
  double usual = 0.0;  ///< the 99th percentile
  double largest = 0.0;
};

Rate rate_of(const FormRegression& regression, const Form& form) {
  std::vector<double> rates;
  for (std::size_t e = 0; e < regression.quantities().size(); ++e) {
    const Eigen::VectorXd own = entering_of(form, regression.quantities()[e]);
    const double period = regression.problem().data.experiments[e].period;
    for (Eigen::Index row = 1; row < own.size(); ++row) {
      rates.push_back(std::abs(own(row) - own(row - 1)) / period);
    }
  }
  return rates.empty() ? Rate{} : Rate{quantile_of_unsorted(rates, 0.99), *std::ranges::max_element(rates)};
}

std::vector<double> comb(double low, double high, int count) {
  std::vector<double> values;
  values.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    values.push_back(low * std::pow(high / low, static_cast<double>(i) / (count - 1)));
  }
  return values;
}

/// A curve beside a memory that is itself a curve, or a sum of operators, is no further form.
bool bears_curve(Memory kind, bool curve_first) {
  switch (kind) {
    case Memory::stops:
    case Memory::quantise:
    case Memory::dead_zone:
    case Memory::saturation:
    case Memory::oscillator:
    case Memory::odd_power:
    case Memory::even_power:
      return false;
    case Memory::none:
    case Memory::periodic:
    case Memory::play:
    case Memory::stop:
    case Memory::slew:
      return !curve_first;
    default:
      return true;
  }
}

/// Points where a curve over the form's output has to bend to follow the smoothed signal. Its scatter about any function of
/// the output is its noise.
std::vector<double> followed_points(const FormRegression& regression, const Form& form) {
  const SignalCorrelation correlation(regression);
  const std::vector<double> x = correlation.output(form);
  const std::vector<double>& signal = correlation.signal();
  std::vector<double> sorted = x;
  std::ranges::sort(sorted);
  const double low = quantile(sorted, kEnds);
  const double high = quantile(sorted, 1.0 - kEnds);
  if (!(high > low) || !std::isfinite(low) || !std::isfinite(high)) {
    return {};
  }
  double square = 0.0;
  for (const double value : signal) {
    square += value * value;
  }
  const double within = std::max(kLeastScatter, 1.0 - correlation_ratio(x, signal));
  const double noise = std::sqrt(within * square / static_cast<double>(signal.size()));
  std::vector<double> own;
  std::vector<double> followed;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (x[i] >= low && x[i] <= high) {
      own.push_back(x[i]);
      followed.push_back(noise > 0.0 ? signal[i] / noise : 0.0);
    }
  }
  return curve_points(own, followed, model::kUnlistedPoints);
}

}  // namespace

std::vector<double> spread_points(const std::vector<double>& sorted, int count) {
  std::vector<double> points;
  const double low = quantile(sorted, kEnds);
  const double high = quantile(sorted, 1.0 - kEnds);
  if (!(high > low) || !std::isfinite(low) || !std::isfinite(high)) {
    return points;
  }
  const double least_gap = 1e-3 * (high - low);
  for (int i = 0; i < count; ++i) {
    const double place = static_cast<double>(i) / (count - 1);
    const double x = 0.5 * (low + (high - low) * place + quantile(sorted, kEnds + (1.0 - 2.0 * kEnds) * place));
    if (points.empty() || x > points.back() + least_gap) {
      points.push_back(x);
    }
  }
  return points;
}

Form at_place(const LatentPlace& place, Argument argument, std::optional<Argument> factor) {
  Form form;
  form.argument = argument;
  form.factor = factor;
  if (!place.port) {
    form.site = Site::sensor;
    form.channel = static_cast<int>(place.channel);
    return form;
  }
  switch (*place.port) {
    case Port::torque_motor:
      form.site = argument == Argument::command && !factor ? Site::command : Site::valve_command;
      break;
    case Port::oil:
      form.site = Site::flow;
      break;
    case Port::piston:
      form.site = Site::piston;
      break;
    case Port::spring:
      form.site = Site::load_spring;
      break;
    case Port::engine:
      form.site = Site::engine_torque;
      break;
  }
  return form;
}

namespace {

/// Plays, stops and slews of what enters the memory of `plain`, of that size and rate.
void add_plays_and_slews(const Form& plain, double size, const Rate& rate, std::vector<Form>& forms) {
  const auto add = [&](Memory kind, double width) {
    Form form = plain;
    form.memory.kind = kind;
    form.memory.width = width;
    forms.push_back(std::move(form));
  };
  for (const double width : comb(kNarrowestPlay, kWidestPlay, kPlays)) {
    add(Memory::play, width * size);
    add(Memory::stop, width * size);
  }
  const double fastest = std::max(rate.usual, kFastestSlew * rate.largest);
  const double usual = rate.usual > 0.0 ? rate.usual : rate.largest;
  for (double limit = kSlowestSlew * usual; limit < kSlewFactor * fastest; limit *= kSlewFactor) {
    add(Memory::slew, std::min(limit, fastest));
  }
}

/// Holds of the form's argument over the comb of their period and of the instants of their samples.
std::vector<Form> with_holds(const FormRegression& regression, const Form& plain) {
  std::vector<Form> forms;
  double row = HUGE_VAL;
  for (const Experiment& experiment : regression.problem().data.experiments) {
    row = std::min(row, experiment.log_period());
  }
  const double longest = kLongestHold * regression.problem().scales.time;
  const double step = row * std::max(1.0, std::round(longest / kHolds / row));
  // At any other period than its own a held signal is soon out of step, and no fit moves it there. A logger that is
  // synchronous with it has a whole number of rows. A product of two is held more rarely: its comb is coarser.
  for (int steps = 2; steps * step <= longest; steps += plain.factor ? 1 + steps / 4 : 1) {
    for (int phase = 0; phase < (plain.factor ? 1 : kPhasesHeld); ++phase) {
      Form form = plain;
      form.memory.kind = Memory::hold;
      form.memory.time = steps * step;
      form.memory.phase = 2.0 * std::numbers::pi * phase / kPhasesHeld;
      forms.push_back(std::move(form));
    }
  }
  return forms;
}

}  // namespace

std::vector<Form> with_memories(const FormRegression& regression, const Form& plain) {
  std::vector<Form> forms;
  const double size = size_of(regression, plain);
  const Rate rate = rate_of(regression, plain);
  double period = HUGE_VAL;
  for (const Experiment& experiment : regression.problem().data.experiments) {
    period = std::min(period, experiment.period);
  }
  if (!(size > 0.0) || !(rate.largest > 0.0) || is_of_time(plain)) {
    return forms;
  }
  const auto add = [&](Memory kind, auto&& set) {
    Form form = plain;
    form.memory.kind = kind;
    set(form.memory);
    forms.push_back(std::move(form));
  };
  const double servo = regression.problem().scales.time;
  for (double time = 2.0 * period; time < kLongestDelay * servo; time += kDelayStep * servo) {
    add(Memory::delay, [&](auto& memory) { memory.time = time; });
  }
  for (const double time : comb(2.0 * period, kLongestLag * servo, 10)) {
    add(Memory::lag, [&](auto& memory) { memory.time = time; });
  }
  for (const double time : comb(2.0 * period, kLongestWashout * servo, 7)) {
    add(Memory::washout, [&](auto& memory) { memory.time = time; });
  }
  for (const Memory kind : {Memory::resonance, Memory::band_pass}) {
    for (const double frequency : comb(kSlowestCycles / servo, kFastestCycles / servo, 12)) {
      for (const double damping : {0.15, 0.5}) {
        add(kind, [&](auto& memory) {
          memory.frequency = frequency;
          memory.damping = damping;
        });
      }
    }
  }
  for (const double width : comb(0.03, 1.0, 7)) {
    add(Memory::quantise, [&](auto& memory) { memory.width = width * size; });
  }
  add_plays_and_slews(plain, size, rate, forms);
  // Two periods are separated by a quarter of it at the ends of the argument's range.
  const int finest = is_replaced(plain) ? kFinestQuantum : kFinestRipple;
  for (int quarters = 3; quarters <= finest; ++quarters) {
    add(Memory::periodic, [&](auto& memory) { memory.width = 8.0 * size / quarters; });
  }
  std::ranges::move(with_holds(regression, plain), std::back_inserter(forms));
  Form stops = plain;
  stops.memory.kind = Memory::stops;
  for (const double width : kStopWidths) {
    stops.points.push_back(width * size);
  }
  forms.push_back(std::move(stops));
  return forms;
}

std::vector<Form> with_powers(const FormRegression& regression, const Form& plain) {
  std::vector<Form> forms;
  const double size = size_of(regression, plain);
  // A square is a power itself, and a power of time does not end with the records.
  if (size > 0.0 && plain.factor != plain.argument && !is_of_time(plain)) {
    for (const Memory kind : {Memory::odd_power, Memory::even_power}) {
      for (const double exponent : comb(kLeastExponent, kMostExponent, kPowers)) {
        Form form = plain;
        form.memory.kind = kind;
        form.memory.width = size;
        form.memory.exponent = exponent;
        forms.push_back(std::move(form));
      }
    }
  }
  return forms;
}

std::vector<Form> with_kinks(const FormRegression& regression, const Form& plain) {
  std::vector<Form> forms;
  const double size = size_of(regression, plain);
  if (size > 0.0) {
    for (const double width : comb(kNarrowestKink, 1.0, kKinks)) {
      Form form = plain;
      form.memory.kind = Memory::saturation;
      form.memory.width = width * size;
      forms.push_back(std::move(form));
    }
  }
  return forms;
}

std::optional<Form> with_curve(const FormRegression& regression, Form form, bool curve_first) {
  if (!bears_curve(form.memory.kind, curve_first)) {
    return std::nullopt;
  }
  form.curve_first = curve_first;
  form.points = curve_first && form.memory.kind != Memory::none
                    ? spread_points(sorted_values(regression, form), kCurvePoints)
                    : followed_points(regression, form);
  return form.points.size() >= kFewestPoints ? std::optional(std::move(form)) : std::nullopt;
}

std::vector<Form> with_rough_curves(const FormRegression& regression, const std::vector<Form>& plain_or_remembering) {
  std::vector<Form> forms;
  std::map<std::pair<Argument, std::optional<Argument>>, std::vector<double>> points;
  for (Form form : plain_or_remembering) {
    if (form.memory.kind == Memory::none || (form.is_filter() && !form.factor)) {
      const auto [own, is_new] = points.try_emplace({form.argument, form.factor});
      if (is_new) {
        own->second = spread_points(sorted_values(regression, form), kRoughPoints);
      }
      form.curve_first = form.memory.kind != Memory::none;
      form.points = own->second;
      forms.push_back(std::move(form));
    }
  }
  std::erase_if(forms, [](const Form& form) { return form.points.size() < kFewestPoints; });
  return forms;
}

std::vector<Form> behind_curve(const FormRegression& regression, const Form& curve, const Eigen::VectorXd& values) {
  std::vector<Form> forms;
  Form front = curve;
  // About its middle: what a play or a stop makes of a constant is that constant or nothing.
  const double middle = 0.5 * (values.minCoeff() + values.maxCoeff());
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    front.values.push_back(values(i) - middle);
  }
  front.curve_first = true;
  const double size = size_of(regression, front);
  const Rate rate = rate_of(regression, front);
  if (size > 0.0 && rate.largest > 0.0) {
    add_plays_and_slews(front, size, rate, forms);
  }
  return forms;
}

}  // namespace hotfire::explain
