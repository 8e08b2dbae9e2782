// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace hotfire::study {

/// Where a drawn law enters the reference axis, and what it adds there.
enum class WildSite {
  command,        ///< to the command [rad]
  valve_command,  ///< to what the torque motor asks for, before it saturates [1]
  valve,          ///< to the opening [1]
  flow,           ///< to the flow into the extend chamber [m^3/s]
  pressure,       ///< to the rate of the load pressure [Pa/s]
  piston,         ///< to the force on the piston [N]
  load_spring,    ///< to the deflection of the load spring [m]
  engine_torque,  ///< to the torque on the engine [N m]
  piston_sensor,  ///< to the reading of the piston [m]
  engine_sensor,  ///< to the reading of the engine [rad]
};
inline constexpr std::size_t kWildSites = 10;

/// What a drawn law is a law of. None of them holds what the law itself adds in the same instant.
enum class WildArgument {
  position,
  rate,
  angle,
  angle_rate,
  pressure,
  flow,
  deflection,
  spool,
  command,
  error,
  valve_command,
  time
};
inline constexpr std::size_t kWildArguments = 12;
using WildQuantities = std::array<double, kWildArguments>;

/// A curve over a pure number, zero at zero.
struct WildCurve {
  enum class Shape {
    line,
    waves,       ///< sum of a sin(w s) + b (1 - cos(w s)); parts are (a, b, w)
    bumps,       ///< sum of h (e^{-((s - m) / b)^2} - e^{-(m / b)^2}); parts are (h, m, b)
    odd_power,   ///< sgn(s) |s|^p; parts are (p)
    even_power,  ///< |s|^p
    saturation,  ///< b tanh(s / b); parts are (b)
    dead_zone,   ///< what lies beyond +-b
    one_sided,   ///< ln((1 + e^{k (s - c)}) / (1 + e^{-k c})) / k; parts are (k, c)
    ripple,      ///< sin(w s + p) - sin(p); parts are (w, p)
    stairs,      ///< s rounded to multiples of q, by risers of `kRiser` q; parts are (q)
  };
  static constexpr double kRiser = 0.05;  ///< a step of no width stops an integrator where a signal rests on it

  Shape shape = Shape::line;
  double height = 1.0;
  std::vector<std::array<double, 3>> parts{};

  double operator()(double s) const;
};

/// What a drawn law remembers of its input.
struct WildMemory {
  enum class Kind {
    none,
    delay,           ///< by `time`, between rows by a cubic
    first_order,     ///< time constant `time`
    washout,         ///< input less that
    second_order,    ///< `frequency` [Hz], `damping`
    band_pass,       ///< 2 damping y' / w of that
    plays,           ///< sum of weight x play of a radius
    stops,           ///< sum of weight x (input less its play): Prandtl and Ishlinskii
    rate_limit,      ///< follows at `limit` per second at most
    hold,            ///< of every `rows`-th row
    leaky_integral,  ///< time constant `time`, long against the motion; its gain at rest is `time`
    swing,           ///< sin of a phase that moves at `frequency` + `damping` x frequency x tanh(input) [Hz]
  };
  /// Rate at which a play's output follows beyond its radius, and a rate limiter's below its limit [1/s]: a tenth of a
  /// millisecond, a fiftieth of a row, behind.
  static constexpr double kFollows = 1e4;
  static constexpr std::size_t kMostStates = 4;

  Kind kind = Kind::none;
  double time = 0.0;       ///< [s]
  double frequency = 0.0;  ///< [Hz]
  double damping = 0.0;
  double limit = 0.0;  ///< [1/s]
  int rows = 0;
  std::vector<std::array<double, 2>> plays{};  ///< radius, weight

  std::size_t states() const;
};

/// A law that is drawn at random, `amplitude` x curve and memory, in either order, of argument / scale (or of a product of
/// two arguments over a scale). It is added at its site; a law of what its site transmits replaces that: it adds amplitude x
/// (output - input). Written apart from the effects of the model.
struct WildLaw {
  WildSite site = WildSite::command;
  WildArgument argument = WildArgument::command;
  std::optional<WildArgument> factor{};
  double scale = 1.0;
  WildMemory memory;
  WildCurve curve;
  bool curve_first = false;
  bool replaces = false;
  double amplitude = 0.0;  ///< in the site's unit

  /// Argument over scale.
  double signal(const WildQuantities& quantities) const;
};

using WildStates = std::array<double, WildMemory::kMostStates>;

/// What a law's memory holds that is not a state of an ordinary differential equation: the inputs at the rows.
class WildRows {
 public:
  /// A row begins, `start` seconds after the first one began.
  void begin_row(const WildLaw& law, double start, double input);
  /// Of the last row that `hold` took.
  double held() const { return held_; }
  /// Whether a row has begun; until then the axis rests.
  bool begun() const { return !inputs_.empty(); }
  /// The input a time before `elapsed`; that of the first row before it. The time is two rows or more.
  double delayed(double elapsed, double delay) const;

 private:
  std::vector<double> inputs_;
  double period_ = 0.0;
  double held_ = 0.0;
};

/// What enters the memory.
double memory_input(const WildLaw& law, double signal);

/// Rates of the memory's states.
WildStates memory_rates(const WildLaw& law, double input, const WildStates& y);

/// What a law adds at its site, `elapsed` s into the record.
double wild_output(const WildLaw& law, double signal, double elapsed, const WildStates& y, const WildRows& rows);

}  // namespace hotfire::study
