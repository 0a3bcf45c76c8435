// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/render/kept_error.hpp"

#include <algorithm>
#include <functional>

#include "data-schema/recording/statistics.hpp"

namespace tacto::playback {
namespace {

constexpr double kLeftOutAtEnds_s = 1;

double rms_between_ends(const std::vector<double>& values, std::size_t left_out) {
  return schema::statistics_of(std::span(values).subspan(left_out, values.size() - 2 * left_out)).rms();
}

std::vector<double> without(std::vector<double> values, const std::vector<double>& less) {
  std::ranges::transform(values, less, values.begin(), std::minus<>());
  return values;
}

std::vector<double> in_band(const std::vector<double>& values, const PaddedSpectrum& target,
                            const spatial::Band& band) {
  auto spectrum = spectrum_of(values, target.rate_hz, target.period);
  keep_band(spectrum, band);
  return signal_of(spectrum);
}

// The target is filtered to the band with skirts, and so is the reference's displacement; the kernel's is
// not.
std::vector<double> error_of(const Rendering& rendering, const PaddedSpectrum& target,
                             const spatial::Band& band) {
  const auto &modelled_m = rendering.modelled_m.values, &target_m = rendering.target_m.values;
  if (rendering.engine == Engine::kernel) return without(in_band(modelled_m, target, band), target_m);
  return in_band(without(modelled_m, target_m), target, band);
}

}  // namespace

double left_out_at_ends_s(const Rendering& rendering) {
  return std::min(std::max(kLeftOutAtEnds_s, rendering.onset_s), rendering.target_m.duration_s() / 4);
}

double error_between_ends(const Rendering& rendering, const PaddedSpectrum& target,
                          const spatial::Band& band) {
  const auto left_out = static_cast<std::size_t>(left_out_at_ends_s(rendering) * target.rate_hz);
  return rms_between_ends(error_of(rendering, target, band), left_out) /
         rms_between_ends(rendering.target_m.values, left_out);
}

}  // namespace tacto::playback
