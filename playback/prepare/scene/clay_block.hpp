// SPDX-License-Identifier: GPL-3.0-or-later
// From a height map of clay to the table that the kernel changes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "data-schema/height/height_map.hpp"
#include "playback/prepare/scene/prepared_scene.hpp"

namespace tacto::playback {

/// The heights as the coefficients of the surface, and how they sink, as whole multiples of a unit
/// (core::ClayTable): the smallest power of two of a metre of which the deepest and the highest place are at
/// most 2^24. Sets half_m, least_m and most_m. `where`: the piece. Errors: unsuitable: a profile; a tick
/// sinks by less than two units, or by more than the thickness. Precondition: it is clay.
schema::Result<Relief> clay_relief(schema::Piece& piece, const schema::HeightMap& map, double rate_hz,
                                   const std::string& where);

/// Errors: unsuitable: a threshold that the device does not reach.
schema::Result<void> check_clay(const schema::Piece& piece, const schema::Device& device,
                                const std::string& where);

/// In a core::ReliefPieceTable with its map.
void set_clay(const schema::Clay& clay, std::vector<std::uint32_t>& words);

/// What makes the reliefs of a scene in space small enough for this many bytes, in words.
std::string remedy_for_reliefs(const PreparedScene& scene, std::size_t room);

}  // namespace tacto::playback
