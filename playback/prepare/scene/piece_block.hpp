// SPDX-License-Identifier: GPL-3.0-or-later
// From the pieces of a scene to the block that the kernel of a device reads.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "playback/prepare/scene/prepared_scene.hpp"

namespace tacto::playback {

/// The block of the pieces for one device. `where` is the scene's file. Errors: unsuitable, by JSON pointer:
/// a place beyond 2^30 counts; a wall whose integral is unstable (wall_growth()); transient_table(),
/// slide_table(); as schema::read_mesh() and read_reliefs().
schema::Result<PreparedScene> prepare_pieces(schema::Scene scene, const std::string& where,
                                             const schema::Device& device, double rate_hz,
                                             const std::optional<schema::Hand>& hand);

/// What makes the meshes of a scene small enough for this many bytes, in words.
std::string remedy_for_meshes(const PreparedScene& scene, std::size_t room);

/// Warnings, one line each: axes that the device does not have; pieces that are unstable
/// (judged_piece()); transients
/// that the limits of the device cut at kFastTap_mps.
std::vector<std::string> limits_of_pieces(const PreparedScene& scene, const schema::Device& device,
                                          double rate_hz, const std::optional<schema::Hand>& hand);

}  // namespace tacto::playback
