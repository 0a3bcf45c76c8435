// SPDX-License-Identifier: GPL-3.0-or-later
// Taps on the layers of a scene, simulated with the device's own kernel on the emulated device.
#pragma once

#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "data-schema/device/device.hpp"
#include "data-schema/device/hand.hpp"
#include "firmware-host/core/scene/force_limiter.hpp"
#include "playback/prepare/scene/prepared_scene.hpp"
#include "playback/stability/acting_patches.hpp"

namespace tacto::analysis {

/// How a tap ends, worst last.
enum class TapEnd {
  rests,       ///< within 1 count RMS, decaying, or beside the layers
  oscillates,  ///< above that, and neither decaying nor growing
  grows,       ///< from quarter to quarter of the time, or of that until it leaves the layers
};

inline constexpr double kRestingPart = 0.02;

/// "rests", "oscillates", "grows".
std::string_view to_string(TapEnd end);

struct SimulatedTap {
  double push_n = 0, speed_mps = 0;  ///< the constant force, and the speed at the beginning
  TapEnd end = TapEnd::rests;
  double rms_counts = 0;       ///< of the place, in the last quarter of the time, about a straight line
  double rms_n = 0;            ///< of the force of the layers, in the same time
  std::vector<double> path_m;  ///< from the place of the tap, at each tick
};

/// One axis at one place.
struct TapPlace {
  std::vector<std::size_t> acting;  ///< patches, as playback::ActingPatches
  std::size_t axis = 0;             ///< of the device
  std::vector<double> place_m;      ///< one number per axis of the device
  std::vector<double> rest_n;       ///< the force of the layers on a hand at rest there
  double sign = 1;                  ///< of the displacement against which the layers are stiffer
  double stiffness_n_per_m = 0;
  double extent_m = 0, restoring_n = 0;  ///< up to where the force grows, and by how much
};

/// Between ticks the motion is in closed form, with the stops of Coulomb friction; encoder, delay and force
/// limits are those of the device (firmware_host::PlanarBody, core::SceneKernel).
class TapBench {
 public:
  /// `scene`: with the sliders where they are to be simulated. `hand`: holds the device, resting at the place
  /// of the tap. Preconditions: `prepared` was made of `scene` for this device; all outlive the bench.
  TapBench(const schema::Scene& scene, const playback::PreparedScene& prepared, const schema::Device& device,
           const core::ForceSetup& setup, const schema::Hand& hand);

  /// Where these patches act and are the stiffest along this axis: among the centres of springs and a grid of
  /// 41 x 41 places. None if there is no such place on the encoder's grid, or if the layers give more force
  /// there than the device for any time.
  std::optional<TapPlace> stiffest(const playback::ActingPatches& place, std::size_t axis) const;

  /// A constant force holds the hand at the place; then `push_n` more pushes it, and it begins with
  /// `speed_mps`, both in the direction of the sign. The stiffness of all layers is multiplied by `factor`.
  SimulatedTap tap(const TapPlace& at, double push_n, double speed_mps, double factor = 1) const;

  /// The worst of nine taps: 0.02, 0.3 and 1 N, each at 0.02, 0.1 and 0.3 m/s; a push is at most 0.4 of what
  /// the layers and the device give, a speed such that half of the extent is passed.
  SimulatedTap worst(const TapPlace& at) const;

  /// The factor on the stiffness up to which all of these taps rest, to kRestingPart of `most`; nothing if
  /// they do at `most`.
  std::optional<double> resting_factor(const TapPlace& at, double most) const;

 private:
  std::vector<std::pair<double, double>> taps(const TapPlace& at, double factor) const;  // push and speed
  std::vector<double> force_at(const std::vector<std::int32_t>& counts) const;
  double restoring_n(const TapPlace& at, double distance_m) const;
  bool acts_at(const TapPlace& at, double from_m) const;

  const schema::Scene& scene_;
  const core::SceneView view_;
  const schema::Device& device_;
  const core::ForceSetup& setup_;
  const schema::Hand& hand_;
  playback::PatchStack stack_;
};

/// With each slider at its upper end; of dampers at the upper or the lower one.
schema::Scene with_sliders_at_ends(schema::Scene scene, bool most_damping);

}  // namespace tacto::analysis
