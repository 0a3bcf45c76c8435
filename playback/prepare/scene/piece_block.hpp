// SPDX-License-Identifier: GPL-3.0-or-later
// From the pieces of a scene to the block that the kernel of a device reads.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "playback/prepare/scene/prepared_scene.hpp"

namespace tacto::playback {

/// The block of the pieces for one device. `where` is the scene's file. Errors: unsuitable, by JSON pointer:
/// a place beyond 2^30 counts; a wall whose integral is unstable (wall_growth()); transient_table().
schema::Result<PreparedScene> prepare_pieces(const schema::Scene& scene, const std::string& where,
                                             const schema::Device& device, double rate_hz,
                                             const std::optional<schema::Hand>& hand);

/// By how much a motion on this wall grows per tick, beside an axis of the device that nothing pushes: the
/// largest absolute eigenvalue of the motion from tick to tick, with spring, damper, integral, and the delay
/// rounded up to whole ticks; above 1 it is unstable. Of a hand its mass and damping are counted. Coulomb
/// friction is left out, and the force limit. Of all axes the largest; 0 if the device states no mass.
double wall_growth(const schema::Piece& piece, const schema::Device& device, double rate_hz,
                   const std::optional<schema::Hand>& hand);

/// Warnings, one line each: axes that the device does not have; walls beyond stiffness_limit_of(); transients
/// that the limits of the device cut at kFastTap_mps.
std::vector<std::string> limits_of_pieces(const PreparedScene& scene, const schema::Device& device,
                                          double rate_hz, const std::optional<schema::Hand>& hand);

}  // namespace tacto::playback
