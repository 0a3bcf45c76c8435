// SPDX-License-Identifier: GPL-3.0-or-later
// Triangle meshes of other programs: STL, OBJ and PLY.
#pragma once

#include <cstddef>
#include <string>

#include "data-schema/base/error.hpp"
#include "data-schema/mesh/mesh.hpp"

namespace tacto::schema {

/// The most bytes of such a file, which is read whole.
inline constexpr std::size_t kMostMeshFileBytes = std::size_t{2} << 30;

/// Whether the name ends in .stl, .obj or .ply.
bool is_mesh_file(const std::string& path);

/// The triangles of all its parts, polygons divided; points, lines, colours and materials are left out.
/// `unit_m`: its unit of length. Vertices at the same place are one. Places are read in single precision, as
/// STL has them. Errors: not_found; malformed, with the library's words; unsuitable: no triangle, too large.
Result<Mesh> read_mesh_file(const std::string& path, double unit_m);

}  // namespace tacto::schema
