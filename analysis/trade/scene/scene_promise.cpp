// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/trade/scene/scene_promise.hpp"

#include <algorithm>

#include "playback/stability/acting_patches.hpp"

namespace tacto::analysis {
namespace {

// Both of two patches that touch act on their border, which has no area.
constexpr double kBorder_m = 1e-6;

std::vector<schema::Patch> with_borders(std::vector<schema::Patch> patches) {
  for (schema::Patch& patch : patches) {
    patch.width_m += 2 * kBorder_m;
    patch.height_m += 2 * kBorder_m;
  }
  return patches;
}

}  // namespace

ScenePromise::ScenePromise(const std::vector<schema::Patch>& patches, const schema::Device& device,
                           const playback::Reliefs& reliefs, std::vector<LayerKnob> knobs)
    : knobs_(std::move(knobs)) {
  for (const playback::ActingPatches& place : playback::acting_patches(with_borders(patches), device)) {
    Together together;
    for (const std::size_t i : place.patches) {
      for (const schema::ForceLayer& layer : patches[i].layers)
        together.rounding_n += rounding_bound_n(patches[i], layer, reliefs);
      for (std::size_t knob = 0; knob < knobs_.size(); ++knob)
        if (knobs_[knob].patch == i) together.knobs.push_back(knob);
    }
    together_.push_back(std::move(together));
  }
}

double ScenePromise::error_n(const Places& places) const {
  double largest = 0;
  for (const Together& together : together_) {
    double sum = together.rounding_n;
    for (const std::size_t knob : together.knobs) sum += change_n(knob, places[knob]);
    largest = std::max(largest, sum);
  }
  return largest;
}

ScenePromise::Places ScenePromise::chosen(double max_error_n, const std::vector<std::vector<double>>& cost_ns,
                                          const std::function<bool(const Places&)>& is_enough) const {
  constexpr double kLeastSaved_ns = 1e-3;  // a measured cost may fail to fall
  constexpr double kLeastChange_n = 1e-12;
  Places places = unchanged();
  while (!is_enough(places)) {
    std::size_t best = knobs_.size();
    double most = 0;
    for (std::size_t knob = 0; knob < knobs_.size(); ++knob) {
      Places next = places;
      if (++next[knob] == knobs_[knob].choices.size() || error_n(next) > max_error_n) continue;
      const double saved = std::max(cost_ns[knob][places[knob]] - cost_ns[knob][next[knob]], kLeastSaved_ns);
      const double change =
          std::max(change_n(knob, next[knob]) - change_n(knob, places[knob]), kLeastChange_n);
      if (saved / change <= most) continue;
      most = saved / change;
      best = knob;
    }
    if (best == knobs_.size()) break;
    ++places[best];
  }
  return places;
}

}  // namespace tacto::analysis
