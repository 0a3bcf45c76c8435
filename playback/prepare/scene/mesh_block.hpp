// SPDX-License-Identifier: GPL-3.0-or-later
// From a triangle mesh to the table that the kernel reads: vertices in single precision, and a tree of boxes.
#pragma once

#include <cstdint>
#include <vector>

#include "data-schema/mesh/mesh.hpp"

namespace tacto::playback {

/// The middle of its box, in its own coordinates: the origin of the table.
schema::MeshVertex middle_of(const schema::Mesh& mesh);

/// A core::MeshTable with its nodes, triangles and vertices, but for the origin and the rest of its piece.
/// `shift_m` is added to each vertex: of the mesh's own origin from that of the table. The tree halves the
/// triangles at the median of their middles along the longest side of the box around these, down to
/// kLeafTriangles. The skin is 2^-18 of the half extent: 0.2 um of a part of 0.1 m, 50 times what a place
/// rounds by. Triangles without an area in single precision are left out.
std::vector<std::uint32_t> mesh_table(const schema::Mesh& mesh, const schema::MeshVertex& shift_m);

}  // namespace tacto::playback
