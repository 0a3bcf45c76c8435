// SPDX-License-Identifier: GPL-3.0-or-later
// A force device as the kernel of a scene needs it, and what of a scene the device cannot give.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "data-schema/device/device.hpp"
#include "firmware-host/core/scene/force_limiter.hpp"
#include "playback/prepare/scene/prepared_scene.hpp"

namespace tacto::playback {

/// The largest of the device's rates, unless one is given. Errors: unsuitable, if it is not one of the
/// device's rates, or if the device has neither an axis x nor y: a scene is in the plane of x and y.
schema::Result<core::ForceSetup> force_setup_of(const schema::Device& device, std::optional<double> rate_hz);

/// The largest stiffness of a layer for a small motion, with the upper ends of its sliders: of a spring, and
/// kappa times the largest curvature of grooves, of a height map that was read (read_reliefs()), of noise
/// the sum of those of its octaves; of a texture that was read the gain times its steepest slope; of a field
/// that was read its force_scale times stiffest_n_per_m. 0 for other types.
double local_stiffness_n_per_m(const schema::ForceLayer& layer);

/// A warning with the share of a patch's area that is outside the device's travel; empty if none is.
std::string note_of_travel(const schema::Patch& patch, const schema::Device& device);

/// Warnings, one line each, of pieces by limits_of_pieces(); of patches: an axis x or y that the device does
/// not have; patches beyond its travel, with the share of their area; patches whose force on a hand at rest
/// exceeds a peak force, with the share of the places in which it does; patches larger than their height map
/// or texture; where layers that act together are beyond stiffness_limit_of(), that of them which is the
/// farthest. Shares are those of a grid of 101 x 101 places. Precondition: the scene was prepared for this
/// device and hand; `setup` by force_setup_of().
std::vector<std::string> limits_of_device(const PreparedScene& scene, const schema::Device& device,
                                          const core::ForceSetup& setup,
                                          const std::optional<schema::Hand>& hand = std::nullopt);

}  // namespace tacto::playback
