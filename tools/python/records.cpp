// SPDX-License-Identifier: Apache-2.0
#include "tools/python/records.hpp"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <cmath>

#include "tools/files/record/record_channels.hpp"
#include "tools/files/text/csv_lines.hpp"
#include "tools/files/text/error.hpp"

namespace py = pybind11;

namespace hotfire::python {

namespace {

constexpr double kLeastRate = 50.0;     // Hz, as in a file
constexpr double kMostRate = 20'000.0;  // Hz

void require_rate(const Record& record) {
  const double rate = 1.0 / record.period;
  // Written so that NaN is refused as well.
  if (!(record.period > 0.0) || !(rate > kLeastRate * (1.0 - 1e-9) && rate < kMostRate * (1.0 + 1e-9))) {
    throw FileError(fmt::format("{}: period {:g} s; allowed: a rate of {:g} Hz to {:g} Hz", record.name, record.period,
                                kLeastRate, kMostRate));
  }
}

/// The values of a channel in SI.
std::vector<double> converted(const GivenChannel& given, const Column& column, const std::string& name) {
  const auto& values = std::get<2>(given);
  if (values.ndim() != 1) {
    throw FileError(fmt::format("{}: {}: an array of {} dimensions; allowed: one", name, column.name, values.ndim()));
  }
  std::vector<double> own(values.data(), values.data() + values.size());
  for (std::size_t row = 0; row < own.size(); ++row) {
    if (!std::isfinite(own[row])) {
      throw FileError(fmt::format("{}: {}, row {}: {} is not a finite number", name, column.name, row, own[row]));
    }
    own[row] = column.convert(own[row]);
  }
  return own;
}

/// A channel's values without a copy: an array that keeps the record alive and cannot be written to.
py::array_t<double> values_of(const py::object& owner, const Channel& channel) {
  py::array_t<double> view(static_cast<py::ssize_t>(channel.values.size()), channel.values.data(), owner);
  view.attr("setflags")(py::arg("write") = false);
  return view;
}

const Channel& channel_of(const Record& record, const std::string& name) {
  const Channel* channel = record.find(name);
  if (channel == nullptr) {
    std::string has;
    for (const Channel& own : record.channels) {
      has += (has.empty() ? "" : ", ") + own.name;
    }
    throw py::key_error(fmt::format("{}: no channel {}; the record has {}", record.name, name, has));
  }
  return *channel;
}

py::array_t<double> time_of(const Record& record) {
  const std::vector<double> times = times_of(record);
  return py::array_t<double>(static_cast<py::ssize_t>(times.size()), times.data());
}

}  // namespace

Record record_of(const std::vector<GivenChannel>& channels, double start, double period, const std::string& name) {
  std::string header = "time[s]";
  for (const GivenChannel& channel : channels) {
    header += fmt::format(",{}[{}]", std::get<0>(channel), std::get<1>(channel));
  }
  CsvLines lines(header, name);
  std::string_view line;
  lines.next(line);
  const std::vector<Column> columns = read_header(lines, line);
  Record record{name, name, start, period, static_cast<std::size_t>(std::get<2>(channels.front()).size()), {}};
  require_rate(record);
  if (record.rows < 2 || record.rows > kMostRows) {
    throw FileError(fmt::format("{}: {} rows; allowed: 2 to {}", name, record.rows, kMostRows));
  }
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const Column& column = columns[i + 1];
    std::vector<double> values = converted(channels[i], column, name);
    if (values.size() != record.rows) {
      throw FileError(fmt::format("{}: {} has {} rows, {} has {}; allowed: the same number", name, column.name,
                                  values.size(), columns[1].name, record.rows));
    }
    record.channels.push_back({column.name, column.unit, std::move(values)});
  }
  return record;
}

void add_records(py::module_& module) {
  py::class_<Record>(module, "Record")
      .def_static(
          "load", [](const std::filesystem::path& path) { return load_record(path); }, py::arg("path"))
      .def_static("from_channels", &record_of, py::arg("channels"), py::arg("start"), py::arg("period"), py::arg("name"))
      .def(
          "save", [](const Record& record, const std::filesystem::path& path) { write_record(record, path); },
          py::arg("path"))
      .def_readonly("name", &Record::name)
      .def_property_readonly("path", [](const Record& record) { return record.path.string(); })
      .def_readonly("start", &Record::start)
      .def_readonly("period", &Record::period)
      .def_property_readonly("time", &time_of)
      .def("__len__", [](const Record& record) { return record.rows; })
      .def("channel_names",
           [](const Record& record) {
             std::vector<std::string> names(record.channels.size());
             std::transform(record.channels.begin(), record.channels.end(), names.begin(),
                            [](const Channel& channel) { return channel.name; });
             return names;
           })
      .def("unit_of", [](const Record& record, const std::string& name) { return channel_of(record, name).unit; })
      .def("values_of", [](const py::object& self, const std::string& name) {
        return values_of(self, channel_of(self.cast<const Record&>(), name));
      });
}

}  // namespace hotfire::python
