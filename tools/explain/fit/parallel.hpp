// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

namespace hotfire::explain {

/// Calls `f(i)` for i in [0, count) on up to `threads` threads; each i once, in no fixed order. `f` must not throw.
template <class F>
void parallel_for(std::size_t count, unsigned threads, F&& f) {
  if (threads <= 1 || count <= 1) {
    for (std::size_t i = 0; i < count; ++i) {
      f(i);
    }
    return;
  }
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      f(i);
    }
  };
  std::vector<std::jthread> helpers;
  for (unsigned t = 1; t < threads && t < count; ++t) {
    helpers.emplace_back(work);
  }
  work();
}

}  // namespace hotfire::explain
