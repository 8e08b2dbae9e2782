// SPDX-License-Identifier: Apache-2.0
#include "tools/files/exchange/hdf5.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <utility>

#include "tools/files/exchange/apart.hpp"
#include "tools/files/exchange/exact_integer.hpp"
#include "tools/files/text/error.hpp"
#include "tools/files/text/near_file.hpp"
#include "tools/files/text/whole_file.hpp"

namespace hotfire {

namespace {

constexpr const char* kUnitAttribute = "unit";
/// What other programs call it.
constexpr std::array<const char*, 4> kUnitAttributes{kUnitAttribute, "units", "Unit", "Units"};
constexpr const char* kTimeDataset = "time";
constexpr std::size_t kMostChannelBytes = std::size_t{4} << 30U;
/// Groups within groups, and datasets of a file: links may lead back to where they are.
constexpr int kMostGroupsWithin = 8;
constexpr std::size_t kMostDatasets = 10'000;

/// A handle of the library with the function that closes it.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Handle() {
    if (id_ >= 0) {
      close_(id_);
    }
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  hid_t id() const { return id_; }
  bool good() const { return id_ >= 0; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

void be_quiet() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

void put_text(std::string& bytes, std::string_view text) {
  const std::uint64_t size = text.size();
  bytes.append(reinterpret_cast<const char*>(&size), sizeof size);
  bytes += text;
}

std::string_view take_text(std::string_view& bytes) {
  std::uint64_t size = 0;
  if (bytes.size() >= sizeof size) {
    std::memcpy(&size, bytes.data(), sizeof size);
    bytes.remove_prefix(sizeof size);
  }
  const std::string_view text = bytes.substr(0, size);
  bytes.remove_prefix(text.size());
  return text;
}

std::string unit_of(hid_t dataset) {
  const auto* const name =
      std::ranges::find_if(kUnitAttributes, [dataset](const char* attribute) { return H5Aexists(dataset, attribute) > 0; });
  if (name == kUnitAttributes.end()) {
    return {};
  }
  const Handle attribute(H5Aopen(dataset, *name, H5P_DEFAULT), H5Aclose);
  const Handle type(H5Aget_type(attribute.id()), H5Tclose);
  if (H5Tget_class(type.id()) != H5T_STRING) {
    return {};
  }
  if (H5Tis_variable_str(type.id()) > 0) {
    char* text = nullptr;
    std::string unit;
    if (H5Aread(attribute.id(), type.id(), &text) >= 0 && text != nullptr) {
      unit = text;
      H5free_memory(text);
    }
    return unit;
  }
  constexpr std::size_t kMostLetters = 100;
  const std::size_t size = H5Tget_size(type.id());
  std::string text(std::min(size, kMostLetters), '\0');
  if (size > kMostLetters || H5Aread(attribute.id(), type.id(), text.data()) < 0) {
    return {};
  }
  return text.substr(0, text.find('\0'));
}

/// In the process of its own: group, name, unit, problem and values of every dataset, one after the other.
class Datasets {
 public:
  explicit Datasets(const std::filesystem::path& path) : path_(path) {}

  std::string text() {
    be_quiet();
    const Handle file(H5Fopen(path_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
    if (!file.good()) {
      throw FileError(fmt::format("{}: is not a readable HDF5 file", path_.string()));
    }
    add_group(file.id(), "", 0);
    return std::move(bytes_);
  }

 private:
  void add_group(hid_t group, const std::string& group_name, int nested) {
    H5G_info_t info{};
    H5Gget_info(group, &info);
    for (hsize_t i = 0; i < info.nlinks; ++i) {
      const ssize_t length = H5Lget_name_by_idx(group, ".", H5_INDEX_NAME, H5_ITER_INC, i, nullptr, 0, H5P_DEFAULT);
      std::string name(static_cast<std::size_t>(std::max<ssize_t>(length, 0)) + 1, '\0');
      H5Lget_name_by_idx(group, ".", H5_INDEX_NAME, H5_ITER_INC, i, name.data(), name.size(), H5P_DEFAULT);
      name.pop_back();
      const Handle object(H5Oopen(group, name.c_str(), H5P_DEFAULT), H5Oclose);
      const H5I_type_t kind = object.good() ? H5Iget_type(object.id()) : H5I_BADID;
      if (kind == H5I_GROUP && nested < kMostGroupsWithin) {
        add_group(object.id(), group_name.empty() ? name : fmt::format("{}/{}", group_name, name), nested + 1);
      } else if (kind == H5I_DATASET) {
        add_dataset(object.id(), group_name, name);
      }
    }
  }

  void add_dataset(hid_t dataset, const std::string& group_name, const std::string& name) {
    if (++count_ > kMostDatasets) {
      throw FileError(fmt::format("{}: more than {} datasets", path_.string(), kMostDatasets));
    }
    std::vector<double> values;
    const std::string problem = read(dataset, values);
    put_text(bytes_, group_name);
    put_text(bytes_, name);
    put_text(bytes_, unit_of(dataset));
    put_text(bytes_, problem);
    put_text(bytes_, {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double)});
  }

  /// Reads the values of a dataset. Returns the reason if they are not available.
  static std::string read(hid_t dataset, std::vector<double>& values) {
    const Handle space(H5Dget_space(dataset), H5Sclose);
    const Handle type(H5Dget_type(dataset), H5Tclose);
    const H5T_class_t kind = H5Tget_class(type.id());
    const hssize_t rows = H5Sget_simple_extent_npoints(space.id());
    // A column or a row of a matrix is a vector: all its other extents are 1.
    std::array<hsize_t, H5S_MAX_RANK> extents{};
    const int rank = H5Sget_simple_extent_dims(space.id(), extents.data(), nullptr);
    const bool is_vector = rank > 0 && std::ranges::count_if(extents, [](hsize_t extent) { return extent > 1; }) <= 1;
    if (!is_vector || (kind != H5T_FLOAT && kind != H5T_INTEGER)) {
      return "is not a vector of numbers; allowed: vectors of integers or floats, one for each channel";
    }
    if (rows < 0 || static_cast<std::size_t>(rows) > kMostRows) {
      return fmt::format("{} rows; allowed: up to {}", rows, kMostRows);
    }
    values.resize(static_cast<std::size_t>(rows));
    if (!values.empty() && H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) {
      values.clear();
      return "its values cannot be read; the file is damaged";
    }
    const auto is_large = [](double value) { return std::abs(value) >= static_cast<double>(kLargestExactInteger); };
    if (kind == H5T_INTEGER && std::ranges::any_of(values, is_large)) {
      values.clear();
      return "an integer of 2^53 or more, which a double may not hold";
    }
    return {};
  }

  const std::filesystem::path& path_;
  std::string bytes_;
  std::size_t count_ = 0;
};

/// Writes one dataset with its unit; false if the library could not.
bool put_dataset(hid_t file, const std::string& name, const std::string& unit, const std::vector<double>& values) {
  const hsize_t rows = values.size();
  const Handle space(H5Screate_simple(1, &rows, nullptr), H5Sclose);
  const Handle dataset(H5Dcreate2(file, name.c_str(), H5T_IEEE_F64LE, space.id(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                       H5Dclose);
  if (!dataset.good() || H5Dwrite(dataset.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) {
    return false;
  }
  const Handle text(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(text.id(), unit.size() + 1);
  const Handle one(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle attribute(H5Acreate2(dataset.id(), kUnitAttribute, text.id(), one.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  return attribute.good() && H5Awrite(attribute.id(), text.id(), unit.c_str()) >= 0;
}

}  // namespace

std::vector<ForeignGroup> read_hdf5(const std::filesystem::path& path) {
  if (!std::filesystem::is_regular_file(path)) {
    throw FileError(fmt::format("{}: is not a file{}; allowed: an HDF5 file", path.string(), near_file(path)));
  }
  std::string bytes;
  try {
    bytes = run_apart([&] { return Datasets(path).text(); }, limits_of_a_reader(kMostChannelBytes));
  } catch (const ApartError& error) {
    throw FileError(fmt::format("{}: cannot be read as an HDF5 file: {}; it is damaged", path.string(), error.what()));
  }
  std::vector<ForeignGroup> groups;
  for (std::string_view rest = bytes; !rest.empty();) {
    const std::string group(take_text(rest));
    const auto known = std::ranges::find(groups, group, &ForeignGroup::name);
    ForeignGroup& own = known == groups.end() ? groups.emplace_back(ForeignGroup{group, {}}) : *known;
    ForeignChannel& channel = own.channels.emplace_back();
    channel.name = take_text(rest);
    channel.unit = take_text(rest);
    channel.problem = take_text(rest);
    channel.is_time = channel.name == kTimeDataset;
    const std::string_view values = take_text(rest);
    channel.values.resize(values.size() / sizeof(double));
    if (!channel.values.empty()) {
      std::memcpy(channel.values.data(), values.data(), channel.values.size() * sizeof(double));
    }
  }
  return groups;
}

void write_hdf5(const Record& record, const std::filesystem::path& path) {
  be_quiet();
  write_whole_file_by(path, [&](const std::filesystem::path& temporary) {
    const Handle file(H5Fcreate(temporary.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
    bool good = file.good() && put_dataset(file.id(), kTimeDataset, "s", times_of(record));
    for (const Channel& channel : record.channels) {
      good = good && put_dataset(file.id(), channel.name, channel.unit, channel.values);
    }
    return good && H5Fflush(file.id(), H5F_SCOPE_LOCAL) >= 0;
  });
}

}  // namespace hotfire
