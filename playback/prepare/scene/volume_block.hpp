// SPDX-License-Identifier: GPL-3.0-or-later
// From a volume to the table that the kernel reads.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "playback/prepare/scene/prepared_scene.hpp"

namespace tacto::playback {

/// Of a piece with a volume: reads its file, if it is not among `volumes` yet, and sets its steepness, with a
/// tool that of all its points together. `scene`: the scene's file; `where`: the piece in it. Errors: as
/// schema::read_volume(); unsuitable: no or every value is above `iso`, value_per_m below ten times a step of
/// the stored values.
schema::Result<void> read_piece_volume(schema::Piece& piece, const std::string& scene,
                                       const std::string& where, std::size_t tool_points,
                                       std::map<std::string, std::shared_ptr<const schema::Volume>>& volumes);

/// A core::VolumeTable with its points and values. `placed`: the middle of the volume in counts.
std::vector<std::uint32_t> volume_table(const schema::Piece& piece, const schema::Volume& volume,
                                        const core::PieceTable& placed, const PlaneSteps& steps,
                                        const std::vector<std::array<double, 3>>& tool_m = {});

/// How a tick removes material, in such a table. Errors: unsuitable: more than 65,535 steps of the stored
/// values a tick, or less than 2^-16.
schema::Result<void> set_carving(const schema::Piece& piece, const schema::Volume& volume, double rate_hz,
                                 const std::string& where, std::vector<std::uint32_t>& table);

/// Steps of the stored values by which they fall in a tick that carves, x 2^16. Precondition: it has `carve`.
double carve_per_tick(const schema::Piece& piece, const schema::Volume& volume, double rate_hz);

/// Whether an outermost value is above `iso`.
bool solid_at_border(const schema::Piece& piece, const schema::Volume& volume);

/// What makes the volumes of a scene small enough for this many bytes, in words.
std::string remedy_for_volumes(const PreparedScene& scene, std::size_t room);

}  // namespace tacto::playback
