// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace hotfire {

/// The draws of a job, of which each rank takes the next block when it has done the last. A block has a share of what is
/// left, so blocks become smaller and all ranks end together (guided self-scheduling [Polychronopoulos and Kuck 1987, IEEE
/// Trans. Comput. 36, 1425-1439]).
class DrawsAtHand {
 public:
  /// Draws 0 to `last`.
  DrawsAtHand(int last, int ranks) : done_(static_cast<std::size_t>(last) + 1, false), ranks_(ranks) {
    stored_.resize(static_cast<std::size_t>(ranks));
  }

  /// Results of these draws are on the disk of a rank. Those of rank 0 are no longer needed; others hand theirs over before
  /// they run draws. To be called for all ranks, rank 0 first, before draws are taken.
  void has(int rank, const std::vector<int>& draws) {
    for (const int draw : draws) {
      if (!done_.at(static_cast<std::size_t>(draw))) {
        done_[static_cast<std::size_t>(draw)] = true;
        if (rank != 0) {
          stored_[static_cast<std::size_t>(rank)].push_back(draw);
        }
      }
    }
  }

  /// The next draws of a rank; none if all are taken.
  std::vector<int> take(int rank) {
    std::vector<int> block;
    block.swap(stored_[static_cast<std::size_t>(rank)]);
    if (!block.empty()) {
      return block;
    }
    const auto left = std::count(done_.begin() + next_, done_.end(), false);
    const auto size = static_cast<std::size_t>((left + kBlocks * ranks_ - 1) / (kBlocks * ranks_));
    for (; block.size() < size; ++next_) {
      if (!done_[static_cast<std::size_t>(next_)]) {
        block.push_back(next_);
      }
    }
    return block;
  }

 private:
  /// A block is this part of a rank's even share of what is left: a rank that is slowed down by this factor ends its first
  /// block when the others end all.
  static constexpr int kBlocks = 4;

  std::vector<bool> done_;
  int ranks_;
  std::vector<std::vector<int>> stored_{};  ///< by rank: what rank 0 has not
  int next_ = 0;
};

}  // namespace hotfire
