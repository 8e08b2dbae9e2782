// SPDX-License-Identifier: Apache-2.0
// Steps one axis through the commands of a file and writes what its sensors read, as a rig steps it between two frames of
// its bus. Counts what a step costs. `Real` is float or double.
#include <algorithm>
#include <array>
#include <cstdint>
#include <new>

#include "axis.hpp"
#include "board.hpp"

namespace {

using Real = HOTFIRE_REAL;
using Axis = example::Axis<Real>;

constexpr std::size_t kRowsAtOnce = 256;
std::array<float, kRowsAtOnce> commands;
std::array<std::array<Real, example::kChannels>, kRowsAtOnce> readings;

/// The instructions of a step.
struct Cost {
  std::uint32_t least = ~0U;
  std::uint32_t most = 0;
  std::uint64_t sum = 0;
  std::uint32_t steps = 0;

  void count(std::uint32_t instructions) {
    least = std::min(least, instructions);
    most = std::max(most, instructions);
    sum += instructions;
    ++steps;
  }
  std::uint32_t mean() const { return static_cast<std::uint32_t>((sum + steps / 2) / steps); }
};

void print(const char* name, std::size_t value) {
  board::print(name);
  board::print(" ");
  board::print(static_cast<std::uint32_t>(value));
  board::print("\n");
}

int refuse(const char* text) {
  board::print(text);
  return 1;
}

}  // namespace

int main() {
  const std::uint32_t began = board::now();
  static const Axis axis(example::kAxis<Real>, example::kStep);
  const std::uint32_t for_constants = board::instructions_since(began);

  board::HostFile in("commands.bin", board::HostFile::Mode::read);
  board::HostFile out("readings.bin", board::HostFile::Mode::write);
  if (!in.is_open() || !out.is_open()) {
    return refuse("commands.bin cannot be read, or readings.bin not be written\n");
  }

  static Axis::State state;
  Cost cost;
  std::uint32_t for_start = 0;
  std::size_t stack_of_start = 0;
  for (bool first = true;; first = false) {
    const std::size_t rows = in.read(std::as_writable_bytes(std::span(commands))) / sizeof(float);
    if (rows == 0) {
      break;
    }
    if (first) {
      const std::uint32_t before = board::now();
      state = axis.steady(Real(commands[0]));
      for_start = board::instructions_since(before);
      stack_of_start = board::deepest_stack();
      board::paint_stack();
    }
    for (std::size_t row = 0; row < rows; ++row) {
      readings[row] = Axis::measured(state);
      for (std::size_t i = 0; i < example::kStepsPerRow; ++i) {
        const std::uint32_t before = board::now();
        axis.step(state, Real(commands[row]));
        cost.count(board::instructions_since(before));
      }
    }
    if (!out.write(std::as_bytes(std::span(readings).first(rows)))) {
      return refuse("readings.bin cannot be written\n");
    }
  }
  if (cost.steps == 0) {
    return refuse("commands.bin holds no command\n");
  }

  print("steps", cost.steps);
  print("instructions_least", cost.least);
  print("instructions_mean", cost.mean());
  print("instructions_most", cost.most);
  print("instructions_constants", for_constants);
  print("instructions_start", for_start);
  print("flash", board::flash());
  print("ram", board::static_memory());
  print("ram_plant", sizeof axis);
  print("ram_state", sizeof state);
  print("stack_start", stack_of_start);
  print("stack_loop", board::deepest_stack());
  return 0;
}
