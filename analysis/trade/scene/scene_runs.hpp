// SPDX-License-Identifier: GPL-3.0-or-later
// The hand's paths over a scene, and the forces along them: by the kernel and by its reference.
#pragma once

#include <cstdint>
#include <vector>

#include "firmware-host/core/scene/scene_kernel.hpp"
#include "playback/model/finger_path.hpp"
#include "playback/prepare/scene/prepared_scene.hpp"

namespace tacto::analysis {

/// A path per axis of playback::plane_axes_of().
using PlanePath = std::vector<playback::FingerPath>;

/// Across each patch from corner to corner, within the travel, at each of kTradeSpeeds_mps.
std::vector<PlanePath> strokes_over(const std::vector<schema::Patch>& patches, const schema::Device& device);

/// The counts of the device's axes, one row per tick.
using CountRows = std::vector<std::vector<std::int32_t>>;
CountRows hand_counts(const PlanePath& path, const schema::Device& device, double rate_hz);

/// Before the limits of the device, of all axes, tick after tick.
using ForceRows = std::vector<std::vector<double>>;
ForceRows kernel_forces(const playback::PreparedScene& scene, const core::ForceSetup& setup,
                        const CountRows& counts);
ForceRows exact_forces(const playback::PreparedScene& scene, const schema::Device& device, double rate_hz,
                       const CountRows& counts);

/// Lengths of force vectors over ticks.
struct ForceSizes {
  double largest_n = 0, square_sum = 0;
  std::size_t ticks = 0;
  void add(const std::vector<double>& force_n);
  double rms_n() const;
};

/// Adds the differences to `sizes`; the forces of a lower rate are held until their next tick. `part`: their
/// rate relative to that of the reference.
void add_differences(const ForceRows& forces, const ForceRows& reference, double part, ForceSizes& sizes);

/// CPU time of a tick of each scene with its own counts, on this computer: the median of 15 runs, in turns.
struct TimedScene {
  playback::PreparedScene scene;
  core::ForceSetup setup;
  const CountRows* counts = nullptr;  ///< at least one row
};
std::vector<double> tick_costs_ns(const std::vector<TimedScene>& scenes);

}  // namespace tacto::analysis
