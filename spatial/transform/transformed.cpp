// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/transform/transformed.hpp"

#include <algorithm>
#include <cmath>

#include "data-schema/base/creation_time.hpp"
#include "data-schema/version.hpp"
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

schema::Texture transformed(const schema::Texture& texture, std::vector<double> values,
                            schema::TransformStep step) {
  schema::Texture result;
  result.signal = {texture.signal.pitch_m, texture.signal.origin_m, std::move(values)};
  result.quantity = texture.quantity;
  result.unit = texture.unit;
  result.direction = texture.direction;
  result.source_origin_m = texture.source_origin_m;
  result.valid_band = texture.valid_band;
  result.playback_gain = texture.playback_gain;
  result.transform = texture.transform.value_or(schema::TextureTransform{});
  result.transform->steps.push_back(std::move(step));
  result.simulated = texture.simulated;
  result.surface = texture.surface;
  result.subject = texture.subject;
  result.finger = texture.finger;
  result.notes = texture.notes;
  result.created = schema::creation_time();
  result.creator = kCreator;
  return result;
}

}  // namespace tacto::spatial
