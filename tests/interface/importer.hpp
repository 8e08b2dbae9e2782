// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <dlfcn.h>
#include <unistd.h>

#include <array>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <regex>
#include <string>
#include <vector>

#include "tests/interface/cases.hpp"
#include "tools/export/export_fmu.hpp"
#include "tools/interface/fmu/fmi2_types.hpp"
#include "tools/interface/fmu/fmi3_types.hpp"

#include <CppUTest/TestHarness.h>

namespace hotfire::test {

inline std::string content_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// A small importer: unpacks an FMU, reads names and references from its description, and loads its binary.
class Fmu {
 public:
  Fmu(const Case& own, int version) : Fmu(kept(own, version), version) {}

  /// An FMU that is unpacked in a folder of its name.
  Fmu(const std::filesystem::path& folder, int version) : version_(version), folder_(folder) {
    description_ = content_of(folder_ / "modelDescription.xml");
    const std::regex variable("name=\"([^\"]*)\" valueReference=\"([0-9]+)\"");
    for (std::sregex_iterator at(description_.begin(), description_.end(), variable), end; at != end; ++at) {
      references_[(*at)[1]] = static_cast<unsigned>(std::stoul((*at)[2]));
    }
    std::smatch token;
    CHECK(std::regex_search(description_, token, std::regex("(?:instantiationToken|guid)=\"([^\"]*)\"")));
    token_ = token[1];
    const std::string place = version == 3 ? "binaries/x86_64-linux/" : "binaries/linux64/";
    load(folder_ / (place + folder_.filename().string() + ".so"));
  }
  ~Fmu() { dlclose(library_); }
  Fmu(const Fmu&) = delete;
  Fmu& operator=(const Fmu&) = delete;

  /// The unpacked FMU of a case, which is exported once in a process: it is for tests that change none of its files.
  static std::filesystem::path kept(const Case& own, int version) {
    static const bool is_removed_at_exit = (remove_kept(), std::atexit(remove_kept) == 0);
    CHECK(is_removed_at_exit);
    const std::size_t model = std::hash<std::string>()(std::to_string(own.period) + own.text);
    const std::filesystem::path folder = kept_folder() / std::to_string(model);
    const std::filesystem::path place = folder / (own.topology + std::to_string(version));
    return std::filesystem::exists(place) ? place : unpacked(folder, own, version);
  }

  /// Exports a case, and unpacks it into a folder of its name.
  static std::filesystem::path unpacked(const std::filesystem::path& folder, const Case& own, int version) {
    const std::filesystem::path place = folder / (own.topology + std::to_string(version));
    const std::filesystem::path model = place.string() + ".toml";
    const std::filesystem::path fmu = place.string() + ".fmu";
    std::filesystem::create_directories(folder);
    std::ofstream(model) << own.text;
    export_fmu({model, fmu, FMU_MATERIALS, version, own.period, 1});
    CHECK(std::system(("unzip -q -o " + fmu.string() + " -d " + place.string()).c_str()) == 0);
    return place;
  }

  /// Runs a command in the FMU's folder that builds `binary` from its sources, and uses that from now on.
  void build(const std::string& command, const std::string& binary) {
    CHECK(std::system(("cd " + folder_.string() + " && " + command).c_str()) == 0);
    dlclose(library_);
    // The sources have the plant in them.
    std::filesystem::remove(folder_ / "resources/plant.txt");
    load(folder_ / binary);
  }

  template <class Function>
  Function* function(const char* name) const {
    void* found = dlsym(library_, name);
    CHECK_TEXT(found != nullptr, name);
    return reinterpret_cast<Function*>(found);
  }
  unsigned reference(const std::string& name) const { return references_.at(name); }
  std::vector<unsigned> references(const std::vector<std::string>& names) const {
    std::vector<unsigned> found;
    for (const std::string& name : names) {
      found.push_back(reference(name));
    }
    return found;
  }
  const std::string& token() const { return token_; }
  const std::string& description() const { return description_; }
  const std::filesystem::path& folder() const { return folder_; }
  std::string resource_path() const { return (folder_ / "resources/").string(); }
  std::string resource_uri() const { return "file://" + (folder_ / "resources").string(); }

 private:
  static std::filesystem::path kept_folder() {
    return std::filesystem::temp_directory_path() / ("hotfire-fmus-" + std::to_string(getpid()));
  }
  static void remove_kept() { std::filesystem::remove_all(kept_folder()); }

  void load(const std::filesystem::path& binary) {
    library_ = dlopen(binary.c_str(), RTLD_NOW | RTLD_LOCAL);
    CHECK_TEXT(library_ != nullptr, dlerror());
  }

  int version_;
  std::filesystem::path folder_;
  std::string description_;
  std::string token_;
  std::map<std::string, unsigned> references_;
  void* library_ = nullptr;
};

/// The last message that an FMU logged, after its category.
inline std::array<char, 800> last_message{};

inline void log3(fmi3InstanceEnvironment, fmi3Status, fmi3String category, fmi3String message) {
  std::snprintf(last_message.data(), last_message.size(), "%s: %s", category, message);
}
inline void log2(fmi2ComponentEnvironment, fmi2String, fmi2Status, fmi2String category, fmi2String format, ...) {
  std::va_list values;
  va_start(values, format);
  std::array<char, 700> text{};
  std::vsnprintf(text.data(), text.size(), format, values);
  va_end(values);
  std::snprintf(last_message.data(), last_message.size(), "%s: %s", category, text.data());
}
inline constexpr fmi2CallbackFunctions kCallbacks{log2, nullptr, nullptr, nullptr, nullptr};

/// One instance of either version through the calls that a run needs.
class Run {
 public:
  explicit Run(const Fmu& fmu, int version) : fmu_(fmu), is_3_(version == 3) {
    if (is_3_) {
      using Instantiate = fmi3Instance(fmi3String, fmi3String, fmi3String, bool, bool, bool, bool, const unsigned*,
                                       std::size_t, void*, fmi3LogMessageCallback, fmi3IntermediateUpdateCallback);
      instance_ = fmu.function<Instantiate>("fmi3InstantiateCoSimulation")("one", fmu.token().c_str(),
                                                                           fmu.resource_path().c_str(), false, false, false,
                                                                           false, nullptr, 0, nullptr, log3, nullptr);
      get_3_ = fmu.function<Get3>("fmi3GetFloat64");
      set_3_ = fmu.function<Set3>("fmi3SetFloat64");
      step_3_ = fmu.function<Step3>("fmi3DoStep");
    } else {
      using Instantiate =
          fmi2Component(fmi2String, fmi2Type, fmi2String, fmi2String, const fmi2CallbackFunctions*, int, int);
      instance_ = fmu.function<Instantiate>("fmi2Instantiate")("one", fmi2CoSimulation, fmu.token().c_str(),
                                                               fmu.resource_uri().c_str(), &kCallbacks, 0, 0);
      get_2_ = fmu.function<Get2>("fmi2GetReal");
      set_2_ = fmu.function<Set2>("fmi2SetReal");
      step_2_ = fmu.function<Step2>("fmi2DoStep");
    }
    CHECK_TEXT(instance_ != nullptr, last_message.data());
  }
  ~Run() { fmu_.function<void(void*)>(is_3_ ? "fmi3FreeInstance" : "fmi2FreeInstance")(instance_); }
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;

  int call(const std::string& name) const {
    return fmu_.function<int(void*)>(((is_3_ ? "fmi3" : "fmi2") + name).c_str())(instance_);
  }
  int enter(double start = 0.0, bool has_stop = false, double stop = 0.0) const {
    if (is_3_) {
      return fmu_.function<int(void*, bool, double, double, bool, double)>("fmi3EnterInitializationMode")(
          instance_, false, 0.0, start, has_stop, stop);
    }
    const int status = fmu_.function<int(void*, int, double, double, int, double)>("fmi2SetupExperiment")(
        instance_, 0, 0.0, start, has_stop ? 1 : 0, stop);
    return status == 0 ? call("EnterInitializationMode") : status;
  }
  int set(const std::vector<unsigned>& references, const std::vector<double>& values) const {
    return is_3_ ? set_3_(instance_, references.data(), references.size(), values.data(), values.size())
                 : set_2_(instance_, references.data(), references.size(), values.data());
  }
  int get(const std::vector<unsigned>& references, std::vector<double>& values) const {
    return is_3_ ? get_3_(instance_, references.data(), references.size(), values.data(), values.size())
                 : get_2_(instance_, references.data(), references.size(), values.data());
  }
  std::vector<double> got(const std::vector<unsigned>& references) const {
    std::vector<double> values(references.size());
    LONGS_EQUAL(0, get(references, values));
    return values;
  }
  int step(double current, double size) const {
    double last = current + size;
    bool uneventful = true;
    const int status = advance(current, size, last, uneventful);
    CHECK(uneventful);
    if (status == 0) {
      DOUBLES_EQUAL(current + size, last, 0.0);
    }
    return status;
  }
  /// A step without a check, which only the thread of the test may make.
  int advance(double current, double size, double& last, bool& uneventful) const {
    if (!is_3_) {
      return step_2_(instance_, current, size, 1);
    }
    bool event = true;
    bool terminate = true;
    bool early = true;
    const int status = step_3_(instance_, current, size, true, &event, &terminate, &early, &last);
    uneventful = !event && !terminate && !early;
    return status;
  }
  /// Null pointers for `count` values.
  int set_nothing(std::size_t count) const {
    return is_3_ ? set_3_(instance_, nullptr, count, nullptr, count) : set_2_(instance_, nullptr, count, nullptr);
  }
  int get_nothing(std::size_t count) const {
    return is_3_ ? get_3_(instance_, nullptr, count, nullptr, count) : get_2_(instance_, nullptr, count, nullptr);
  }
  int differentiate(unsigned unknown, unsigned known, double& slope) const {
    const double seed = 1.0;
    if (is_3_) {
      return fmu_.function<int(void*, const unsigned*, std::size_t, const unsigned*, std::size_t, const double*, std::size_t,
                               double*, std::size_t)>("fmi3GetDirectionalDerivative")(instance_, &unknown, 1, &known, 1,
                                                                                      &seed, 1, &slope, 1);
    }
    return fmu_.function<int(void*, const unsigned*, std::size_t, const unsigned*, std::size_t, const double*, double*)>(
        "fmi2GetDirectionalDerivative")(instance_, &unknown, 1, &known, 1, &seed, &slope);
  }
  void* instance() const { return instance_; }

 private:
  using Get3 = int(void*, const unsigned*, std::size_t, double*, std::size_t);
  using Set3 = int(void*, const unsigned*, std::size_t, const double*, std::size_t);
  using Step3 = int(void*, double, double, bool, bool*, bool*, bool*, double*);
  using Get2 = int(void*, const unsigned*, std::size_t, double*);
  using Set2 = int(void*, const unsigned*, std::size_t, const double*);
  using Step2 = int(void*, double, double, int);

  const Fmu& fmu_;
  bool is_3_;
  void* instance_ = nullptr;
  Get3* get_3_ = nullptr;
  Set3* set_3_ = nullptr;
  Step3* step_3_ = nullptr;
  Get2* get_2_ = nullptr;
  Set2* set_2_ = nullptr;
  Step2* step_2_ = nullptr;
};

}  // namespace hotfire::test
