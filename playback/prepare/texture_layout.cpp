// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/prepare/texture_layout.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "data-schema/base/raised_cosine.hpp"
#include "playback/model/texture_lookup.hpp"

namespace tacto::playback {
namespace {

// The ringing of the coarsest levels beyond an end: 2 mm of a level up to 1 /mm leave -60 dB.
constexpr double kMarginM = 2e-3;
// The largest step of content sampled 20 times per period or more is found to 5 %; that of content sampled
// less densely recurs within kLeastNeighbours samples.
constexpr double kAsNeighbours = 1.05;
constexpr std::size_t kLeastNeighbours = 64, kLeastLoop = 8;

schema::SpaceSignal scaled_texture(const PlacedTexture& placed) {
  schema::SpaceSignal signal = placed.texture->signal;
  signal.origin_m = placed.at_m;
  for (double& value : signal.values) value *= placed.weight;
  return signal;
}

std::size_t samples_of_seam(const schema::SpaceSignal& signal, double seam_m) {
  return std::min(static_cast<std::size_t>(std::llround(seam_m / signal.pitch_m)), signal.values.size() / 2);
}

std::vector<double> steps_of(std::span<const double> values) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < values.size(); ++i) steps.push_back(values[i] - values[i - 1]);
  return steps;
}

double largest_of(std::span<const double> values) {
  double largest = 0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

double largest_step(std::span<const double> values) {
  return largest_of(steps_of(values));
}

// The steps are compared with those of `near` samples at each end; all values were rounded to 32-bit float.
bool end_meets_beginning(std::span<const double> values, std::size_t near) {
  const auto head = values.first(near), tail = values.last(near);
  const std::array wrap{tail[near - 2], tail[near - 1], head[0], head[1]};
  const double rounding = 4 * std::ldexp(largest_of(values), -24);
  const auto within = [&](double jump, double at_head, double at_tail) {
    return jump <= kAsNeighbours * std::max(at_head, at_tail) + rounding;
  };
  return within(std::abs(wrap[2] - wrap[1]), largest_step(head), largest_step(tail)) &&
         within(largest_step(steps_of(wrap)), largest_step(steps_of(head)), largest_step(steps_of(tail)));
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
    ++built.textures_placed;
    for (std::size_t i = 0; i < path.values.size(); ++i)
      path.values[i] += placed.weight * lookup(path.position_m(i));
  }
  return path;
}

}  // namespace

double seam_of_loop(const schema::SpaceSignal& signal, double seam_m) {
  const std::size_t seam = samples_of_seam(signal, seam_m), size = signal.values.size();
  const std::size_t near = std::min(std::max(seam, kLeastNeighbours), size / 2);
  if (size >= kLeastLoop && end_meets_beginning(signal.values, near)) return 0;
  return static_cast<double>(seam) * signal.pitch_m;
}

schema::SpaceSignal looped(schema::SpaceSignal signal, double seam_m) {
  auto& values = signal.values;
  const std::size_t seam = samples_of_seam(signal, seam_m), left = values.size() - seam;
  for (std::size_t i = 0; i < seam; ++i) {
    const double u = static_cast<double>(i) / static_cast<double>(seam);
    const double weight = schema::rising_cosine(std::numbers::pi * u);
    values[i] = weight * values[i] + (1 - weight) * values[left + i];
  }
  values.resize(left);
  return signal;
}

schema::SpaceSignal one_period(std::span<const PlacedTexture> textures, Ends ends, double seam_m,
                               ConstructionTally& built) {
  if (ends == Ends::stop) return beside_each_other(textures, built);
  ++built.textures_placed;
  const PlacedTexture& placed = textures.front();
  if (ends == Ends::mirror) return scaled_texture(placed);
  const double cut_m = seam_of_loop(placed.texture->signal, seam_m);
  if (cut_m > 0) ++built.seams;
  return looped(scaled_texture(placed), cut_m);
}

schema::SpaceSignal one_period(std::span<const PlacedTexture> textures, Ends ends, double seam_m) {
  ConstructionTally uncounted;
  return one_period(textures, ends, seam_m, uncounted);
}

double uncovered_length_m(std::span<const PlacedTexture> textures) {
  std::vector<const PlacedTexture*> along;
  for (const PlacedTexture& placed : textures) along.push_back(&placed);
  std::ranges::sort(along, {}, &PlacedTexture::at_m);
  double bare_m = 0, reached_m = along.front()->at_m;
  for (const PlacedTexture* placed : along) {
    bare_m += std::max(0.0, placed->at_m - reached_m);
    reached_m = std::max(reached_m, placed->at_m + placed->texture->signal.length_m());
  }
  return bare_m;
}

}  // namespace tacto::playback
