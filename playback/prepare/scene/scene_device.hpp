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

/// Warnings, one line each: an axis x or y that the device does not have; patches beyond its travel, with the
/// share of their area; springs that exceed a peak force, with the share of the patch's places in which they
/// do. Shares are those of a grid of 101 x 101 places.
/// Precondition: the device has an axis x or y.
std::vector<std::string> limits_of_device(const PreparedScene& scene, const schema::Device& device);

}  // namespace tacto::playback
