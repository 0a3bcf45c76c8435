// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/kept_error.hpp"

#include <algorithm>
#include <functional>

#include "data-schema/statistics.hpp"

namespace tacto::playback {
namespace {

constexpr double kLeftOutAtEnds_s = 0.5;

double rms_between_ends(const std::vector<double>& values, double rate_hz) {
  const auto left_out = std::min(static_cast<std::size_t>(kLeftOutAtEnds_s * rate_hz), values.size() / 4);
  return schema::statistics_of(std::span(values).subspan(left_out, values.size() - 2 * left_out)).rms();
}

}  // namespace

double error_between_ends(const Rendering& rendering, const PaddedSpectrum& wanted,
                          const spatial::Band& band) {
  std::vector<double> difference(rendering.wanted_m.values.size());
  std::ranges::transform(rendering.modelled_m.values, rendering.wanted_m.values, difference.begin(),
                         std::minus<>());
  auto error = spectrum_of(difference, wanted.rate_hz, wanted.period);
  keep_band(error, band);
  std::vector<double> in_band = signal_of(error);
  in_band.resize(difference.size());
  return rms_between_ends(in_band, wanted.rate_hz) /
         rms_between_ends(rendering.wanted_m.values, wanted.rate_hz);
}

}  // namespace tacto::playback
