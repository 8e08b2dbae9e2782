// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace hotfire {

/// What an FMU is made of.
struct FmuOptions {
  std::filesystem::path model;      ///< model file
  std::filesystem::path fmu;        ///< archive to write; its name without folder and ending names the binary
  std::filesystem::path materials;  ///< folder lib/hotfire/fmu of this build or installation: binaries and sources
  int version = 3;                  ///< of FMI: 2 or 3
  double period = 1e-3;             ///< fixed internal step [s]
  unsigned seed = 1;                ///< of the sensors' noise and of the strings' placement errors
};

/// What was written.
struct ExportedFmu {
  std::size_t inputs;
  std::size_t outputs;
  std::size_t parameters;
  std::string identifier;
};

/// Writes an FMU for co-simulation: modelDescription.xml, the binary for x86_64 Linux, its sources with the plant in them,
/// and the plant in resources/. The same model gives the same bytes. Throws FileError, and UsageError for a period outside
/// 1e-6 to 1 s.
ExportedFmu export_fmu(const FmuOptions& options);

}  // namespace hotfire
