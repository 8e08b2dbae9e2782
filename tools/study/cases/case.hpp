// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/files/record/record.hpp"
#include "tools/study/cases/condition.hpp"
#include "tools/study/cases/effects.hpp"

namespace hotfire::study {

/// An effect of an engine with two axes that is in no list: a hose that pulls across them once it is taut.
inline constexpr std::string_view kCrossHose = "cross_hose";
/// An effect of one axis that is drawn at random (wild_draw.hpp).
inline constexpr std::string_view kWild = "wild";

/// What a case is to be.
struct CaseOrder {
  std::string name;                  ///< of its folder
  std::vector<std::string> effects;  ///< what is missing in the declared model; none: a null record
  std::uint64_t seed = 1;
  double noise_factor = 1.0;    ///< on the sensors' noise, true and declared alike
  double scatter_factor = 1.0;  ///< on the tolerances within which the true parameters are scattered
  bool two_axes = false;        ///< an engine with two; effects then end with their axis, "cross_axis.pitch"
  std::string condition{};      ///< of the given records, one of `hard_conditions()`; empty: the usual
};

/// A case as it is made: what the finder is given, and what is kept from it.
struct StudyCase {
  CaseOrder order;
  Plan plan;                         ///< of the axis, or of pitch; `values` and `law` are those of both
  std::optional<ReferenceAxis> yaw;  ///< the other axis, if there are two
  std::string declared;              ///< declared.toml
  std::string truth;                 ///< the same with the true values and effects; empty if the model has no keys for them
  std::vector<Record> given;         ///< with sensor noise and quantisation
  std::vector<std::string> exclusions;        ///< stretches of them that the user knows to be wrong, "steps.csv@3.0-3.5"
  Record unseen;                              ///< noise-free, for scoring
  std::map<std::string, double> effect_size;  ///< rms that the effects alone make on `unseen`, in sensor noise, by channel
                                              ///< ("piston", or "piston.pitch" of two axes)
};

/// Sensor noise (rms) and quantum of a channel, at a noise factor of one.
struct SensorGrade {
  const char* channel = "";
  const char* unit = "";
  double noise = 0.0;
  double quantum = 0.0;  ///< 0: not quantised
};
inline constexpr std::array<SensorGrade, 3> kSensorGrades{SensorGrade{"piston", "m", 8e-6, 5e-6},
                                                          SensorGrade{"engine", "rad", 6e-5, 2e-5},
                                                          SensorGrade{"load_pressure", "Pa", 8e3, 0.0}};

/// An effect alone must show at least at this many times the sensor noise in one channel, and at most at `kLargestEffect`.
inline constexpr double kSmallestEffect = 5.0;
inline constexpr double kLargestEffect = 150.0;

/// Makes a case. The same order gives the same bits. Three records are given, unless its condition says otherwise, and one
/// is kept, each from equilibrium; every third case, by its seed, measures the load pressure as well. The axes of an engine
/// with two are scattered and driven each in its own way, at the same time. Throws std::runtime_error if no magnitude of an
/// effect shows as above in twelve draws.
StudyCase make_case(const CaseOrder& order);

/// Writes a case as FOLDER/given/declared.toml, a file for each given record (sweep.csv, steps.csv and ramps.csv) and
/// FOLDER/kept/{truth.json,score_noisefree.csv}, and
/// kept/true.toml if the model has keys for what is missing.
void write_case(const StudyCase& made, const std::filesystem::path& folder);

}  // namespace hotfire::study
