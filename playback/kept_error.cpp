// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/kept_error.hpp"

#include <algorithm>
#include <functional>

#include "data-schema/statistics.hpp"

namespace tacto::playback {
namespace {

constexpr double kLeftOutAtEnds_s = 1;

double rms_between_ends(const std::vector<double>& values, double rate_hz) {
  const auto left_out = std::min(static_cast<std::size_t>(kLeftOutAtEnds_s * rate_hz), values.size() / 4);
  return schema::statistics_of(std::span(values).subspan(left_out, values.size() - 2 * left_out)).rms();
}

std::vector<double> without(std::vector<double> values, const std::vector<double>& less) {
  std::ranges::transform(values, less, values.begin(), std::minus<>());
  return values;
}

std::vector<double> in_band(const std::vector<double>& values, const PaddedSpectrum& wanted,
                            const spatial::Band& band) {
  auto spectrum = spectrum_of(values, wanted.rate_hz, wanted.period);
  keep_band(spectrum, band);
  return signal_of(spectrum);
}

// What is wanted has been through the band's skirts, and so has what the reference plays of it; the kernel
// plays all that there is.
std::vector<double> error_of(const Rendering& rendering, const PaddedSpectrum& wanted,
                             const spatial::Band& band) {
  const auto &modelled_m = rendering.modelled_m.values, &wanted_m = rendering.wanted_m.values;
  if (rendering.engine == Engine::kernel) return without(in_band(modelled_m, wanted, band), wanted_m);
  return in_band(without(modelled_m, wanted_m), wanted, band);
}

}  // namespace

double error_between_ends(const Rendering& rendering, const PaddedSpectrum& wanted,
                          const spatial::Band& band) {
  return rms_between_ends(error_of(rendering, wanted, band), wanted.rate_hz) /
         rms_between_ends(rendering.wanted_m.values, wanted.rate_hz);
}

}  // namespace tacto::playback
