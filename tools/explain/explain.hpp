// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/explain/experiment/next_experiment.hpp"
#include "tools/explain/refine/screening.hpp"
#include "tools/explain/result/result.hpp"
#include "tools/files/model/model_file.hpp"
#include "tools/files/record/record.hpp"
#include "tools/report/report_page.hpp"
#include "tools/structure/vehicle_file.hpp"

namespace hotfire::explain {

/// What the finder hands out.
struct Explanation {
  Result result;        ///< `report_json` writes it as report.json
  ReportSeries series;  ///< what the page draws
  ModelFile model;      ///< the explained model without faults of the records: what the rig runs next
  /// The test that would best separate a kept effect from its rival, if they explain these records equally well.
  std::optional<NextExperiment> next_experiment;
};

struct ExplainOptions {
  unsigned threads = 1;
  int most_effects = 4;  ///< to add; 0: calibrate only
  Watch watch;
  std::vector<Exclusion> exclusions{};
  std::optional<CommandLimits> limits{};  ///< of the rig, for the next experiment; none: the records' largest command
  bool keep_drift = false;                ///< tables over a record's time go into the explained model
  std::vector<Record> kept_back{};        ///< whole records that no fit and no choice is to see: judged at the end
};

/// Closes the loop: calibrates the declared model within its tolerances, traces what is left, adds the effects that the data
/// support, and judges all of it on data that no fit has seen. Throws FileError if a record does not suit the model.
Explanation explain(const ModelFile& model, const std::vector<Record>& records, const ExplainOptions& options);

/// What the finder hands out for a model of several axes.
struct VehicleExplanation {
  Result result;
  ReportSeries series;
  VehicleFile model;
};

/// The same for a `taos` or `masv` model and records with channels of its axes, `command.pitch`, `piston.yaw3`. Each axis is
/// explained beside the motion of all others. The measured motion of the other axis of its engine enters where the two are
/// coupled: the geometry of the attach points and `cross_axis`. The motion of structure and bearings is that of the whole
/// model. What is reported is what the model of all axes together leaves. An axis of which nothing is measured is simulated
/// and not explained. Throws FileError for what cannot be explained: a bearing with friction or vibration, the lag of the
/// pistons' potentiometers.
VehicleExplanation explain(const VehicleFile& model, const std::vector<Record>& records, const ExplainOptions& options);

}  // namespace hotfire::explain
