// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/transform/band_limit.hpp"

#include <algorithm>
#include <cmath>

#include "spatial/numbers/welch.hpp"
#include "spatial/texture/space_filter.hpp"

namespace tacto::spatial {
namespace {

constexpr std::size_t kLimitWindow = 4096;
constexpr double kNothing = 1e-5;  // the error of the interpolation

}  // namespace

schema::Result<BandLimited> band_limited(std::span<const double> values, double pitch_m, double high_per_m,
                                         Edges edges) {
  const WelchSpectrum spectrum(values, pitch_m, std::min(values.size(), kLimitWindow));
  const double above = spectrum.power(high_per_m, 0.5 / pitch_m), all = spectrum.power(0, 0.5 / pitch_m);
  const double share = all > 0 ? std::sqrt(above / all) : 0;
  if (share < kNothing) return BandLimited{{values.begin(), values.end()}, 0};
  auto kept = filter_in_space(values, pitch_m, {FilterMethod::fourier, 0, high_per_m, edges, 0});
  TACTO_TRY(kept);
  return BandLimited{std::move(*kept), share};
}

}  // namespace tacto::spatial
