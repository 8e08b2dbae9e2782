// SPDX-License-Identifier: Apache-2.0
#include "tests/nastran/write_op2.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <numbers>
#include <vector>

namespace hotfire::test {

namespace {

/// Writes words and records; written apart from the reader.
class Writer {
 public:
  explicit Writer(const Op2Layout& layout) : layout_(layout) {}

  template <class T>
  void put(std::string& text, T value) const {
    std::array<char, sizeof(T)> bytes{};
    std::memcpy(bytes.data(), &value, sizeof value);
    if (layout_.is_swapped) {
      std::reverse(bytes.begin(), bytes.end());
    }
    text.append(bytes.data(), bytes.size());
  }
  void put_integer(std::string& text, std::int64_t value) const {
    layout_.has_long_words ? put(text, value) : put(text, static_cast<std::int32_t>(value));
  }
  void put_real(std::string& text, double value) const {
    layout_.has_long_words ? put(text, value) : put(text, static_cast<float>(value));
  }

  void record(const std::string& content) {
    put(file_, static_cast<std::uint32_t>(content.size()));
    file_ += content;
    put(file_, static_cast<std::uint32_t>(content.size()));
  }
  void key(std::int64_t value) {
    std::string text;
    put_integer(text, value);
    record(text);
  }
  void data(const std::string& content) {
    key(static_cast<std::int64_t>(content.size() / (layout_.has_long_words ? 8 : 4)));
    record(content);
  }
  std::string letters(std::string text) const {
    text.resize(layout_.has_long_words ? 16 : 8, ' ');
    return text;
  }

  void label() {
    std::string date;
    for (const int part : {3, 3, 25}) {
      put_integer(date, part);
    }
    data(date);
    key(7);
    record(std::string("NASTRAN FORT TAPE ID CODE - ") + (layout_.has_long_words ? std::string(28, ' ') : ""));
    data(letters("XXXXXXXX"));
    key(-1);
    key(0);
  }
  void begin_block(const std::string& name, std::int64_t kind) {
    data(letters(name));
    key(-1);
    std::string trailer;
    for (int i = 0; i < 7; ++i) {
      put_integer(trailer, 101 + i);
    }
    data(trailer);
    key(-2);
    key(1);
    key(0);
    data(letters(name));
    key(-3);
    key(1);
    key(kind);
    records_ = 3;
  }
  void table_record(const std::string& content) {
    data(content);
    key(-++records_);
    key(1);
    key(0);
  }
  void end_block() { key(0); }
  std::string file() {
    key(0);
    return file_;
  }

 private:
  Op2Layout layout_;
  std::string file_;
  std::int64_t records_ = 0;
};

using Motion = std::array<double, 6>;

/// As the other files of the case have it; vectors are normalised to the generalised mass.
std::map<int, std::map<int, Motion>> motions() {
  return {{1, {{201, {1}}, {202, {1}}, {101, {1}}, {102, {1}}, {302, {1}}, {303, {1}}}},
          {2,
           {{101, {0, 0, 0, 0, 0.01, 0.02}},
            {102, {0, 0, 0, 0.3, 0.03, -0.01}},
            {201, {0.5}},
            {202, {0, 0, 0.5}},
            {302, {0.25, 0.1, 0.4}},
            {303, {0.1, 0.2, 0, 0, 0, 0.05}}}},
          {3, {{101, {0, 0, 0, 0, 0.08}}, {102, {}}, {201, {0, 0, 2}}, {202, {}}, {302, {}}, {303, {2}}}},
          {4, {{101, {}}, {102, {0, 0, 0, 0, 0, 0.5}}, {201, {}}, {202, {1}}, {302, {0, 0, 1}}, {303, {}}}},
          {5,
           {{101, {0, 0, 0, 0, -0.1, 0.1}},
            {102, {0, 0, 0, 0, 0.1, 0.1}},
            {201, {0.25, 0.5, 0.125}},
            {202, {0.25, 0.5, 0.125}},
            {302, {}},
            {303, {0, 0, 0, 0, 0, 1}}}}};
}

double eigenvalue(int mode) {
  const double w = 2.0 * std::numbers::pi * std::pow(2.0, mode - 1);
  return mode == 1 ? -1.2e-7 : w * w;
}

}  // namespace

std::string four_modes_op2(const Op2Layout& layout) {
  Writer writer(layout);
  writer.label();
  writer.begin_block("KAA", 1);
  for (int column = 0; column < 2; ++column) {
    std::string content;
    writer.put_integer(content, 1);
    writer.put_real(content, 2.5);
    writer.data(content);
    writer.key(-4 - column);
    writer.key(1);
    writer.key(column == 0 ? 1 : 0);
  }
  writer.end_block();
  writer.begin_block("CASECC", 0);
  writer.table_record(writer.letters("TEXT"));
  writer.end_block();

  writer.begin_block("LAMA", 0);
  std::string head;
  for (int word = 0; word < 146; ++word) {
    writer.put_integer(head, 0);
  }
  writer.table_record(head);
  std::string values;
  for (int mode = 1; mode <= 5; ++mode) {
    const double mass = mode == 3 ? 4.0 : 1.0;
    const double value = eigenvalue(mode);
    writer.put_integer(values, mode);
    writer.put_integer(values, mode);
    for (const double real :
         {value, std::sqrt(std::abs(value)), std::sqrt(std::abs(value)) / (2.0 * std::numbers::pi), mass, mass * value}) {
      writer.put_real(values, real);
    }
  }
  writer.table_record(values);
  writer.end_block();

  writer.begin_block(layout.in_basic_system ? "BOUGV1" : "OUGV1", 0);
  for (const auto& [mode, grids] : motions()) {
    head.clear();
    for (const int word : {21, 7, 0, 1, mode}) {
      writer.put_integer(head, word);
    }
    writer.put_real(head, eigenvalue(mode));
    writer.put_real(head, 0.0);
    for (const int word : {0, 1, 8}) {
      writer.put_integer(head, word);
    }
    for (int word = 10; word < 146; ++word) {
      writer.put_integer(head, 0);
    }
    writer.table_record(head);
    std::string rows;
    for (auto [grid, motion] : grids) {
      if (layout.in_basic_system && grid == 302) {
        motion = {motion[0], -motion[2], motion[1], motion[3], -motion[5], motion[4]};
      }
      writer.put_integer(rows, 10 * grid + 1);
      writer.put_integer(rows, 1);
      for (const double value : motion) {
        writer.put_real(rows, value);
      }
    }
    writer.table_record(rows);
  }
  writer.end_block();
  return writer.file();
}

}  // namespace hotfire::test
