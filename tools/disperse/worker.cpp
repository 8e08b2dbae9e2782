// SPDX-License-Identifier: Apache-2.0
#include "tools/disperse/worker.hpp"

#include <fmt/format.h>

#include <charconv>
#include <istream>
#include <ostream>

#include "tools/files/text/error.hpp"
#include "tools/files/text/private_folder.hpp"

namespace hotfire::disperse {

namespace {

constexpr std::size_t kMostDigits = 9;  // a line of a result is longer

int number_of(const std::string& line, int last) {
  int draw = -1;
  const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), draw);
  if (error != std::errc{} || end != line.data() + line.size() || draw < 0 || draw > last) {
    throw UsageError(
        fmt::format("'{}' on standard input: allowed: a draw from 0 to {}, a line of results, or report", line, last));
  }
  return draw;
}

}  // namespace

bool work(Dispersion& dispersion, const CommandRunner& run, const std::function<void(int, int)>& progress, std::istream& in,
          std::ostream& out) {
  const PrivateFolder scratch;
  DrawStore& store = dispersion.store();
  out << store.header() << dispersion.plan().draws;
  for (const auto& [draw, result] : store.results()) {
    out << ' ' << draw;
  }
  out << '\n' << std::flush;
  for (std::string line; std::getline(in, line);) {
    if (line == "report") {
      return true;
    }
    if (line.size() > kMostDigits) {
      store.merge_line(line, "a result of another worker");
    } else {
      const int draw = number_of(line, dispersion.plan().draws);
      dispersion.run(draw, run, scratch.path());
      out << store.line(draw) << std::flush;
    }
    progress(static_cast<int>(store.results().size()), dispersion.plan().draws + 1);
  }
  return false;
}

}  // namespace hotfire::disperse
