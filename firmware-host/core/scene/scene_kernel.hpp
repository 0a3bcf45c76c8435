// SPDX-License-Identifier: Apache-2.0
// The tick of a scene in a plane: from the counts of the axes to the forces on the hand.
#pragma once

#include "firmware-host/core/kernel/envelope.hpp"
#include "firmware-host/core/scene/edge_speed.hpp"
#include "firmware-host/core/scene/force_limiter.hpp"
#include "firmware-host/core/scene/scene_block.hpp"

namespace tacto::core {

/// Forces on the hand, in the order of the device's axes.
struct ForceOutput {
  float force_n[kMostAxes] = {};
  float unlimited_n[kMostAxes] = {};  ///< before the limits
  uint32_t flags = 0;                 ///< wire::TickFlag: amplitude, slew, energy
  bool sound = true;                  ///< false if a force was not finite; then all fall to zero
};

/// force = limits(envelope x sum over patches (sum over layers)) (Minsky 1990), of the topmost patch at the
/// hand's place and of every patch there that adds. In the axes of a patch, from its centre:
///   spring: -stiffness (place - centre);  damper: -damping speed.
/// place = counts x metres_per_count; speed by EdgeSpeed, only in a scene that has a damper. Without the axis
/// x or y the hand stays at 0 along it; an axis z gets no force. Single precision, no contraction, of libm
/// only the square root: the same bits on host and device. Against double precision (ExactScene) at places up
/// to 0.1 m: within 3e-7 of the sum of the absolute forces of all layers. No function allocates, locks,
/// throws or makes system calls; a tick costs at most one step per patch and layer.
class SceneKernel {
 public:
  /// Starts at rest at zero. The block has to outlive its use by the kernel.
  void set(const SceneView& scene, const ForceSetup& setup) noexcept;
  /// `counts` of the setup's axes; `raise`: towards the full force, otherwise towards zero.
  ForceOutput tick(const int32_t* counts, bool raise) noexcept;
  bool at_rest() const noexcept { return envelope_.at_rest() && limiter_.at_rest(); }

 private:
  PlaneVector force(PlaneVector place, PlaneVector speed) const noexcept;
  PlaneVector force_in(const ScenePatch& patch, PlaneVector place, PlaneVector speed) const noexcept;

  SceneView scene_;
  ForceSetup setup_;
  EdgeSpeed speeds_[2];  // along x and y
  Envelope envelope_;
  ForceLimiter limiter_;
};

}  // namespace tacto::core
