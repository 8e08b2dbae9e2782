// SPDX-License-Identifier: Apache-2.0
#include "tools/disperse/tolerances.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <set>

#include "tools/disperse/latin_hypercube.hpp"
#include "tools/files/model/model_group.hpp"
#include "tools/files/text/error.hpp"
#include "tools/files/text/suggestion.hpp"
#include "tools/files/text/toml_source.hpp"

namespace hotfire::disperse {

namespace {

constexpr std::array<std::string_view, 5> kWordsOfSpread{"sigma", "deviation", "low", "high", "within"};

bool is_word_of_spread(std::string_view word) {
  return std::find(kWordsOfSpread.begin(), kWordsOfSpread.end(), word) != kWordsOfSpread.end();
}

bool names(const DeclaredNumber& number, const std::string& key) {
  return std::find(number.keys.begin(), number.keys.end(), key) != number.keys.end();
}

/// Reads one file, step by step.
class Reader {
 public:
  Reader(const TomlSource& source, DeclaredModel& model) : source_(source), numbers_(model.numbers()) {}

  Tolerances read() {
    source_.require_schema();
    refuse_unknown_keys(source_, source_.root(), "", {"schema", "tolerance", "locations"});
    if (const toml::node* node = source_.root().get("tolerance")) {
      read_table(source_.table(*node, "tolerance"), "");
    }
    std::vector<std::pair<std::size_t, Eigen::MatrixXd>> blocks;
    if (const toml::node* node = source_.root().get("locations")) {
      for (const auto& [name, own] : source_.table(*node, "locations")) {
        const std::string key = fmt::format("locations.{}", name.str());
        const std::size_t first = variables_.size();
        blocks.emplace_back(first, read_location(source_.table(own, key), key));
      }
    }
    if (variables_.empty()) {
      source_.refuse_missing(source_.root(), "tolerance",
                             "missing; write [tolerance] with a key of the model, as in engine.inertia = 0.02");
    }
    const auto count = static_cast<Eigen::Index>(variables_.size());
    Tolerances tolerances{variables_, Eigen::MatrixXd::Identity(count, count)};
    for (const auto& [first, block] : blocks) {
      tolerances.correlation.block(static_cast<Eigen::Index>(first), static_cast<Eigen::Index>(first), block.rows(),
                                   block.cols()) = block;
    }
    return tolerances;
  }

 private:
  /// Keys of the file are words behind each other, which TOML nests; a table with words of a spread is one.
  void read_table(const toml::table& table, const std::string& prefix) {
    for (const auto& [word, node] : table) {
      const std::string key = prefix + std::string{word.str()};
      const toml::table* own = node.as_table();
      if (own == nullptr) {
        add(node, key, relative(node, key));
      } else if (std::any_of(own->begin(), own->end(),
                             [](const auto& entry) { return is_word_of_spread(entry.first.str()); })) {
        add(node, key, spread(*own, key));
      } else {
        read_table(*own, key + ".");
      }
    }
  }

  double positive(const toml::node& node, const std::string& key, const std::string& unit) const {
    const double value = source_.number(node, key, unit);
    if (!(value > 0.0)) {
      source_.refuse(node, key, "not above 0; allowed: a size above 0; leave the key out if the value is exact");
    }
    return value;
  }

  Tolerance relative(const toml::node& node, const std::string& key) const {
    return {.key = key, .size = positive(node, key, "1")};
  }

  /// The SI unit of a key, which the model must have.
  const std::string& unit_of(const toml::node& node, const std::string& key) const {
    const auto number = std::find_if(numbers_.begin(), numbers_.end(), [&](const auto& own) { return names(own, key); });
    if (number == numbers_.end()) {
      std::set<std::string_view> known;
      for (const DeclaredNumber& own : numbers_) {
        known.insert(own.keys.begin(), own.keys.end());
      }
      const std::vector<std::string_view> near = nearest_words(key, {known.begin(), known.end()}, 4);
      source_.refuse(node, key,
                     fmt::format("no number of the model; allowed: keys of its parts, active effects, attach points and "
                                 "gimbal, such as {}",
                                 fmt::join(near, ", ")));
    }
    return number->unit;
  }

  Tolerance spread(const toml::table& table, const std::string& key) const {
    refuse_unknown_keys(source_, table, key + ".", Words(kWordsOfSpread.begin(), kWordsOfSpread.end()));
    const auto at = [&](std::string_view word) { return table.get(word); };
    const bool is_between = at("low") != nullptr && at("high") != nullptr;
    const int forms = (at("sigma") != nullptr ? 1 : 0) + (at("deviation") != nullptr ? 1 : 0) + (is_between ? 1 : 0);
    if (forms != 1 || (at("low") != nullptr) != (at("high") != nullptr) || (is_between && at("within") != nullptr)) {
      source_.refuse_missing(table, key,
                             "no single spread; allowed: sigma (relative) or deviation (in the unit of the key), each with "
                             "or without within, or low with high");
    }
    const std::string& unit = unit_of(table, key);
    if (unit.empty() && at("sigma") == nullptr) {
      source_.refuse_missing(table, key, "a matrix has no single value; allowed: sigma, relative");
    }
    Tolerance own{.key = key};
    if (is_between) {
      own.spread = Spread::between;
      own.low = source_.number(*at("low"), key + ".low", unit);
      own.high = source_.number(*at("high"), key + ".high", unit);
      if (!(own.low < own.high)) {
        source_.refuse(*at("high"), key + ".high", fmt::format("not above low = {:g}; allowed: low below high", own.low));
      }
      return own;
    }
    if (at("deviation") != nullptr) {
      own.spread = Spread::absolute;
      own.size = positive(*at("deviation"), key + ".deviation", unit);
    } else {
      own.size = positive(*at("sigma"), key + ".sigma", "1");
    }
    own.within = at("within") != nullptr ? positive(*at("within"), key + ".within", "1") : 0.0;
    return own;
  }

  void add(const toml::node& node, const std::string& key, Tolerance tolerance) {
    tolerance.unit = unit_of(node, key);
    const bool is_known =
        std::any_of(variables_.begin(), variables_.end(), [&](const Tolerance& own) { return own.key == key; });
    if (is_known) {
      source_.refuse(node, key, "has a tolerance already; give one, under [tolerance] or in one of the locations");
    }
    const bool relative_of_zero = tolerance.spread == Spread::relative &&
                                  std::all_of(numbers_.begin(), numbers_.end(), [&](const DeclaredNumber& number) {
                                    return !names(number, key) || *number.value == 0.0;
                                  });
    if (relative_of_zero) {
      source_.refuse(node, key,
                     "the model declares 0, of which a factor leaves 0; write {deviation = ...} or {low = ..., high = ...}");
    }
    variables_.push_back(std::move(tolerance));
  }

  const toml::node& required(const toml::table& table, const std::string& key, std::string_view word,
                             std::string_view what) const {
    const toml::node* node = table.get(word);
    if (node == nullptr) {
      source_.refuse_missing(table, fmt::format("{}.{}", key, word), fmt::format("missing; {}", what));
    }
    return *node;
  }

  /// Adds a variable for each key of a location table; returns their correlation.
  Eigen::MatrixXd read_location(const toml::table& table, const std::string& key) {
    refuse_unknown_keys(source_, table, key + ".", {"keys", "sigma", "within", "correlation"});
    const toml::node& keys = required(table, key, "keys", "an array of keys of the model, one for each location");
    const toml::array* list = keys.as_array();
    if (list == nullptr || list->size() < 2) {
      source_.refuse(keys, key + ".keys",
                     "not two keys or more; allowed: an array such as [\"structure.pitch.stiffness\", "
                     "\"structure.yaw.stiffness\"]");
    }
    const double sigma =
        positive(required(table, key, "sigma", "the relative one-sigma of each factor"), key + ".sigma", "1");
    const toml::node* within = table.get("within");
    const double cut = within != nullptr ? positive(*within, key + ".within", "1") : 0.0;
    for (const toml::node& node : *list) {
      const std::string own = source_.text(node, key + ".keys");
      add(node, own, {.key = own, .size = sigma, .within = cut});
    }
    return correlation_of(required(table, key, "correlation", "of every two factors, or a matrix; 0: independent"), key,
                          static_cast<Eigen::Index>(list->size()));
  }

  Eigen::MatrixXd correlation_of(const toml::node& node, const std::string& key, Eigen::Index count) const {
    const std::string name = key + ".correlation";
    Eigen::MatrixXd correlation(count, count);
    if (const toml::array* rows = node.as_array()) {
      for (Eigen::Index row = 0; row < count; ++row) {
        const toml::node* own = rows->get(static_cast<std::size_t>(row));
        const toml::array* cells = own != nullptr ? own->as_array() : nullptr;
        if (static_cast<Eigen::Index>(rows->size()) != count || cells == nullptr ||
            static_cast<Eigen::Index>(cells->size()) != count) {
          source_.refuse(node, name, fmt::format("not a matrix of the {0} keys; allowed: {0} rows of {0} numbers", count));
        }
        for (Eigen::Index column = 0; column < count; ++column) {
          correlation(row, column) = source_.number((*cells)[static_cast<std::size_t>(column)], name, "1");
        }
      }
    } else {
      correlation.setConstant(source_.number(node, name, "1"));
      correlation.diagonal().setOnes();
    }
    const bool is_correlation = correlation == correlation.transpose() && (correlation.diagonal().array() == 1.0).all();
    const Eigen::LLT<Eigen::MatrixXd> root(correlation);
    constexpr double kLeastPivot = 1e-6;
    if (!is_correlation || root.info() != Eigen::Success ||
        Eigen::MatrixXd(root.matrixL()).diagonal().minCoeff() < kLeastPivot) {
      source_.refuse(
          node, name,
          fmt::format("no correlation of {} factors; allowed: symmetric, ones on the diagonal, positive definite, "
                      "one number above {:.3g} and below 1; factors that move as one are one key",
                      count, -1.0 / static_cast<double>(count - 1)));
    }
    return correlation;
  }

  const TomlSource& source_;
  std::vector<DeclaredNumber> numbers_;
  std::vector<Tolerance> variables_;
};

}  // namespace

double Tolerance::at(double probability) const {
  if (spread == Spread::between) {
    return low + (high - low) * probability;
  }
  // A normal variable that is cut off keeps its shape within the limits.
  const double beyond = within > 0.0 ? normal_probability(-within) : 0.0;
  return normal_quantile(beyond + (1.0 - 2.0 * beyond) * probability);
}

double Tolerance::applied(double declared, double x) const {
  switch (spread) {
    case Spread::relative:
      return declared * (1.0 + size * x);
    case Spread::absolute:
      return declared + size * x;
    default:
      return x;
  }
}

Tolerances load_tolerances(const std::filesystem::path& path, DeclaredModel& model) {
  const TomlSource source(path);
  return Reader(source, model).read();
}

Tolerances tolerances_of(const std::filesystem::path& path, DeclaredModel& model) {
  Tolerances tolerances;
  const std::vector<DeclaredNumber> numbers = model.numbers();
  for (const auto& [key, relative] : model.tolerances()) {
    const auto number =
        std::find_if(numbers.begin(), numbers.end(), [&own = key](const auto& one) { return names(one, own); });
    if (number != numbers.end() && relative > 0.0) {
      tolerances.variables.push_back({.key = key, .size = relative, .unit = number->unit});
    }
  }
  if (tolerances.variables.empty()) {
    throw FileError(fmt::format(
        "{}: has no [tolerance] to draw from; write one, as in engine.inertia = 0.02, or give --tolerances", path.string()));
  }
  const auto count = static_cast<Eigen::Index>(tolerances.variables.size());
  tolerances.correlation = Eigen::MatrixXd::Identity(count, count);
  return tolerances;
}

DeclaredModel with_variables(const DeclaredModel& model, const std::vector<Tolerance>& variables, const Eigen::VectorXd& x) {
  DeclaredModel drawn = model;
  const std::vector<DeclaredNumber> numbers = drawn.numbers();
  for (const Spread spread : {Spread::between, Spread::relative, Spread::absolute}) {
    for (std::size_t i = 0; i < variables.size(); ++i) {
      for (const DeclaredNumber& number : numbers) {
        if (variables[i].spread == spread && names(number, variables[i].key)) {
          *number.value = variables[i].applied(*number.value, x(static_cast<Eigen::Index>(i)));
        }
      }
    }
  }
  return drawn;
}

std::vector<double> drawn_values(DeclaredModel& model, const std::vector<Tolerance>& variables, const Eigen::VectorXd& x) {
  const std::vector<DeclaredNumber> numbers = model.numbers();
  std::vector<double> values;
  for (std::size_t i = 0; i < variables.size(); ++i) {
    const auto number =
        std::find_if(numbers.begin(), numbers.end(), [&](const auto& own) { return names(own, variables[i].key); });
    values.push_back(variables[i].applied(*number->value, x(static_cast<Eigen::Index>(i))));
  }
  return values;
}

}  // namespace hotfire::disperse
