// SPDX-License-Identifier: Apache-2.0
// libFuzzer harness of the reader of MATLAB files. The first byte of an input chooses the column that is read.
//
// The product reads each file in a process of its own, and the fork takes longer than the reading. The harness checks the
// layout of each input in this process. It collects the inputs whose layout is accepted and reads a batch of them in one
// process. That process may crash, or go beyond a limit. Then the input that it was reading is read again as the product
// reads it, and another process reads the rest.

#include <sys/mman.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <string>
#include <string_view>
#include <vector>

#include "tests/fuzz/input_file.hpp"
#include "tools/files/exchange/apart.hpp"
#include "tools/files/import/import.hpp"
#include "tools/files/import/matlab_layout.hpp"
#include "tools/files/import/matlab_reader.hpp"

namespace {

using namespace hotfire;

class Batch {
 public:
  Batch() {
    void* shared = mmap(nullptr, sizeof *next_, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (shared == MAP_FAILED) {
      std::perror("mmap");
      std::exit(1);
    }
    next_ = new (shared) std::size_t{0};
  }
  Batch(const Batch&) = delete;
  Batch& operator=(const Batch&) = delete;
  Batch(Batch&&) = delete;
  Batch& operator=(Batch&&) = delete;
  ~Batch() { read(); }

  void check(std::uint8_t wanted, std::string_view content) {
    const std::string& path = file_.holding(content);
    fuzz::read_or_refuse([&] {
      require_matlab_layout(path);
      inputs_.push_back({wanted, std::string(content)});
    });
    if (inputs_.size() == kInputs) {
      read();
    }
  }

 private:
  struct Input {
    std::uint8_t wanted;
    std::string content;
  };
  static constexpr std::size_t kInputs = 32;

  static ImportMap map_of(std::uint8_t wanted) {
    static const std::array<const char*, 4> kColumns{"X", "X.beta", "X:2", "nothing"};
    ImportMap map;
    map.columns = {{"piston", kColumns.at(wanted % kColumns.size()), "m", 1.0, 1}};
    return map;
  }

  void read() {
    for (*next_ = 0; *next_ < inputs_.size(); ++*next_) {
      try {
        run_apart([this] { return read_rest_here(); }, limits_of_a_reader(0));
      } catch (const ApartError&) {
        const Input& input = inputs_.at(*next_);
        const std::string& path = file_.holding(input.content);
        fuzz::read_or_refuse([&] { read_matlab_columns(path, map_of(input.wanted)); });
      }
    }
    inputs_.clear();
  }

  std::string read_rest_here() {
    for (; *next_ < inputs_.size(); ++*next_) {
      const Input& input = inputs_[*next_];
      try {
        const std::string& path = file_.holding(input.content);
        fuzz::read_or_refuse([&] { matlab_columns_text(path, map_of(input.wanted)); });
      } catch (const std::bad_alloc&) {
        continue;
      }
    }
    return "";
  }

  fuzz::InputFile file_{"matlab"};
  std::vector<Input> inputs_;
  std::size_t* next_ = nullptr;  ///< index of the input that is read now, shared with the process that reads
};

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  static Batch batch;
  if (size > 0) {
    batch.check(bytes[0], fuzz::text_of(bytes + 1, size - 1));
  }
  return 0;
}
