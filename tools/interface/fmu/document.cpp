// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <stdexcept>

#include "tools/interface/fmu/slave.hpp"

namespace hotfire::fmu {

std::string plant_document(const std::string& resources) {
  if (kCompiledPlant != nullptr) {
    return kCompiledPlant;
  }
  const std::string path = resources + (resources.ends_with('/') ? "" : "/") + "plant.txt";
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (!file) {
    throw std::runtime_error(path + ": cannot be read; give the path of the FMU's folder resources/");
  }
  std::string text;
  std::array<char, 16384> piece{};
  for (std::size_t read = piece.size(); read == piece.size();) {
    read = std::fread(piece.data(), 1, piece.size(), file.get());
    text.append(piece.data(), read);
  }
  return text;
}

std::string path_of_uri(const std::string& uri) {
  constexpr std::string_view kScheme = "file:";
  if (!uri.starts_with(kScheme)) {
    throw std::runtime_error(uri + ": not a file URI; allowed: file:///path/of/resources");
  }
  std::string_view rest = std::string_view(uri).substr(kScheme.size());
  if (rest.starts_with("//")) {
    // The part before the path is the machine: none, or this one.
    rest.remove_prefix(2);
    rest.remove_prefix(rest.starts_with("localhost/") ? std::string_view("localhost").size() : 0);
  }
  std::string path;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    if (rest[i] == '%' && i + 2 < rest.size()) {
      const std::string digits(rest.substr(i + 1, 2));
      path += static_cast<char>(std::strtol(digits.c_str(), nullptr, 16));
      i += 2;
    } else {
      path += rest[i];
    }
  }
  return path;
}

}  // namespace hotfire::fmu
