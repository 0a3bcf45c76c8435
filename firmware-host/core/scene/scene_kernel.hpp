// SPDX-License-Identifier: Apache-2.0
// The tick of a scene in a plane: from the counts of the axes to the forces on the hand.
#pragma once

#include "firmware-host/core/kernel/envelope.hpp"
#include "firmware-host/core/scene/edge_speed.hpp"
#include "firmware-host/core/scene/force_limiter.hpp"
#include "firmware-host/core/scene/scene_block.hpp"

namespace tacto::core {

inline constexpr uint32_t kMostRamps = 16;

/// Forces on the hand, in the order of the device's axes.
struct ForceOutput {
  float force_n[kMostAxes] = {};
  float unlimited_n[kMostAxes] = {};  ///< before the limits
  uint32_t flags = 0;                 ///< wire::TickFlag: amplitude, slew, energy
  bool sound = true;                  ///< false if a force was not finite; then all fall to zero
};

/// force = limits(envelope x sum over patches (sum over layers)) (Minsky 1990), of the topmost patch at the
/// hand's place and of every patch there that adds. In the axes of a patch, from its centre:
///   spring: -stiffness (place - centre);  damper: -damping speed;  surface: -kappa grad h.
/// place = counts x metres_per_count, on a surface in whole counts (place_on()); speed by EdgeSpeed, only in
/// a scene with a layer that depends on it. Of a surface, frequencies above half the rate at this speed are
/// not played (held_by_rate(); of an octave of noise up to kNoiseCycles; of a height map one of its levels or
/// two, mixed). Without the axis x or y the hand
/// stays at 0 along it; an axis z gets no force. Single precision, no contraction, of libm only the square
/// root: the same bits on host and device. Against double precision (ExactScene) at places up to 0.1 m:
/// within 3e-7 of the sum of the absolute forces of all layers. No function allocates, locks, throws or makes
/// system calls; a tick costs at most one step per patch and layer.
class SceneKernel {
 public:
  /// Starts at rest at zero, with the numbers of the block. The block, and `live` with memory for
  /// scene.number_count numbers, have to outlive their use by the kernel.
  void set(const SceneView& scene, const ForceSetup& setup, float* live) noexcept;
  /// Between ticks: from the next tick on a number changes linearly, and has its new value after
  /// `ramp_ticks` (at least one). If kMostRamps others change already, the oldest one ends at once.
  /// Precondition: number_fits().
  void change(uint32_t layer, uint32_t number, float value, float ramp_ticks) noexcept;
  /// `counts` of the setup's axes; `raise`: towards the full force, otherwise towards zero.
  ForceOutput tick(const int32_t* counts, bool raise) noexcept;
  float rate_hz() const noexcept { return setup_.rate_hz; }
  bool at_rest() const noexcept { return envelope_.at_rest() && limiter_.at_rest(); }

 private:
  // Of one tick, along x and y.
  struct Hand {
    int32_t counts[2] = {};
    PlaneVector place_m, speed_mps;
  };
  PlaneVector force(const Hand& hand) const noexcept;
  PlaneVector force_in(const ScenePatch& patch, const Hand& hand, PlaneVector place) const noexcept;
  PlaneVector groove_force(const SceneLayer& layer, const Hand& hand, PlaneVector speed) const noexcept;
  PlaneVector noise_force(const SceneLayer& layer, const Hand& hand) const noexcept;
  PlaneVector relief_force(const SceneLayer& layer, const Hand& hand) const noexcept;

  struct Ramp {
    uint32_t number = 0;  // in the scene's numbers
    uint32_t left = 0;    // ticks
    float step = 0, to = 0;
  };
  void advance_ramps() noexcept;

  SceneView scene_;
  float* live_ = nullptr;
  Ramp ramps_[kMostRamps];
  uint32_t next_ramp_ = 0;
  ForceSetup setup_;
  EdgeSpeed speeds_[2];  // along x and y
  Envelope envelope_;
  ForceLimiter limiter_;
};

}  // namespace tacto::core
