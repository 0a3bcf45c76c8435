// SPDX-License-Identifier: GPL-3.0-or-later
// Chooses parameters of a scene's layers so that the error of the force is within a bound at every place.
#pragma once

#include <functional>
#include <vector>

#include "analysis/trade/scene/scene_knobs.hpp"
#include "data-schema/device/device.hpp"

namespace tacto::analysis {

/// Bounds of the force's error at any place, for the patches at the places and in the order of the scene.
class ScenePromise {
 public:
  /// Patches in the order of the scene. A knob's choices have to become worse from the first on.
  ScenePromise(const std::vector<schema::Patch>& patches, const schema::Device& device,
               const playback::Reliefs& reliefs, std::vector<LayerKnob> knobs);

  /// One place in the choices of each knob.
  using Places = std::vector<std::size_t>;
  Places unchanged() const { return Places(knobs_.size()); }
  const std::vector<LayerKnob>& knobs() const { return knobs_; }

  /// The largest sum, over the layers that act at one place, of their rounding and their change.
  double error_n(const Places& places) const;

  /// The choices with the steps that save most time for their change, one after the other, as long as
  /// error_n() is at most `max_error_n`, and until `is_enough`, which is
  /// asked before each step and at last for the choices that are returned. `cost_ns`: of each
  /// choice of each knob. Precondition: error_n(unchanged()) is small enough.
  Places chosen(double max_error_n, const std::vector<std::vector<double>>& cost_ns,
                const std::function<bool(const Places&)>& is_enough) const;

 private:
  double change_n(std::size_t knob, std::size_t place) const { return knobs_[knob].choices[place].change_n; }

  std::vector<LayerKnob> knobs_;
  // Of patches that act at one place.
  struct Together {
    double rounding_n = 0;
    std::vector<std::size_t> knobs;
  };
  std::vector<Together> together_;
};

}  // namespace tacto::analysis
