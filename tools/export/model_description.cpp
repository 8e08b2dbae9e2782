// SPDX-License-Identifier: Apache-2.0
#include "tools/export/model_description.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <set>

#include "tools/export/unit_definition.hpp"
#include "tools/files/exchange/xml_text.hpp"

namespace hotfire {

namespace {

/// The fewest digits that restore a number.
std::string number(double value) { return fmt::format("{}", value); }

/// Writes modelDescription.xml of one plant.
class Description {
 public:
  Description(const plant::Plant& plant, const FmuIdentity& identity) : plant_(plant), identity_(identity) {}

  std::string text() {
    line("<?xml version=\"1.0\" encoding=\"UTF-8\"?>");
    line(
        "<fmiModelDescription fmiVersion=\"{}\" modelName=\"{}\" {}=\"{}\" description=\"{}\" generationTool=\"Hotfire {}\" "
        "variableNamingConvention=\"flat\"{}>",
        is_3() ? "3.0" : "2.0", escaped(identity_.name), is_3() ? "instantiationToken" : "guid", identity_.token,
        escaped(fmt::format("Hotfire model, topology {}, internal step {} s: inputs are held over it", plant_.topology(),
                            number(plant_.period()))),
        HOTFIRE_VERSION, is_3() ? "" : " numberOfEventIndicators=\"0\"");
    add_co_simulation();
    add_units();
    line("  <LogCategories>");
    line("    <Category name=\"logStatusError\" description=\"a call that failed, and why\"/>");
    line("    <Category name=\"logStatusDiscard\" description=\"a value that was refused, and what is allowed\"/>");
    line("    <Category name=\"logEvents\" description=\"start, end and reset of a run\"/>");
    line("  </LogCategories>");
    line("  <DefaultExperiment startTime=\"0\" stepSize=\"{}\"/>", number(plant_.period()));
    add_variables();
    add_structure();
    line("</fmiModelDescription>");
    return text_;
  }

 private:
  bool is_3() const { return identity_.version == 3; }

  template <class... Values>
  void line(fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Values>(values)...);
    text_ += '\n';
  }

  void add_co_simulation() {
    if (is_3()) {
      line(
          "  <CoSimulation modelIdentifier=\"{}\" canGetAndSetFMUState=\"true\" canSerializeFMUState=\"true\" "
          "providesDirectionalDerivatives=\"true\" canHandleVariableCommunicationStepSize=\"true\" "
          "fixedInternalStepSize=\"{}\"/>",
          identity_.identifier, number(plant_.period()));
      return;
    }
    line(
        "  <CoSimulation modelIdentifier=\"{}\" canHandleVariableCommunicationStepSize=\"true\" "
        "canNotUseMemoryManagementFunctions=\"true\" canGetAndSetFMUstate=\"true\" canSerializeFMUstate=\"true\" "
        "providesDirectionalDerivative=\"true\">",
        identity_.identifier);
    line("    <SourceFiles><File name=\"fmu.cpp\"/></SourceFiles>");
    line("  </CoSimulation>");
  }

  void add_units() {
    std::set<std::string> units;
    for (const auto* table : {&plant_.inputs(), &plant_.outputs(), &plant_.parameters()}) {
      for (const plant::Variable& variable : *table) {
        units.insert(variable.unit);
      }
    }
    units.erase("");
    units.insert("s");
    line("  <UnitDefinitions>");
    for (const std::string& unit : units) {
      const std::optional<BaseUnit> base = base_unit_of(unit);
      if (!base) {
        line("    <Unit name=\"{}\"/>", escaped(unit));
        continue;
      }
      std::string exponents;
      for (std::size_t i = 0; i < base->size(); ++i) {
        if ((*base)[i] != 0) {
          exponents += fmt::format(" {}=\"{}\"", kBaseUnits[i], (*base)[i]);
        }
      }
      line("    <Unit name=\"{}\"><BaseUnit{}/></Unit>", escaped(unit), exponents);
    }
    line("  </UnitDefinitions>");
  }

  /// `role` is causality, variability and initial.
  void add_variable(const plant::Variable& variable, std::string_view role, bool has_start) {
    std::string value = variable.unit.empty() ? std::string{} : fmt::format(" unit=\"{}\"", escaped(variable.unit));
    if (std::abs(variable.lower) < std::numeric_limits<double>::max()) {
      value += fmt::format(" min=\"{}\"", number(variable.lower));
    }
    if (std::abs(variable.upper) < std::numeric_limits<double>::max()) {
      value += fmt::format(" max=\"{}\"", number(variable.upper));
    }
    if (has_start) {
      value += fmt::format(" start=\"{}\"", number(variable.start));
    }
    const std::string common = fmt::format("name=\"{}\" valueReference=\"{}\" description=\"{}\" {}", escaped(variable.name),
                                           ++reference_, escaped(variable.description), role);
    if (is_3()) {
      line("    <Float64 {}{}/>", common, value);
    } else {
      line("    <ScalarVariable {}><Real{}/></ScalarVariable>", common, value);
    }
  }

  void add_variables() {
    line("  <ModelVariables>");
    constexpr const char* kTime =
        "name=\"time\" valueReference=\"0\" description=\"time of the run\" causality=\"independent\" "
        "variability=\"continuous\"";
    if (is_3()) {
      line("    <Float64 {} unit=\"s\"/>", kTime);
    } else {
      line("    <ScalarVariable {}><Real unit=\"s\"/></ScalarVariable>", kTime);
    }
    for (const plant::Variable& input : plant_.inputs()) {
      add_variable(input, "causality=\"input\" variability=\"continuous\"", true);
    }
    for (const plant::Variable& output : plant_.outputs()) {
      add_variable(output, "causality=\"output\" variability=\"continuous\" initial=\"calculated\"", false);
    }
    for (const plant::Variable& parameter : plant_.parameters()) {
      add_variable(parameter,
                   parameter.tunable ? "causality=\"parameter\" variability=\"tunable\" initial=\"exact\""
                                     : "causality=\"parameter\" variability=\"fixed\" initial=\"exact\"",
                   true);
    }
    line("  </ModelVariables>");
  }

  /// An output at a communication point does not depend on inputs at that point: no direct feedthrough. At the start it
  /// depends on inputs and parameters, all of them as far as the importer need know.
  void add_structure() {
    line("  <ModelStructure>");
    add_unknowns("Outputs", "Output", " dependencies=\"\"");
    add_unknowns("InitialUnknowns", "InitialUnknown", "");
    line("  </ModelStructure>");
  }

  /// One element for each output. FMI 3.0 names its kind in the element, FMI 2.0 in a list around the elements.
  void add_unknowns(std::string_view list, std::string_view element, std::string_view attributes) {
    if (!is_3()) {
      line("    <{}>", list);
    }
    for (std::size_t i = 0; i < plant_.outputs().size(); ++i) {
      const std::size_t reference = 1 + plant_.inputs().size() + i;
      if (is_3()) {
        line("    <{} valueReference=\"{}\"{}/>", element, reference, attributes);
      } else {
        line("      <Unknown index=\"{}\"{}/>", reference + 1, attributes);
      }
    }
    if (!is_3()) {
      line("    </{}>", list);
    }
  }

  const plant::Plant& plant_;
  const FmuIdentity& identity_;
  std::string text_;
  std::size_t reference_ = 0;
};

}  // namespace

std::string model_description(const plant::Plant& plant, const FmuIdentity& identity) {
  return Description(plant, identity).text();
}

std::string build_description(const FmuIdentity& identity) {
  return fmt::format(R"(<?xml version="1.0" encoding="UTF-8"?>
<fmiBuildDescription fmiVersion="3.0">
  <BuildConfiguration modelIdentifier="{}" description="C++20; one file includes all others; links the C++ standard library">
    <SourceFileSet language="C++20" compilerOptions="-std=c++20 -O2 -ffp-contract=off">
      <SourceFile name="fmu.cpp"/>
      <PreprocessorDefinition name="FMI3_OVERRIDE_FUNCTION_PREFIX" optional="true"
        description="For a shared library: the functions have the standard's names. Without it the model identifier is their prefix."/>
      <IncludeDirectory name="."/>
    </SourceFileSet>
    <Library name="stdc++" external="true" description="C++ standard library"/>
  </BuildConfiguration>
</fmiBuildDescription>
)",
                     identity.identifier);
}

}  // namespace hotfire
