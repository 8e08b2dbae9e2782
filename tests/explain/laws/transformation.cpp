// SPDX-License-Identifier: Apache-2.0
#include "tests/explain/laws/transformation.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <random>
#include <regex>
#include <set>

#include "tools/files/text/units.hpp"
#include "tools/study/cases/similar.hpp"

namespace hotfire::test {

namespace {

/// Units of everyday use, by the SI unit that they stand for.
const std::map<std::string, std::string>& everyday_units() {
  static const std::map<std::string, std::string> units{
      {"m", "mm"},      {"rad", "deg"},         {"s", "ms"},        {"Pa", "MPa"}, {"m^2", "cm^2"},      {"m^3", "litre"},
      {"N/m", "kN/mm"}, {"m^3/s", "litre/min"}, {"rad/s", "deg/s"}, {"kg", "g"},   {"kg.m^2", "g.mm^2"}, {"1/m", "1/mm"},
      {"1/Pa", "1/MPa"}};
  return units;
}

const std::map<std::string, std::string> kSi{};

std::string unit_of(const std::string& si, const std::map<std::string, std::string>& units) {
  const auto found = units.find(si);
  return found == units.end() ? si : found->second;
}

/// The record as a file of those units says it.
Record through_file(const Record& record, const std::map<std::string, std::string>& units) {
  const auto path = std::filesystem::temp_directory_path() / fmt::format("hotfire-laws-{}-{}", getpid(), record.name);
  {
    std::ofstream file(path);
    const UnitConverter time("s", unit_of("s", units));
    std::vector<UnitConverter> converters;
    file << fmt::format("time[{}]", unit_of("s", units));
    for (const Channel& channel : record.channels) {
      file << fmt::format(",{}[{}]", channel.name, unit_of(channel.unit, units));
      converters.emplace_back(channel.unit, unit_of(channel.unit, units));
    }
    for (std::size_t row = 0; row < record.rows; ++row) {
      file << fmt::format("\n{}", time(record.start + static_cast<double>(row) * record.period));
      for (std::size_t c = 0; c < record.channels.size(); ++c) {
        file << fmt::format(",{}", converters[c](record.channels[c].values[row]));
      }
    }
    file << "\n";
  }
  Record read = load_record(path);
  std::filesystem::remove(path);
  read.name = record.name;
  read.path = record.path;
  return read;
}

/// The model as a file of those units says it: `model_text` writes every number's unit behind it.
ModelFile through_file(const ModelFile& model, const std::map<std::string, std::string>& units) {
  const std::regex line(R"(^(\w+) = ([-+0-9.e]+) +# ([^ :]+).*$)");
  std::string text;
  std::istringstream lines(model_text(model));
  for (std::string words; std::getline(lines, words);) {
    std::smatch found;
    if (std::regex_match(words, found, line) && units.contains(found[3])) {
      const std::string& unit = units.at(found[3]);
      words = fmt::format("{} = \"{} {}\"", found[1].str(), convert_unit(std::stod(found[2]), found[3], unit), unit);
    }
    text += words + "\n";
  }
  return parse_model(text, "declared.toml");
}

Given in_everyday_units(Given given) {
  given.declared = through_file(given.declared, everyday_units());
  for (Record& record : given.records) {
    record = through_file(record, everyday_units());
  }
  return given;
}

/// True for a parameter that is positive for what happens on extend alone.
bool is_odd(const std::string& key) {
  static const std::set<std::string> keys{"valve_asymmetry.asymmetry", "valve_bias.bias", "torque_offset.torque",
                                          "sensor_nonlinearity.quadratic", "term_torque.gain"};
  return keys.contains(key);
}

/// Every signed channel with the other sign; nothing that is declared has one.
Given mirrored(Given given) {
  for (Record& record : given.records) {
    for (Channel& channel : record.channels) {
      std::ranges::transform(channel.values, channel.values.begin(), std::negate<>());
    }
  }
  return given;
}

Given in_other_order(Given given) {
  std::ranges::reverse(given.records);
  return given;
}

Record rows_of(const Record& whole, std::size_t first, std::size_t last, std::size_t every = 1) {
  Record part = whole;
  part.start += static_cast<double>(first) * whole.period;
  part.period *= static_cast<double>(every);
  part.rows = (last - first + every - 1) / every;
  for (Channel& channel : part.channels) {
    std::vector<double> values;
    for (std::size_t row = first; row < last; row += every) {
      values.push_back(channel.values[row]);
    }
    channel.values = std::move(values);
  }
  return part;
}

Given cut_in_two(Given given) {
  const Record whole = given.records.front();
  given.records.front() = rows_of(whole, 0, whole.rows / 2);
  given.records.push_back(rows_of(whole, whole.rows / 2, whole.rows));
  given.records.back().name = "second_half.csv";
  return given;
}

Given later_by(Given given, double seconds) {
  for (Record& record : given.records) {
    record.start += seconds;
    record = through_file(record, kSi);
  }
  return given;
}

Given later(Given given) { return later_by(std::move(given), 1000.0); }
Given since_epoch(Given given) { return later_by(std::move(given), 1.7e9); }

void add_noise(std::vector<double>& values, double rms, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0.0, rms);
  std::ranges::for_each(values, [&](double& value) { value += normal(random); });
}

Channel noise_alone(const char* name, const char* unit, double rms, std::size_t rows, unsigned seed) {
  Channel channel{name, unit, std::vector<double>(rows, 0.0)};
  add_noise(channel.values, rms, seed);
  return channel;
}

Given with_unused_channel(Given given) {
  for (Record& record : given.records) {
    record.channels.insert(record.channels.begin(), noise_alone("vibration", "m/s^2", 1.0, record.rows, 21));
  }
  return given;
}

/// A channel that the model has, by a sensor of which the noise is a hundred times all that it could show.
Given with_deaf_channel(Given given) {
  const double rms = 100.0 * std::get<SimplexParameters>(given.declared.parameters).actuator.supply_pressure;
  given.declared.noise["load_pressure"] = rms;
  unsigned seed = 22;
  for (Record& record : given.records) {
    record.channels.push_back(noise_alone("load_pressure", "Pa", rms, record.rows, seed++));
  }
  return given;
}

Given at_half_the_rate(Given given) {
  for (Record& record : given.records) {
    record = rows_of(record, 0, record.rows, 2);
  }
  return given;
}

Given with_twice_the_noise(Given given) {
  unsigned seed = 31;
  for (auto& [name, rms] : given.declared.noise) {
    for (Record& record : given.records) {
      for (Channel& channel : record.channels) {
        if (channel.name == name) {
          add_noise(channel.values, std::sqrt(3.0) * rms, seed++);
        }
      }
    }
    rms *= 2.0;
  }
  return given;
}

Given on_small_and_fast_rig(Given given) {
  given.declared = study::similar(given.declared, study::kSmallAndFast);
  for (Record& record : given.records) {
    record = study::similar(record, study::kSmallAndFast);
  }
  return given;
}

Given by_one_thread(Given given) {
  given.threads = 1;
  return given;
}

double sign_of_key(const std::string& key, const std::string&) { return is_odd(key) ? -1.0 : 1.0; }

/// The gain of a torque over the product of two angles is reported without its unit.
double factor_of_unit(const std::string& key, const std::string& unit) {
  return study::factor_of(key == "term_torque.gain" ? "N.m" : unit, study::kSmallAndFast);
}

}  // namespace

const Transformation kOtherUnits{"other units", in_everyday_units, Agreement::same, nullptr};
const Transformation kMirror{"mirror", mirrored, Agreement::same, sign_of_key};
const Transformation kOtherOrder{"other order", in_other_order, Agreement::same, nullptr};
const Transformation kCutInTwo{"cut in two", cut_in_two, Agreement::other, nullptr};
const Transformation kLater{"1000 s later", later, Agreement::same, nullptr};
const Transformation kSinceEpoch{"since the epoch", since_epoch, Agreement::same, nullptr};
const Transformation kUnusedChannel{"unused channel", with_unused_channel, Agreement::same_bits, nullptr};
const Transformation kDeafChannel{"deaf channel", with_deaf_channel, Agreement::same, nullptr};
const Transformation kHalfTheRate{"half the rate", at_half_the_rate, Agreement::other, nullptr};
const Transformation kTwiceTheNoise{"twice the noise", with_twice_the_noise, Agreement::other, nullptr};
const Transformation kSmallAndFastRig{"small and fast", on_small_and_fast_rig, Agreement::same, factor_of_unit};
const Transformation kOneThread{"one thread", by_one_thread, Agreement::same_bits, nullptr};

}  // namespace hotfire::test
