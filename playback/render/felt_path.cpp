// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/render/felt_path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace tacto::playback {

using schema::Result;

Result<FeltPath> FeltPath::make(std::span<const PlacedTexture> textures, const FingerPath& path, Ends ends) {
  FeltPath felt(path);
  const auto [low_m, high_m] = std::ranges::minmax(path.position_m);
  felt.start_m_ = textures.front().at_m, felt.end_m_ = felt.start_m_;
  for (const PlacedTexture& placed : textures) {
    auto played =
        as_played(*placed.texture, placed.at_m, prepared_ends(*placed.texture, ends), low_m, high_m, "path");
    TACTO_TRY(played);
    const PlayedSignal& signal = felt.signals_.emplace_back(std::move(*played));
    felt.layers_.push_back({TextureLookup(signal.signal, signal.at_m), placed.weight});
    felt.start_m_ = std::min(felt.start_m_, placed.at_m);
    felt.end_m_ = std::max(felt.end_m_, placed.at_m + placed.texture->signal.length_m());
  }
  return felt;
}

std::size_t FeltPath::count_outside(const ReadingGrid& grid) const {
  const auto positions = positions_along(*path_, grid.rate_hz, grid.samples);
  return static_cast<std::size_t>(std::ranges::count_if(positions, [&](double x) {
    return std::ranges::none_of(layers_, [&](const Layer& layer) { return layer.lookup.contains(x); });
  }));
}

tl::unexpected<schema::Error> FeltPath::never_met() const {
  const auto [low, high] = std::ranges::minmax(path_->position_m);
  const bool several = layers_.size() > 1;
  return schema::fail(
      schema::ErrorKind::unsuitable,
      fmt::format("the finger moves between {:.4g} mm and {:.4g} mm and never meets the texture{}, which "
                  "{} from {:.4g} mm to {:.4g} mm",
                  low * 1e3, high * 1e3, several ? "s" : "", several ? "lie" : "lies", start_m_ * 1e3,
                  end_m_ * 1e3),
      "path", several ? "lay them elsewhere" : "--at lays the texture elsewhere");
}

double FeltPath::fade_m() const {
  double widest_m = 0;
  for (const Layer& layer : layers_) widest_m = std::max(widest_m, layer.lookup.fade_m());
  return widest_m;
}

PaddedSpectrum FeltPath::target(const ReadingGrid& grid, const spatial::Band& band, double gain_m_per_n,
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
