// SPDX-License-Identifier: GPL-3.0-or-later
// A triangle mesh: the surface of a solid in space, as NAME.mesh.nc.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/files/files.hpp"

namespace tacto::schema {

/// Limits of what is stored.
inline constexpr std::size_t kMostTriangles = std::size_t{1} << 24;
inline constexpr double kLargestMesh_m = 10;  ///< of the distances along x, y and z
/// Least largest distance along an axis: the skin of a smaller one, 2^-18 of half of it, is none on a device.
inline constexpr double kSmallestMesh_m = 1e-6;

using MeshVertex = std::array<double, 3>;
using MeshTriangle = std::array<std::uint32_t, 3>;

struct Mesh {
  std::vector<MeshVertex> vertices_m;
  std::vector<MeshTriangle> triangles;  ///< of vertices, counter-clockwise from outside
  std::string source, notes;            ///< source: the imported file and its SHA-256
  std::string created, creator;
  std::string newer_version = {};  ///< set by the reader if the file's minor version is newer than ours
};

/// What may be wrong with a mesh. An edge is between two vertices, in the directions of its triangles: on a
/// closed surface as many go there as back. Triangles without an area, and all but the first of those that
/// are doubled, have no edges here.
struct MeshFaults {
  std::size_t degenerate = 0;  ///< triangles without an area
  std::size_t doubled = 0;     ///< triangles of the same three vertices as another one, either way round
  std::size_t flipped = 0;     ///< triangles turned the other way than most of those they are connected with
  std::size_t open_edges = 0;  ///< edges of one triangle: of holes
  std::size_t odd_edges = 0;   ///< edges of three triangles, or of a larger odd number
  bool one_sided = false;      ///< its triangles cannot be turned the same way, as those of a Moebius strip
  bool inside_out = false;     ///< closed, but the volume of a part is negative, or that of a cavity is not
};
MeshFaults faults_of(const Mesh& mesh);

struct MeshFigures {
  MeshVertex least_m = {}, most_m = {};
  double volume_m3 = 0;  ///< of a closed mesh; of another one without a meaning
  double longest_edge_m = 0;
};
/// Precondition: a mesh with a triangle.
MeshFigures figures_of(const Mesh& mesh);

/// What was done to a mesh.
struct MeshRepair {
  std::size_t merged = 0;   ///< vertices that were nearer than `merge_m` to another one
  std::size_t dropped = 0;  ///< triangles without an area, or twice there
  std::size_t turned = 0;   ///< triangles
};

/// Merges vertices at the same place, and leaves out those that no triangle has.
void merge_equal_vertices(Mesh& mesh);

/// Merges vertices within `merge_m` of each other, drops degenerate triangles and those that are there twice,
/// turns triangles as the others they are connected with, and a closed surface outwards. Holes stay.
MeshRepair repair(Mesh& mesh, double merge_m);

/// Errors, at `where`: unsuitable: no triangle, too many, a place that is not a number or larger than
/// kLargestMesh_m apart, or all within kSmallestMesh_m, a triangle of vertices that are not there;
/// faults_of() other than open and odd edges.
Result<void> check_mesh(const Mesh& mesh, const std::string& where);

/// NAME.mesh.nc of a stem or file name.
std::string mesh_path(const std::string& name);

/// netCDF-4: variables `vertex` (m, double precision, over `vertices` and `axes`) and `triangle` (numbers of
/// vertices from 0, over `triangles` and `corners`), the texts as attributes, and `sha256`, of the bytes of
/// `vertex` and then of `triangle`, little-endian. Errors: as check_mesh, PendingFiles.
Result<void> write_mesh(const std::string& path, const Mesh& mesh, Existing existing);

/// By stem or NAME.mesh.nc. Errors: not_found; malformed: not netCDF, or of another kind, without vertices,
/// or of another sha256 than it states (another program need not state it); as check_mesh;
/// unsupported_version.
Result<Mesh> read_mesh(const std::string& name);

/// Whether it is netCDF of that kind.
bool is_mesh(const std::string& path);

}  // namespace tacto::schema
