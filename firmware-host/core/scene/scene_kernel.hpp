// SPDX-License-Identifier: Apache-2.0
// The tick of a scene in a plane or in space: from the counts of the axes to the forces on the hand.
#pragma once

#include "firmware-host/core/kernel/envelope.hpp"
#include "firmware-host/core/scene/edge_speed.hpp"
#include "firmware-host/core/scene/force_limiter.hpp"
#include "firmware-host/core/scene/ghost_point.hpp"
#include "firmware-host/core/scene/relief.hpp"
#include "firmware-host/core/scene/scene_block.hpp"

namespace tacto::core {

inline constexpr uint32_t kMostRamps = 16;  ///< of numbers, and of places

/// Forces on the hand, in the order of the device's axes.
struct ForceOutput {
  float force_n[kMostAxes] = {};
  float unlimited_n[kMostAxes] = {};  ///< before the limits
  uint32_t flags = 0;                 ///< wire::TickFlag: amplitude, slew, energy
  bool sound = true;                  ///< false if a force was not finite; then all fall to zero
};

/// force = limits(envelope x sum over patches (sum over layers)) (Minsky 1990), of the topmost patch at the
/// hand's place and of every patch there that adds. In the axes of a patch, from its centre:
///   spring: -stiffness (place - centre);  damper: -damping speed;  surface: -kappa grad h;
///   tick damper: -damping (place - place one tick ago) rate, 0 in the first tick;
///   field: sum over its atoms;  force map: gain times its forces;
///   mover: damping (its speed - speed);  body, lasso: the reaction to the force on them (body.hpp).
/// A body is taken up where the hand enters its patch, at rest in it; while the hand is elsewhere, or another
/// patch covers it, the body is not there. Its force is computed once a tick and held for the hand and for
/// the body: the body loses the momentum that the hand gets, and both motions under a held force are exact.
/// place = counts x metres_per_count, on a surface in whole counts (place_on()); speed by EdgeSpeed, only in
/// a scene with a layer that depends on it. A patch is moved by whole counts, with all that belongs to its
/// place: its force at count n, moved by m, is to the bit that of the patch of the block at n - m. A damper
/// resists the speed of the hand, also while its patch moves; a surface is played at the speed relative to
/// it. Of a surface, frequencies above half the rate at this speed are not played (held_by_rate(); of an
/// octave of noise up to kNoiseCycles; of a height or force map one of its levels or two, mixed; the last
/// level of a force map at all higher speeds, because its mean is a force). Without the axis x
/// or y the hand stays at 0 along it; an axis z gets no force. In a scene of pieces in space the force is
/// that of GhostPoint, along all axes; move() and raise() of its patch do nothing. Single precision, no
/// contraction, of libm only the square root: the same bits on host and device. Against double precision
/// (ExactScene) at places up to 0.1 m: within 3e-7 of the sum of the absolute forces of all layers. No
/// function allocates, locks, throws or makes system calls; a tick costs at most one step per patch and
/// layer.
class SceneKernel {
 public:
  /// Starts at rest at zero, with the numbers, places and order of the block. The block, and `live` with
  /// scene.live_words(), have to outlive their use by the kernel.
  void set(const SceneView& scene, const ForceSetup& setup, float* live) noexcept;
  /// Between ticks: from the next tick on a number changes linearly, and has its new value after
  /// `ramp_ticks` (at least one). If kMostRamps others change already, the oldest one ends at once.
  /// Precondition: number_fits().
  void change(uint32_t layer, uint32_t number, float value, float ramp_ticks) noexcept;
  /// The same for the place of a patch: `counts` along x and y from its place in the block. After k of n
  /// ticks it is moved by k / n of the way, rounded to a whole count towards its beginning. Along an axis
  /// that the device does not have, a count is as long as one of the other axis. Preconditions: the scene
  /// has this patch; counts within kFarthestMove.
  void move(uint32_t patch, const int32_t (&counts)[2], float ramp_ticks) noexcept;
  /// Between ticks: this patch becomes the topmost one; the order of the others stays.
  void raise(uint32_t patch) noexcept;
  /// `counts` of the setup's axes; `raise`: towards the full force, otherwise towards zero.
  ForceOutput tick(const int32_t* counts, bool raise) noexcept;
  /// Whether a body or lasso is this layer and acted in the last tick; then sets its place in the plane, in
  /// m.
  bool body_place(uint32_t patch, uint32_t layer, PlaneVector& place_m) const noexcept;
  /// A number of a layer as the last tick used it. Precondition: number_fits() for some value.
  float number(uint32_t layer, uint32_t number) const noexcept {
    return live_[scene_.layers[layer].first_number + number];
  }
  /// In a scene of pieces whose contact is the ghost: where it is along x, y or z, in m.
  float ghost_m(uint32_t along) const noexcept {
    const float rest_m[] = {ghost_.place().rest_m.x, ghost_.place().rest_m.y, ghost_.place().rest_m.z};
    return step_m_[along] * static_cast<float>(ghost_.place().counts[along]) + rest_m[along];
  }
  /// Of a layer that is a piece with a SlideTable: its place along its axis.
  float slid_m(uint32_t layer) const noexcept {
    const auto kind = static_cast<SceneLayerKind>(scene_.layers[layer].kind);
    const float* const number = live_ + scene_.layers[layer].first_number;
    return reinterpret_cast<const WallState*>(number + changeable_numbers_of(kind))->slid_m;
  }
  const SceneView& scene() const noexcept { return scene_; }
  /// The same with the numbers and tables as they are after the last tick.
  SceneView scene_now() const noexcept { return scene_.as_in(live_); }
  float rate_hz() const noexcept { return setup_.rate_hz; }
  bool at_rest() const noexcept { return envelope_.at_rest() && limiter_.at_rest(); }

 private:
  // Of one tick, along x and y; on a patch relative to where it is in the block.
  struct Hand {
    int32_t counts[2] = {};
    PlaneVector place_m;
    PlaneVector speed_mps, along_mps;  // of the hand; relative to the patch
    PlaneVector tick_speed_mps;        // of the hand: the difference of two ticks
  };
  PlaneVector force(const Hand& hand) noexcept;
  SpaceVector force_in_plane(const int32_t* counts) noexcept;
  SpaceVector force_in_space(const int32_t* counts) noexcept;
  PlaneVector force_in(const ScenePatch& patch, const Hand& hand) noexcept;
  Hand hand_on(uint32_t patch, const Hand& hand) const noexcept;
  PlaneVector groove_force(const SceneLayer& layer, const Hand& hand, PlaneVector along) const noexcept;
  PlaneVector noise_force(const SceneLayer& layer, const Hand& hand) const noexcept;
  PlaneVector field_force(const SceneLayer& layer, const Hand& hand) const noexcept;
  PlaneVector relief_force(const SceneLayer& layer, const Hand& hand, PlaneVector along) const noexcept;
  PlaneVector map_force(const SceneLayer& layer, const Hand& hand, PlaneVector along) const noexcept;
  PlayedLevels levels_at(const ReliefTable& table, const Hand& hand, PlaneVector along) const noexcept;
  PlaneVector body_force(const SceneLayer& layer, const Hand& hand, PlaneVector along) noexcept;

  struct Ramp {
    uint32_t number = 0;  // in the scene's numbers
    uint32_t left = 0;    // ticks
    float step = 0, to = 0;
  };
  void advance_ramps() noexcept;

  // `each` counts per tick, and one more in `rest` of `ticks` ticks, evenly.
  struct Way {
    int32_t to = 0, each = 0, more = 0;
    uint32_t rest = 0, sum = 0;
    float per_tick = 0;
    int32_t step(uint32_t ticks) noexcept;
  };
  struct Move {
    uint32_t patch = 0, left = 0, ticks = 0;
    Way ways[2];
  };
  void advance_moves() noexcept;
  PlaneVector speed_of(uint32_t patch) const noexcept;

  SceneView scene_;
  // In the memory of the caller: the numbers; of each patch the counts by which it is moved; the order.
  float* live_ = nullptr;
  int32_t (*moved_)[2] = nullptr;
  uint32_t* order_ = nullptr;
  Ramp ramps_[kMostRamps];
  Move moves_[kMostRamps];
  uint32_t next_ramp_ = 0, next_move_ = 0;
  bool moving_ = false;
  ForceSetup setup_;
  float step_m_[3] = {};            // of a count along x, y and z
  float tick_ = 1, last_tick_ = 1;  // whole numbers above 1 from the first tick on
  int32_t last_counts_[2] = {};
  bool has_last_counts_ = false;
  EdgeSpeed speeds_[3];
  GhostPoint ghost_;
  Envelope envelope_;
  ForceLimiter limiter_;
};

}  // namespace tacto::core
