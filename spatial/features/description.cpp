// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/features/description.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "data-schema/base/decibels.hpp"
#include "data-schema/base/quantity.hpp"
#include "spatial/features/steady_part.hpp"
#include "spatial/features/third_octaves.hpp"
#include "spatial/numbers/welch.hpp"
#include "spatial/texture/make_texture.hpp"
#include "spatial/texture/valid_band.hpp"

namespace tacto::spatial {
namespace {

using schema::BandPoint;
using schema::Description;
using schema::Dimension;
using schema::ErrorKind;
using schema::Result;
using schema::Texture;
using schema::ThirdOctaveBand;

BandPoint valid_band_of(const Texture& texture) {
  if (texture.valid_band.empty()) return {0, 0, INFINITY};
  return band_throughout(texture.valid_band);
}

// Long enough to separate the lowest band from its neighbours, and not longer, so that many windows are
// averaged.
double usual_window_m(const Texture& texture, double low_per_m) {
  constexpr double kWavelengths = 8;
  const double length_m = static_cast<double>(texture.signal.values.size()) * texture.signal.pitch_m;
  const double target_m = low_per_m > 0 ? std::max(kWavelengths / low_per_m, length_m / 4) : length_m / 4;
  return std::min(target_m, length_m);
}

Result<std::size_t> window_samples(const Texture& texture, const DescriptionOptions& options,
                                   double low_per_m) {
  const double pitch_m = texture.signal.pitch_m;
  const std::size_t have = texture.signal.values.size();
  const double target = options.window_m.value_or(usual_window_m(texture, low_per_m)) / pitch_m;
  const double samples =
      options.window_m ? target : std::max(target, static_cast<double>(kShortestWelchWindow));
  if (std::isfinite(samples) && samples >= kShortestWelchWindow - 0.5 &&
      samples < static_cast<double>(have) + 0.5)
    return static_cast<std::size_t>(std::llround(samples));
  return schema::fail(
      ErrorKind::usage,
      fmt::format("a window of {} cannot be used", schema::for_people(target * pitch_m, Dimension::length)),
      "window",
      fmt::format("use {} to {} (the length of the texture)",
                  schema::for_people(kShortestWelchWindow * pitch_m, Dimension::length),
                  schema::for_people(static_cast<double>(have) * pitch_m, Dimension::length)));
}

std::vector<ThirdOctaveBand> bands_of(const WelchSpectrum& spectrum, double low_per_m, double high_per_m) {
  auto bands = third_octaves(low_per_m, high_per_m);
  for (ThirdOctaveBand& band : bands) {
    const double from = std::max(band.low_per_m, low_per_m), to = std::min(band.high_per_m, high_per_m);
    const double power = spectrum.power(from, to);
    band.rms = std::sqrt(power);
    band.density = power / (to - from);
  }
  return bands;
}

// Weighted least squares; the formula is in the header.
double slope_of(const std::vector<ThirdOctaveBand>& bands, double low_per_m, double high_per_m) {
  if (!(high_per_m >= 2 * low_per_m)) return NAN;
  double w = 0, wx = 0, wy = 0, wxx = 0, wxy = 0;
  for (const ThirdOctaveBand& band : bands) {
    if (!(band.density > 0)) continue;
    const double from = std::max(band.low_per_m, low_per_m), to = std::min(band.high_per_m, high_per_m);
    const double weight = std::log2(to / from);
    const double x = 0.5 * std::log2(from * to), y = schema::power_db(band.density);
    w += weight;
    wx += weight * x;
    wy += weight * y;
    wxx += weight * x * x;
    wxy += weight * x * y;
  }
  const double spread = w * wxx - wx * wx;
  return spread > 0 ? (w * wxy - wx * wy) / spread : NAN;
}

Description header_of(const Texture& texture, const SteadyPart& part) {
  Description description;
  description.quantity = texture.quantity;
  description.unit = texture.unit;
  description.length_m = texture.signal.length_m();
  description.from_m = part.from_m;
  description.to_m = part.to_m;
  description.pitch_m = texture.signal.pitch_m;
  description.mean_speed_mps = texture.source.mean_speed_mps;
  description.total_rms = rms_of(part.texture);
  description.simulated = texture.simulated;
  return description;
}

void add_spectrum(Description& description, const WelchSpectrum& spectrum) {
  const double low = description.low_per_m, high = description.high_per_m;
  const double power = spectrum.power(low, high);
  description.rms = std::sqrt(power);
  description.centroid_per_m = power > 0 ? spectrum.moment(low, high) / power : NAN;
  description.bands = bands_of(spectrum, low, high);
  description.slope_db_per_octave = slope_of(description.bands, low, high);
}

}  // namespace

Result<Description> describe(const Texture& texture, const DescriptionOptions& options) {
  if (texture.signal.values.size() < kShortestWelchWindow)
    return schema::fail(ErrorKind::unsuitable,
                        fmt::format("has {} samples, too few for a spectrum", texture.signal.values.size()),
                        "texture");
  const SteadyPart part = steady_part(texture);
  const BandPoint valid = valid_band_of(part.texture);
  const auto window = window_samples(part.texture, options, valid.low_per_m);
  TACTO_TRY(window);
  Description description = header_of(texture, part);
  description.window_m = static_cast<double>(*window) * texture.signal.pitch_m;
  description.low_per_m = std::max(valid.low_per_m, 1.5 / description.window_m);
  description.high_per_m = std::min(valid.high_per_m, 0.5 / texture.signal.pitch_m);
  if (!(description.low_per_m < description.high_per_m))
    return schema::fail(ErrorKind::unsuitable,
                        "no frequency band is valid along the whole part at steady speed", "texture",
                        "make it from a section with a steadier speed, or use a longer --window");
  add_spectrum(description, WelchSpectrum(part.texture.signal.values, texture.signal.pitch_m, *window));
  return description;
}

}  // namespace tacto::spatial
