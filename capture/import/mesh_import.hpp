// SPDX-License-Identifier: GPL-3.0-or-later
// Import of an STL, OBJ or PLY file as a mesh in metres.
#pragma once

#include <string>

#include "capture/import/import.hpp"
#include "data-schema/mesh/mesh.hpp"

namespace tacto::capture {

struct ImportedMesh {
  schema::Mesh mesh;
  schema::MeshFaults faults;  ///< that are left: open and odd edges
  schema::MeshRepair repair;
  double merged_within_m = 0;  ///< of a repair
  std::string path;
};

/// Whether the file is a mesh by its name.
bool is_mesh_request(const ImportRequest& request);

/// Reads it, repairs it if asked to, and writes NAME.mesh.nc. Errors: usage: no unit, options of other files;
/// unsuitable: faults of the mesh, counted, without `repair`; holes, without `open`; as
/// schema::read_mesh_file(), schema::write_mesh().
schema::Result<ImportedMesh> import_mesh(const ImportRequest& request);

}  // namespace tacto::capture
