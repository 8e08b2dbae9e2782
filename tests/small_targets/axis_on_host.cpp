// SPDX-License-Identifier: Apache-2.0
// The host's side of the example for a Cortex-M7: writes its commands, and compares what the target makes of them.
//   axis_on_host commands FILE
//   axis_on_host readings float|double FILE      this machine's, as the target writes them
//   axis_on_host compare float|double FILE

#include <axis.hpp>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include "hal/arithmetic/denormals.hpp"

namespace hotfire::test {
namespace {

constexpr std::size_t kRows = 60'000;  ///< 60 s
constexpr std::size_t kEngine = 1;

template <class Real>
using Row = std::array<Real, example::kChannels>;

/// 60 s that stick, slip and saturate the valve: sines of a large and of a small angle, slow ramps, steps, and rest. The
/// values are floats, so that every scalar of the model is given the same command.
std::vector<float> commands() {
  std::vector<float> rows(kRows);
  for (std::size_t i = 0; i < kRows; ++i) {
    const double t = 1e-3 * static_cast<double>(i);
    double command = 0.0;
    if (t < 20.0) {
      command = 0.03 * std::sin(2.0 * t) + 0.004 * std::sin(17.0 * t);
    } else if (t < 30.0) {
      command = 5e-4 * std::sin(3.0 * t);
    } else if (t < 40.0) {
      command = 2e-3 * (t - 30.0);
    } else if (t < 55.0) {
      command = std::fmod(t, 5.0) < 2.5 ? 0.04 : -0.02;
    }
    rows[i] = static_cast<float>(command);
  }
  return rows;
}

template <class T>
bool write_all(const std::string& path, std::span<const T> values) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(values.data()), static_cast<std::streamsize>(values.size_bytes()));
  return file.good();
}

template <class T>
std::vector<T> read_all(const std::string& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  std::vector<T> values(file ? static_cast<std::size_t>(file.tellg()) / sizeof(T) : 0);
  file.seekg(0);
  file.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(values.size() * sizeof(T)));
  return values;
}

template <class Real>
std::vector<Row<Real>> simulated() {
  const hal::FlushDenormals flush;
  const example::Axis<Real> axis(example::kAxis<Real>, example::kStep);
  const std::vector<float> input = commands();
  typename example::Axis<Real>::State state = axis.steady(Real(input.front()));
  std::vector<Row<Real>> rows;
  for (const float command : input) {
    rows.push_back(example::Axis<Real>::measured(state));
    for (std::size_t i = 0; i < example::kStepsPerRow; ++i) {
      axis.step(state, Real(command));
    }
  }
  return rows;
}

/// What one run differs from another in a channel: rms over the rms of the channel in the second.
template <class A, class B>
double difference(const std::vector<Row<A>>& one, const std::vector<Row<B>>& other, std::size_t channel) {
  double square = 0.0;
  double signal = 0.0;
  for (std::size_t i = 0; i < other.size(); ++i) {
    const auto reference = static_cast<double>(other[i][channel]);
    const double error = static_cast<double>(one[i][channel]) - reference;
    square += error * error;
    signal += reference * reference;
  }
  return std::sqrt(square / signal);
}

template <class Real>
std::size_t different_rows(const std::vector<Row<Real>>& one, const std::vector<Row<Real>>& other) {
  std::size_t different = 0;
  for (std::size_t i = 0; i < other.size(); ++i) {
    different += one[i] == other[i] ? 0 : 1;
  }
  return different;
}

/// True if a figure is below its bound; prints both.
bool below(const char* what, double figure, double bound) {
  std::printf("%s: %.3g of the engine's rms, bound %.3g\n", what, figure, bound);
  return figure < bound;
}

/// The target's figures. All of its operations round as the host's do; only the C library's exp and log are another's, and
/// may differ in their last digit: glibc's own variants for processors with and without fused multiply-add leave 7e-16 in
/// double and nothing in float. A compiler that contracts operations leaves 7e-14 in double and 2e-6 in float.
template <class Real>
int compare(const std::string& path, double bound_of_libraries) {
  const auto target = read_all<Row<Real>>(path);
  if (target.size() != kRows) {
    std::printf("%s has %zu rows, not %zu\n", path.c_str(), target.size(), kRows);
    return 1;
  }
  const std::vector<Row<Real>> host = simulated<Real>();
  std::printf("rows that differ from the host's: %zu of %zu\n", different_rows<Real>(target, host), kRows);
  bool good = below("target against the host, same scalar", difference(target, host, kEngine), bound_of_libraries);
  good = below("target against the host in double", difference(target, simulated<double>(), kEngine), 1e-4) && good;
  return good ? 0 : 1;
}

template <class Real>
int write_readings(const std::string& path) {
  return write_all(path, std::span<const Row<Real>>(simulated<Real>())) ? 0 : 1;
}

int run(std::span<char*> words) {
  const std::vector<std::string> given(words.begin() + 1, words.end());
  if (given.size() == 2 && given[0] == "commands") {
    return write_all(given[1], std::span<const float>(commands())) ? 0 : 1;
  }
  if (given.size() == 3 && given[0] == "readings") {
    return given[1] == "float" ? write_readings<float>(given[2]) : write_readings<double>(given[2]);
  }
  if (given.size() == 3 && given[0] == "compare") {
    return given[1] == "float" ? compare<float>(given[2], 5e-7) : compare<double>(given[2], 1e-14);
  }
  std::printf("usage: axis_on_host commands FILE | axis_on_host readings|compare float|double FILE\n");
  return 2;
}

}  // namespace
}  // namespace hotfire::test

int main(int argc, char** argv) { return hotfire::test::run(std::span(argv, static_cast<std::size_t>(argc))); }
