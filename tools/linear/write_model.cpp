// SPDX-License-Identifier: Apache-2.0
#include "tools/linear/write_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "tools/files/exchange/matlab_handles.hpp"
#include "tools/files/text/error.hpp"
#include "tools/files/text/whole_file.hpp"

namespace hotfire::linear {

namespace {

using Json = nlohmann::ordered_json;

/// A matrix of the model with what its rows and columns are.
struct Named {
  const char* name;
  const Eigen::MatrixXd& matrix;
  const std::vector<Quantity>& rows;
  const std::vector<Quantity>& columns;
};

std::array<Named, 6> matrices_of(const LinearModel& model) {
  return {
      Named{"A", model.a, model.states, model.states},           Named{"B", model.b, model.states, model.inputs},
      Named{"C", model.c, model.outputs, model.states},          Named{"D", model.d, model.outputs, model.inputs},
      Named{"step_A", model.step_a, model.states, model.states}, Named{"step_B", model.step_b, model.states, model.inputs}};
}

Json rows_of(const Eigen::MatrixXd& matrix) {
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    Json row = Json::array();
    for (Eigen::Index k = 0; k < matrix.cols(); ++k) {
      row.push_back(matrix(i, k));
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

Json list_of(const std::vector<Quantity>& quantities) {
  Json list = Json::array();
  for (const Quantity& own : quantities) {
    list.push_back({{"name", own.name}, {"unit", own.unit}});
  }
  return list;
}

std::string csv_text(const LinearModel& model) {
  std::string text =
      fmt::format("# linear model of a {}; x' = A x + B u, y = C x + D u; step_A and step_B with period {:.17g} s\n",
                  model.topology, model.period);
  for (const Delay& delay : model.delays) {
    text += fmt::format("# {} is late by {:.17g} s beside these matrices\n", delay.name, delay.seconds);
  }
  text += "matrix,row,row_unit,column,column_unit,value\n";
  for (const Named& own : matrices_of(model)) {
    for (Eigen::Index i = 0; i < own.matrix.rows(); ++i) {
      for (Eigen::Index k = 0; k < own.matrix.cols(); ++k) {
        if (own.matrix(i, k) != 0.0) {
          const Quantity& row = own.rows[static_cast<std::size_t>(i)];
          const Quantity& column = own.columns[static_cast<std::size_t>(k)];
          text += fmt::format("{},{},{},{},{},{:.17g}\n", own.name, row.name, row.unit, column.name, column.unit,
                              own.matrix(i, k));
        }
      }
    }
  }
  return text;
}

bool put_matrix(mat_t* file, const char* name, Eigen::MatrixXd matrix) {
  std::array<std::size_t, 2> size{static_cast<std::size_t>(matrix.rows()), static_cast<std::size_t>(matrix.cols())};
  const MatVariable variable(
      Mat_VarCreate(name, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, size.data(), matrix.data(), MAT_F_DONT_COPY_DATA));
  return variable && Mat_VarWrite(file, variable.get(), MAT_COMPRESSION_ZLIB) == 0;
}

/// A column of texts. The array owns the texts once it is made.
bool put_texts(mat_t* file, const std::string& name, const std::vector<std::string>& texts) {
  std::vector<matvar_t*> cells;
  for (std::string text : texts) {
    std::array<std::size_t, 2> size{1, text.size()};
    cells.push_back(Mat_VarCreate(nullptr, MAT_C_CHAR, MAT_T_UTF8, 2, size.data(), text.data(), 0));
  }
  std::array<std::size_t, 2> size{cells.size(), 1};
  const MatVariable variable(Mat_VarCreate(name.c_str(), MAT_C_CELL, MAT_T_CELL, 2, size.data(), cells.data(), 0));
  return variable && Mat_VarWrite(file, variable.get(), MAT_COMPRESSION_NONE) == 0;
}

bool put_quantities(mat_t* file, const std::string& name, const std::vector<Quantity>& quantities) {
  std::vector<std::string> names;
  std::vector<std::string> units;
  for (const Quantity& own : quantities) {
    names.push_back(own.name);
    units.push_back(own.unit);
  }
  return put_texts(file, name + "_names", names) && put_texts(file, name + "_units", units);
}

void write_mat(const LinearModel& model, const std::filesystem::path& path) {
  write_whole_file_by(path, [&](const std::filesystem::path& temporary) {
    const MatFile file(Mat_CreateVer(temporary.c_str(), nullptr, MAT_FT_MAT5));
    bool good = file != nullptr;
    for (const Named& own : matrices_of(model)) {
      good = good && put_matrix(file.get(), own.name, own.matrix);
    }
    good = good && put_matrix(file.get(), "period", Eigen::MatrixXd::Constant(1, 1, model.period)) &&
           put_quantities(file.get(), "state", model.states) && put_quantities(file.get(), "input", model.inputs) &&
           put_quantities(file.get(), "output", model.outputs);
    if (!model.delays.empty()) {
      std::vector<std::string> names;
      Eigen::MatrixXd seconds(static_cast<Eigen::Index>(model.delays.size()), 1);
      for (std::size_t i = 0; i < model.delays.size(); ++i) {
        names.push_back(model.delays[i].name);
        seconds(static_cast<Eigen::Index>(i)) = model.delays[i].seconds;
      }
      good = good && put_texts(file.get(), "delay_names", names) && put_matrix(file.get(), "delay_seconds", seconds);
    }
    return good;
  });
}

}  // namespace

Json to_json(const LinearModel& model) {
  Json json{{"topology", model.topology},
            {"states", list_of(model.states)},
            {"inputs", list_of(model.inputs)},
            {"outputs", list_of(model.outputs)},
            {"continuous_by", model.by_logarithm ? "logarithm" : "bilinear rule"},
            {"period", model.period}};
  json["delays"] = Json::array();
  for (const Delay& delay : model.delays) {
    json["delays"].push_back({{"name", delay.name}, {"seconds", delay.seconds}});
  }
  for (const Named& own : matrices_of(model)) {
    json[own.name] = rows_of(own.matrix);
  }
  return json;
}

void write_model(const LinearModel& model, const std::filesystem::path& path) {
  const std::string ending = path.extension();
  if (ending == ".mat") {
    write_mat(model, path);
  } else if (ending == ".json" || ending == ".csv") {
    WholeFile file(path);
    file.write(ending == ".json" ? to_json(model).dump(1) + "\n" : csv_text(model));
    file.commit();
  } else {
    throw UsageError(
        fmt::format("{}: the format of a linear model follows from the ending; allowed: .mat, .json, .csv", path.string()));
  }
}

}  // namespace hotfire::linear
