// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/import/mesh_import.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <vector>

#include "data-schema/base/creation_time.hpp"
#include "data-schema/base/sha256.hpp"
#include "data-schema/exchange/mesh_file.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/version.hpp"

namespace tacto::capture {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

namespace {

constexpr double kMergeShare = 1e-6;  // of the largest size: about 10 times what STL rounds by

Result<void> check_mesh_options(const ImportRequest& request) {
  if (!request.unit_m)
    return fail(ErrorKind::usage, "a mesh file does not say its unit", request.file,
                "give it, for example --unit mm");
  if (!request.channels.empty() || request.rate_hz || !request.time_column.empty() || request.speed_mps ||
      request.pitch_m || request.full_height_m)
    return fail(ErrorKind::usage, "a mesh has no channels, no times and no pitch", request.file,
                "omit --channel, --rate, --time-column, --speed, --pitch and --height");
  return {};
}

// All faults at once, with the option that removes or accepts each.
Result<void> check_faults(const schema::MeshFaults& faults, std::size_t triangles,
                          const ImportRequest& request) {
  std::vector<std::string> words, remedies;
  const auto counted = [](std::size_t count, std::string_view what) {
    return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
  };
  if (faults.doubled > 0) words.push_back(counted(faults.doubled, "triangle") + " that are there twice");
  if (faults.degenerate > 0) words.push_back(counted(faults.degenerate, "triangle") + " without an area");
  if (faults.flipped > 0) words.push_back(counted(faults.flipped, "flipped triangle"));
  if (faults.inside_out) words.emplace_back("its outer side inside");
  if (!words.empty()) remedies.emplace_back("--repair drops and turns triangles");
  if (faults.one_sided) {
    words.emplace_back("triangles without a common outer side");
    remedies.emplace_back("repair it in a program for meshes: each edge belongs to two triangles");
  }
  if (faults.odd_edges > 0 && !request.open) {
    words.push_back(counted(faults.odd_edges, "edge") + " of three or more triangles");
    remedies.emplace_back(
        "remove the triangles that are too many in a program for meshes; --open keeps them");
  }
  if (faults.open_edges > 0 && !request.open) {
    words.push_back("holes with " + counted(faults.open_edges, "open edge"));
    if (!request.repair)
      remedies.emplace_back(
          "--repair merges vertices within a millionth of the size, which may close the holes");
    remedies.emplace_back(
        "close the holes in a program for meshes; --open keeps them: the surface then acts from its outer "
        "side, and a point passes through it from the other side");
  }
  if (words.empty()) return {};
  return fail(ErrorKind::unsuitable,
              fmt::format("this mesh of {} triangles has {}", triangles, fmt::join(words, ", ")),
              request.file, fmt::format("{}", fmt::join(remedies, "; ")));
}

}  // namespace

bool is_mesh_request(const ImportRequest& request) {
  return schema::is_mesh_file(request.file);
}

Result<ImportedMesh> import_mesh(const ImportRequest& request) {
  TACTO_TRY(check_mesh_options(request));
  ImportedMesh imported;
  imported.path = schema::mesh_path(request.name);
  const auto existing = request.replace ? schema::Existing::replace : schema::Existing::keep;
  TACTO_TRY(schema::check_output_free(imported.path, existing));
  auto mesh = schema::read_mesh_file(request.file, *request.unit_m);
  TACTO_TRY(mesh);
  imported.mesh = std::move(*mesh);
  if (request.repair) {
    const schema::MeshFigures figures = figures_of(imported.mesh);
    double size_m = 0;
    for (std::size_t i = 0; i < 3; ++i) size_m = std::max(size_m, figures.most_m[i] - figures.least_m[i]);
    imported.merged_within_m = kMergeShare * size_m;
    imported.repair = repair(imported.mesh, imported.merged_within_m);
  }
  imported.faults = faults_of(imported.mesh);
  TACTO_TRY(check_faults(imported.faults, imported.mesh.triangles.size(), request));
  const auto sum = schema::sha256_of_file(request.file);
  TACTO_TRY(sum);
  imported.mesh.source =
      fmt::format("{} (SHA-256 {})", std::filesystem::path(request.file).filename().string(), *sum);
  imported.mesh.notes = request.notes;
  imported.mesh.created = schema::creation_time();
  imported.mesh.creator = kCreator;
  auto written = schema::write_mesh(imported.path, imported.mesh, existing);
  if (!written && written.error().kind == ErrorKind::unsuitable) written.error().where = request.file;
  TACTO_TRY(written);
  return imported;
}

}  // namespace tacto::capture
