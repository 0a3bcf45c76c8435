// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/texture_layout.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "playback/texture_lookup.hpp"

namespace tacto::playback {
namespace {

// What the coarsest copies ring beyond an end: 2 mm of a copy up to 1 /mm leave -60 dB.
constexpr double kMarginM = 2e-3;

schema::SpaceSignal scaled_texture(const PlacedTexture& placed) {
  schema::SpaceSignal signal = placed.texture->signal;
  signal.origin_m = placed.at_m;
  for (double& value : signal.values) value *= placed.weight;
  return signal;
}

schema::SpaceSignal without_seam(schema::SpaceSignal signal, double seam_m, ConstructionTally& built) {
  auto& values = signal.values;
  const auto longest = values.size() / 2;
  const std::size_t seam = std::min(static_cast<std::size_t>(std::llround(seam_m / signal.pitch_m)), longest);
  const std::size_t left = values.size() - seam;
  if (seam > 0) ++built.seams;
  for (std::size_t i = 0; i < seam; ++i) {
    const double u = static_cast<double>(i) / static_cast<double>(seam);
    const double weight = 0.5 - 0.5 * std::cos(std::numbers::pi * u);
    values[i] = weight * values[i] + (1 - weight) * values[left + i];
  }
  values.resize(left);
  return signal;
}

schema::SpaceSignal beside_each_other(std::span<const PlacedTexture> textures, ConstructionTally& built) {
  double pitch_m = textures.front().texture->signal.pitch_m, from_m = textures.front().at_m, to_m = from_m;
  for (const PlacedTexture& placed : textures) {
    pitch_m = std::min(pitch_m, placed.texture->signal.pitch_m);
    from_m = std::min(from_m, placed.at_m);
    to_m = std::max(to_m, placed.at_m + placed.texture->signal.length_m());
  }
  schema::SpaceSignal path{pitch_m, from_m - kMarginM, {}};
  path.values.resize(static_cast<std::size_t>(std::ceil((to_m - from_m + 2 * kMarginM) / pitch_m)) + 1);
  for (const PlacedTexture& placed : textures) {
    const TextureLookup lookup(placed.texture->signal, placed.at_m);
    ++built.textures_laid;
    for (std::size_t i = 0; i < path.values.size(); ++i)
      path.values[i] += placed.weight * lookup(path.position_m(i));
  }
  return path;
}

}  // namespace

schema::SpaceSignal laid_out(std::span<const PlacedTexture> textures, Ends ends, double seam_m,
                             ConstructionTally& built) {
  if (ends == Ends::stop) return beside_each_other(textures, built);
  ++built.textures_laid;
  if (ends == Ends::mirror) return scaled_texture(textures.front());
  return without_seam(scaled_texture(textures.front()), seam_m, built);
}

schema::SpaceSignal laid_out(std::span<const PlacedTexture> textures, Ends ends, double seam_m) {
  ConstructionTally uncounted;
  return laid_out(textures, ends, seam_m, uncounted);
}

}  // namespace tacto::playback
