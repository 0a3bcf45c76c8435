// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/render/texture_path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "data-schema/base/quantity.hpp"

namespace tacto::playback {

using schema::Result;

Result<TexturePath> TexturePath::make(std::span<const PlacedTexture> textures, const FingerPath& path,
                                      Ends ends) {
  TexturePath texture_path(path);
  const auto [low_m, high_m] = std::ranges::minmax(path.position_m);
  texture_path.start_m_ = textures.front().at_m, texture_path.end_m_ = texture_path.start_m_;
  for (const PlacedTexture& placed : textures) {
    auto played =
        as_played(*placed.texture, placed.at_m, prepared_ends(*placed.texture, ends), low_m, high_m, "path");
    TACTO_TRY(played);
    const PlayedSignal& signal = texture_path.signals_.emplace_back(std::move(*played));
    texture_path.layers_.push_back({TextureLookup(signal.signal, signal.at_m), placed.weight});
    texture_path.start_m_ = std::min(texture_path.start_m_, placed.at_m);
    texture_path.end_m_ = std::max(texture_path.end_m_, placed.at_m + placed.texture->signal.length_m());
  }
  return texture_path;
}

std::size_t TexturePath::count_outside(const ReadingGrid& grid) const {
  const auto positions = positions_along(*path_, grid.rate_hz, grid.samples);
  return static_cast<std::size_t>(std::ranges::count_if(positions, [&](double x) {
    return std::ranges::none_of(layers_, [&](const Layer& layer) { return layer.lookup.contains(x); });
  }));
}

tl::unexpected<schema::Error> TexturePath::outside_textures() const {
  const auto [low, high] = std::ranges::minmax(path_->position_m);
  const bool several = layers_.size() > 1;
  const auto shown = [](double length_m) { return schema::for_people(length_m, schema::Dimension::length); };
  return schema::fail(
      schema::ErrorKind::unsuitable,
      fmt::format("the finger moves from {} to {}, outside the texture{}, which {} at {} and {} {} long",
                  shown(low), shown(high), several ? "s" : "", several ? "begin" : "begins", shown(start_m_),
                  several ? "are" : "is", shown(end_m_ - start_m_)),
      "path", several ? "move them in the scene" : "--at moves the texture");
}

double TexturePath::fade_m() const {
  double widest_m = 0;
  for (const Layer& layer : layers_) widest_m = std::max(widest_m, layer.lookup.fade_m());
  return widest_m;
}

PaddedSpectrum TexturePath::target(const ReadingGrid& grid, const spatial::Band& band, double gain_m_per_n,
                                   double onset_s) const {
  std::vector<double> readings = reading_places(*path_, grid);
  for (double& value : readings) {
    double force_n = 0;
    for (const Layer& layer : layers_) force_n += layer.weight * layer.lookup(value);
    value = gain_m_per_n * force_n;
  }
  return target_of_readings(std::move(readings), grid, band, onset_s);
}

}  // namespace tacto::playback
