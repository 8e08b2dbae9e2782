// SPDX-License-Identifier: Apache-2.0
#include "tools/python/explaining.hpp"

#include <pybind11/functional.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <atomic>
#include <exception>
#include <mutex>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "tools/explain/explain.hpp"
#include "tools/explain/report/report_json.hpp"
#include "tools/files/text/sha256.hpp"
#include "tools/python/models.hpp"

namespace py = pybind11;

namespace hotfire::python {

namespace {

/// What a run leaves behind, of a model of one axis or of two.
struct Found {
  explain::Result result;
  ReportSeries series;
  Model model;
  std::optional<explain::NextExperiment> next_experiment;
};

Found find(const Model& model, const std::vector<Record>& records, const explain::ExplainOptions& options) {
  if (const auto* vehicle = std::get_if<VehicleFile>(&model.file)) {
    explain::VehicleExplanation found = explain::explain(*vehicle, records, options);
    return {std::move(found.result), std::move(found.series), {std::move(found.model)}, std::nullopt};
  }
  explain::Explanation found = explain::explain(std::get<ModelFile>(model.file), records, options);
  return {std::move(found.result), std::move(found.series), {std::move(found.model)}, std::move(found.next_experiment)};
}

/// Lets Python watch a run that works without its lock: hands on what is looked at, and ends the run at Ctrl-C or at an
/// exception of the callback, which is kept for the end.
class Watcher {
 public:
  explicit Watcher(py::object progress) : progress_(std::move(progress)) {}

  explain::Watch watch() {
    return {[this](const explain::Doing& doing) { say(doing.what); }, [this] { return is_interrupted(); }};
  }

  bool was_interrupted() const { return interrupted_; }

  /// The exception of the callback, or of the handler of a signal.
  const std::optional<py::error_already_set>& exception() const { return exception_; }

 private:
  void say(const std::string& what) {
    const py::gil_scoped_acquire locked;
    if (progress_.is_none() || interrupted_) {
      return;
    }
    try {
      progress_(what);
    } catch (const py::error_already_set& error) {
      keep(error);
    }
  }

  /// Python runs the handler of a signal on its main thread only, and only when it is asked to.
  bool is_interrupted() {
    if (!interrupted_) {
      const py::gil_scoped_acquire locked;
      if (PyErr_CheckSignals() != 0) {
        keep(py::error_already_set());
      }
    }
    return interrupted_;
  }

  void keep(const py::error_already_set& error) {
    if (!exception_) {
      exception_.emplace(error);
    }
    interrupted_ = true;
  }

  py::object progress_;
  std::atomic<bool> interrupted_ = false;
  std::optional<py::error_already_set> exception_;
};

}  // namespace

void add_explaining(py::module_& module) {
  [[maybe_unused]] const py::class_<ReportSeries> series_class(module, "ReportSeries");
  module.def(
      "explain",
      [](const Model& model, const std::vector<Record>& records, const std::vector<Record>& hold_out, unsigned threads,
         int most_effects, const std::vector<std::string>& exclude, py::object progress) {
        explain::ExplainOptions options;
        options.threads = threads;
        options.most_effects = most_effects;
        options.kept_back = hold_out;
        for (const std::string& text : exclude) {
          options.exclusions.push_back(explain::exclusion_from(text));
        }
        Watcher watcher(std::move(progress));
        options.watch = watcher.watch();
        Found found = [&] {
          const py::gil_scoped_release released;
          return find(model, records, options);
        }();
        const py::object raised = watcher.exception() ? watcher.exception()->value() : py::object(py::none());
        const py::object next =
            found.next_experiment ? py::cast(std::move(found.next_experiment->command)) : py::object(py::none());
        return py::make_tuple(explain::report_json(found.result).dump(), std::move(found.series), std::move(found.model),
                              next, raised);
      },
      py::arg("model"), py::arg("records"), py::arg("hold_out"), py::arg("threads"), py::arg("most_effects"),
      py::arg("exclude"), py::arg("progress"));
  module.def(
      "report_page",
      [](const std::string& report, const ReportSeries& series) {
        return report_page(nlohmann::json::parse(report), series);
      },
      py::arg("report"), py::arg("series"));
  module.def("sha256", &sha256_of, py::arg("path"));
}

}  // namespace hotfire::python
