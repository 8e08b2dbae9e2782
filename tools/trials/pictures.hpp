// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tools/analysis/chart.hpp"
#include "tools/analysis/welch.hpp"
#include "tools/files/record/record.hpp"
#include "tools/trials/stiffness.hpp"
#include "tools/trials/sweep.hpp"

namespace hotfire::trials {

/// Gain, phase and coherence over frequency, one curve a response.
analysis::Chart bode_chart(const std::string& title, const std::vector<ChannelSweep>& sweeps);

/// Command and engine in degrees over time, and the piston in millimetres, as far as the record has them.
analysis::Chart time_chart(const std::string& title, const Record& record, const std::string& axis);

/// Load resonance and stiffness of the actuator over the amplitude of the sines: what the test has as dots, what the force
/// curve expects about a bias load [N] [SD eq. 4-7] and what that rises to as lines. At least one amplitude.
analysis::Chart stiffness_chart(const std::string& title, const std::vector<SineStiffness>& stiffnesses,
                                const LoadSpring& spring, double bias = 0.0);

/// Densities over frequency between `lowest` and `highest` [Hz], each over its largest, in decibels.
analysis::Chart spectrum_chart(const std::string& title, const std::vector<std::string>& labels,
                               const std::vector<analysis::Spectrum>& spectra, double lowest, double highest);

/// Writes a chart as SVG, whole or not at all. Throws FileError.
void write_picture(const analysis::Chart& chart, const std::filesystem::path& path);

}  // namespace hotfire::trials
