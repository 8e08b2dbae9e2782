// SPDX-License-Identifier: Apache-2.0
#include "tools/trials/pictures.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tools/files/text/whole_file.hpp"
#include "tools/trials/profiles.hpp"

namespace hotfire::trials {

namespace {

/// Every n-th value, so that no curve has more points than a picture has pixels.
std::vector<double> thinned(const std::vector<double>& values, double scale) {
  constexpr std::size_t kMost = 2500;
  const std::size_t stride = values.size() / kMost + 1;
  std::vector<double> some;
  for (std::size_t k = 0; k < values.size(); k += stride) {
    some.push_back(values[k] * scale);
  }
  return some;
}

}  // namespace

analysis::Chart bode_chart(const std::string& title, const std::vector<ChannelSweep>& sweeps) {
  analysis::Chart chart{title, "frequency [Hz]", true, {{"gain [dB]", {}}, {"phase [deg]", {}}, {"coherence", {}}}};
  for (const ChannelSweep& sweep : sweeps) {
    const std::string label =
        sweep.amplitude > 0.0 ? fmt::format("{} {:.3g} deg", sweep.channel, degrees(sweep.amplitude)) : sweep.channel;
    std::vector<double> frequency;
    std::vector<double> gain;
    std::vector<double> coherence;
    for (const analysis::ResponsePoint& point : sweep.response) {
      frequency.push_back(point.frequency);
      gain.push_back(analysis::gain_decibels(point));
      coherence.push_back(point.coherence);
    }
    chart.panels[0].curves.push_back({label, frequency, gain});
    chart.panels[1].curves.push_back({label, frequency, analysis::phase_degrees(sweep.response)});
    chart.panels[2].curves.push_back({label, frequency, coherence});
  }
  return chart;
}

analysis::Chart time_chart(const std::string& title, const Record& record, const std::string& axis) {
  std::vector<double> time(record.rows);
  for (std::size_t row = 0; row < record.rows; ++row) {
    time[row] = record.start + static_cast<double>(row) * record.period;
  }
  time = thinned(time, 1.0);
  analysis::Chart chart{title, "time [s]", false, {}};
  analysis::Panel angles{"angle [deg]", {}};
  for (const std::string name : {"command", "engine"}) {
    if (const Channel* channel = record.find(channel_of(name, axis))) {
      angles.curves.push_back({name, time, thinned(channel->values, degrees(1.0))});
    }
  }
  if (!angles.curves.empty()) {
    chart.panels.push_back(std::move(angles));
  }
  if (const Channel* piston = record.find(channel_of("piston", axis))) {
    chart.panels.push_back({"piston [mm]", {{"piston", time, thinned(piston->values, 1e3)}}});
  }
  if (const Channel* position = record.find("position")) {
    chart.panels.push_back({"position", {{"position", time, thinned(position->values, 1.0)}}});
  }
  return chart;
}

analysis::Chart stiffness_chart(const std::string& title, const std::vector<SineStiffness>& stiffnesses,
                                const LoadSpring& spring, double bias) {
  constexpr int kPoints = 60;
  analysis::Panel frequency{"load resonance [Hz]", {{"test", {}, {}, true}, {"eq. 4-7", {}, {}}, {"asymptote", {}, {}}}};
  analysis::Panel stiffness = frequency;
  stiffness.ordinate = "actuator [MN/m]";
  const auto add = [&](std::size_t curve, double amplitude, double hertz, double newtons_per_metre) {
    frequency.curves[curve].x.push_back(degrees(amplitude));
    frequency.curves[curve].y.push_back(hertz);
    stiffness.curves[curve].x.push_back(degrees(amplitude));
    stiffness.curves[curve].y.push_back(1e-6 * newtons_per_metre);
  };
  for (const SineStiffness& own : stiffnesses) {
    if (own.test) {
      add(0, own.amplitude, own.test->frequency, own.test->actuator);
    }
  }
  // The responses come in order of amplitude.
  for (const double amplitude : spaced(0.5 * stiffnesses.front().amplitude, 2.0 * stiffnesses.back().amplitude, kPoints)) {
    const ResonanceStiffness expected = expected_stiffness(spring, amplitude, bias);
    add(1, amplitude, expected.frequency, expected.actuator);
    add(2, amplitude, asymptote(spring), spring.loaded);
  }
  return {title, "amplitude of the command [deg]", true, {frequency, stiffness}};
}

analysis::Chart spectrum_chart(const std::string& title, const std::vector<std::string>& labels,
                               const std::vector<analysis::Spectrum>& spectra, double lowest, double highest) {
  analysis::Chart chart{title, "frequency [Hz]", false, {{"density over its largest [dB]", {}}}};
  for (std::size_t s = 0; s < spectra.size(); ++s) {
    analysis::Curve curve{labels[s], {}, {}};
    double largest = 0.0;
    for (std::size_t k = 0; k < spectra[s].density.size(); ++k) {
      const double frequency = static_cast<double>(k) * spectra[s].resolution;
      if (frequency >= lowest && frequency <= highest) {
        curve.x.push_back(frequency);
        curve.y.push_back(spectra[s].density[k]);
        largest = std::max(largest, spectra[s].density[k]);
      }
    }
    std::for_each(curve.y.begin(), curve.y.end(),
                  [largest](double& value) { value = 0.5 * analysis::decibels(value / std::max(largest, 1e-300)); });
    chart.panels.front().curves.push_back(std::move(curve));
  }
  return chart;
}

void write_picture(const analysis::Chart& chart, const std::filesystem::path& path) {
  WholeFile file(path);
  file.write(analysis::svg(chart));
  file.commit();
}

}  // namespace hotfire::trials
