#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace hotfire::test {

/// A matrix, column by column.
struct MatlabMatrix {
  std::string name;
  std::size_t rows = 0;
  std::size_t columns = 0;
  std::vector<double> values;
};

/// A struct of one field, a column vector.
struct MatlabStruct {
  std::string name;
  std::string field;
  std::vector<double> values;
};

/// Writes a MATLAB 5 file.
void write_matlab(const std::filesystem::path& path, const std::vector<MatlabMatrix>& matrices,
                  const MatlabStruct& with_field);

}  // namespace hotfire::test
