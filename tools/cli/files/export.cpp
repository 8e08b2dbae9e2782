// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <iostream>
#include <memory>

#include "tools/cli/shared/commands.hpp"
#include "tools/cli/shared/plant_image.hpp"
#include "tools/cli/shared/print_json.hpp"
#include "tools/export/export_fmu.hpp"
#include "tools/files/rig/profile_file.hpp"
#include "tools/files/text/error.hpp"
#include "tools/files/text/whole_file.hpp"

namespace hotfire {

namespace {

/// lib/hotfire/fmu beside the folder of this program, in a build as in an installation.
std::filesystem::path materials_of_this_program() {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path().parent_path() / "lib/hotfire/fmu";
}

void run_export(FmuOptions options, bool json) {
  options.materials = materials_of_this_program();
  const ExportedFmu written = export_fmu(options);
  if (json) {
    print_json({{"fmu", options.fmu.string()},
                {"fmi", options.version == 3 ? "3.0" : "2.0"},
                {"model_identifier", written.identifier},
                {"step", options.period},
                {"inputs", written.inputs},
                {"outputs", written.outputs},
                {"parameters", written.parameters}});
    return;
  }
  std::cout << fmt::format("{}: FMI {} co-simulation, internal step {} s, {} inputs, {} outputs, {} parameters\n",
                           options.fmu.string(), options.version == 3 ? "3.0" : "2.0", options.period, written.inputs,
                           written.outputs, written.parameters);
}

/// For a target without the program hotfire: what `hotfire plant` or `hotfire lab` would hand over in memory.
void run_export_image(const std::string& path, const std::string& image, bool json) {
  const std::string kind = is_profile(path) ? "profile" : "model";
  write_whole_file(image, kind == "profile" ? load_profile(path).image : image_of_model(path));
  if (json) {
    print_json({{"image", image}, {"kind", kind}});
    return;
  }
  std::cout << fmt::format("{}: image of a {}; to run it: hotfire-rt {} --image {}\n", image, kind,
                           kind == "profile" ? "lab" : "plant", image);
}

}  // namespace

void add_export(CLI::App& program) {
  const auto options = std::make_shared<FmuOptions>();
  const auto image = std::make_shared<std::string>();
  const auto json = std::make_shared<bool>(false);
  CLI::App* command =
      program.add_subcommand("export", "Write a model as an FMU for other simulation programs, or as an image for a target");
  command->add_option("model", options->model, "model file (.toml); for an image also a profile")->required();
  CLI::Option* fmu = command->add_option("--fmu", options->fmu, "FMU to write (.fmu)");
  command->add_option("--image", *image, "image to write (.image), which hotfire-rt runs on a target without hotfire")
      ->excludes(fmu);
  command->add_option("--fmi", options->version, "version of FMI: 2 or 3")
      ->check(CLI::IsMember({2, 3}))
      ->capture_default_str();
  command->add_option("--step", options->period, "fixed internal step [s], over which inputs are held")
      ->capture_default_str();
  command
      ->add_option("--seed", options->seed,
                   "seed of the sensor noise and of the strings' placement errors in a model of several axes")
      ->capture_default_str();
  command->add_flag("--json", *json, "print the result as JSON");
  command->footer(
      "Example: hotfire export --fmu axis.fmu explained.toml\nExample: hotfire export --image axis.image explained.toml");
  command->callback([options, image, json] {
    if (!image->empty()) {
      run_export_image(options->model.string(), *image, *json);
    } else if (options->fmu.empty()) {
      throw UsageError("what to write is missing: give --fmu FILE or --image FILE");
    } else {
      run_export(*options, *json);
    }
  });
}

}  // namespace hotfire
