// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/transform/transform.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <ranges>
#include <utility>
#include <vector>

#include "data-schema/files/files.hpp"
#include "data-schema/texture/texture_wav.hpp"
#include "spatial/dsp/resample/windowed_sinc.hpp"
#include "spatial/numbers/band_at.hpp"
#include "spatial/numbers/welch.hpp"
#include "spatial/texture/space_filter.hpp"
#include "spatial/texture/valid_band.hpp"
#include "spatial/transform/period.hpp"
#include "spatial/transform/transformed.hpp"

namespace tacto::spatial {
namespace {

using schema::BandPoint;
using schema::ErrorKind;
using schema::Result;
using schema::Texture;
using schema::TransformOperation;
using schema::TransformStep;
using Textures = std::span<const Texture>;

bool is_factor(double value) {
  return std::isfinite(value) && value != 0;
}

Result<void> check_mix(Textures textures, std::span<const double> weights) {
  if (textures.size() < 2) return schema::fail(ErrorKind::usage, "a mix needs at least two textures");
  if (!std::ranges::all_of(weights, is_factor))
    return schema::fail(ErrorKind::usage, "a weight must be a finite number other than 0");
  const Texture& first = textures.front();
  for (std::size_t i = 0; i < textures.size(); ++i) {
    const Texture& texture = textures[i];
    const bool named = texture.transform && !texture.transform->sources.empty();
    const std::string where =
        named ? texture.transform->sources.front().texture : fmt::format("texture {}", i + 1);
    if (texture.quantity != first.quantity || texture.unit != first.unit)
      return schema::fail(ErrorKind::unsuitable,
                          fmt::format("contains {} in {}, but the first one {} in {}", texture.quantity,
                                      texture.unit, first.quantity, first.unit),
                          where, "mix textures of one quantity");
    if (texture.simulated.empty() != first.simulated.empty())
      return schema::fail(ErrorKind::unsuitable, "one texture is measured, one simulated", where,
                          "mix measured textures, or simulated ones");
    if (texture.signal.values.size() < kShortestWelchWindow)
      return schema::fail(ErrorKind::unsuitable,
                          fmt::format("has {} samples, a mix needs at least {}", texture.signal.values.size(),
                                      kShortestWelchWindow),
                          where);
  }
  return {};
}

// The texture's values on a grid that is as fine or finer, and what that removed.
Result<BandLimited> on_grid(const Texture& texture, double pitch_m, std::size_t count) {
  const auto& [own_m, origin_m, values] = texture.signal;
  if (own_m == pitch_m)
    return BandLimited{{values.begin(), values.begin() + static_cast<std::ptrdiff_t>(count)}, 0};
  auto limited = band_limited(values, own_m, kInterpolatedShare / own_m, Edges::treated);
  TACTO_TRY(limited);
  const std::size_t reach = std::min(WindowedSinc::kReach, values.size() - 1);
  const auto extended = extend_odd(limited->values, reach);
  const WindowedSinc sinc;
  limited->values.resize(count);
  for (std::size_t i = 0; i < count; ++i)
    limited->values[i] =
        sinc(extended, static_cast<double>(i) * pitch_m / own_m + static_cast<double>(reach));
  return limited;
}

// Where it is valid on a finer grid: not above what is interpolated.
BandPoint band_on_grid(const Texture& texture, double position_m, double pitch_m) {
  BandPoint here = band_at(texture.valid_band, position_m);
  if (texture.signal.pitch_m != pitch_m)
    here.high_per_m = std::min(here.high_per_m, kInterpolatedShare / texture.signal.pitch_m);
  return here;
}

// At every breakpoint of any of them the band that all have; zero width where there is none. A texture
// without a band limits nothing.
std::vector<BandPoint> common_band(Textures textures, double pitch_m, double length_m) {
  std::vector<double> places;
  for (const Texture& texture : textures) {
    if (texture.valid_band.empty()) continue;
    places.insert(places.end(), {0, length_m});
    for (const BandPoint& point : texture.valid_band)
      if (point.position_m > 0 && point.position_m < length_m) places.push_back(point.position_m);
  }
  std::ranges::sort(places);
  places.erase(std::unique(places.begin(), places.end()), places.end());
  std::vector<BandPoint> band;
  for (const double place : places) {
    BandPoint common{place, 0, 0.5 / pitch_m};
    for (const Texture& texture : textures) {
      if (texture.valid_band.empty()) continue;
      const BandPoint here = band_on_grid(texture, place, pitch_m);
      common.low_per_m = std::max(common.low_per_m, here.low_per_m);
      common.high_per_m = std::min(common.high_per_m, here.high_per_m);
    }
    common.high_per_m = std::max(common.low_per_m, common.high_per_m);
    band.push_back(common);
  }
  return band;
}

// Members of the first texture that differ in another one are left out; surfaces and simulations are listed.
void keep_common(Texture& mixed, Textures textures) {
  std::vector<std::string> surfaces, simulations;
  const auto list = [](std::vector<std::string>& all, const std::string& name) {
    if (!name.empty() && std::ranges::find(all, name) == all.end()) all.push_back(name);
  };
  for (const Texture& texture : textures) {
    list(surfaces, texture.surface);
    list(simulations, texture.simulated);
    for (const auto member : {&Texture::subject, &Texture::finger, &Texture::notes})
      if (mixed.*member != texture.*member) (mixed.*member).clear();
    if (mixed.direction != texture.direction) mixed.direction = 1;
    if (mixed.source_origin_m != texture.source_origin_m) mixed.source_origin_m = 0;
    const auto& gain = texture.playback_gain;
    if (mixed.playback_gain && (!gain || gain->gain_m_per_n != mixed.playback_gain->gain_m_per_n))
      mixed.playback_gain.reset();
  }
  mixed.surface = fmt::format("{}", fmt::join(surfaces, "; "));
  mixed.simulated = fmt::format("{}", fmt::join(simulations, "; "));
}

void keep_sources(Texture& mixed, Textures textures) {
  mixed.transform->sources.clear();
  for (const Texture& texture : textures)
    if (texture.transform)
      std::ranges::copy(texture.transform->sources, std::back_inserter(mixed.transform->sources));
}

double whole_length_m(const Texture& texture) {
  return texture.signal.length_m();
}

}  // namespace

Result<Texture> read_transform_source(const std::string& name) {
  auto texture = schema::read_texture(name);
  TACTO_TRY(texture);
  const auto wav = schema::texture_wav(name);
  TACTO_TRY(wav);
  const std::string file = std::filesystem::path(schema::stem_of(name, ".texture")).filename().string();
  texture->transform = schema::TextureTransform{{{file + ".texture.json", wav->sha256}}, {}};
  return texture;
}

Result<Texture> with_gain(const Texture& texture, double gain) {
  if (!is_factor(gain))
    return schema::fail(ErrorKind::usage, "the gain must be a finite number other than 0");
  TransformStep step;
  step.operation = TransformOperation::gain;
  step.factor = gain;
  std::vector<double> values = texture.signal.values;
  for (double& value : values) value *= gain;
  return transformed(texture, std::move(values), std::move(step));
}

Result<Texture> filtered(const Texture& texture, double low_per_m, double high_per_m) {
  const auto period = find_period(texture.signal.values);
  const bool repeats = period && is_whole_periods(texture.signal.values.size(), *period);
  auto values = filter_in_space(
      texture.signal.values, texture.signal.pitch_m,
      {FilterMethod::fourier, low_per_m, high_per_m, repeats ? Edges::none : Edges::treated, 0});
  TACTO_TRY(values);
  TransformStep step;
  step.operation = TransformOperation::filter;
  step.low_per_m = low_per_m;
  step.high_per_m = high_per_m;
  Texture result = transformed(texture, std::move(*values), std::move(step));
  narrow(result.valid_band, low_per_m, high_per_m);
  return result;
}

Result<Texture> mix(Textures textures, std::span<const double> weights) {
  TACTO_TRY(check_mix(textures, weights));
  const auto pitch = [](const Texture& texture) { return texture.signal.pitch_m; };
  const double pitch_m = std::ranges::min(textures, {}, pitch).signal.pitch_m;
  const auto [shortest_m, longest_m] = std::ranges::minmax(textures | std::views::transform(whole_length_m));
  // The last place is on the grid in spite of rounding.
  const auto count = static_cast<std::size_t>(std::floor(shortest_m / pitch_m + 1e-6)) + 1;
  TransformStep step;
  step.operation = TransformOperation::mix;
  step.weights.assign(weights.begin(), weights.end());
  if (longest_m - shortest_m >= pitch_m) step.left_out_m = longest_m - shortest_m;
  std::vector<double> sum(count, 0.0);
  for (std::size_t i = 0; i < textures.size(); ++i) {
    const auto values = on_grid(textures[i], pitch_m, count);
    TACTO_TRY(values);
    for (std::size_t k = 0; k < count; ++k) sum[k] += weights[i] * values->values[k];
    if (values->removed_share > 0) {
      const double above_per_m = kInterpolatedShare / textures[i].signal.pitch_m;
      step.removed_above_per_m = std::min(step.removed_above_per_m.value_or(above_per_m), above_per_m);
      step.removed_share = std::max(step.removed_share.value_or(0), values->removed_share);
    }
  }
  Texture mixed = transformed(textures.front(), std::move(sum), std::move(step));
  mixed.signal.pitch_m = pitch_m;
  mixed.valid_band = common_band(textures, pitch_m, mixed.signal.length_m());
  keep_common(mixed, textures);
  keep_sources(mixed, textures);
  return mixed;
}

}  // namespace tacto::spatial
