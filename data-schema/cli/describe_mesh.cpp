// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/cli/describe.hpp"

namespace tacto::schema {

void add_mesh(cli::Report& report, const Mesh& mesh) {
  const MeshFigures figures = figures_of(mesh);
  const MeshFaults faults = faults_of(mesh);
  report.add("triangles", mesh.triangles.size()).add("vertices", mesh.vertices_m.size());
  const char *const from[] = {"from_x_m", "from_y_m", "from_z_m"}, *const sizes[] = {"size_x_m", "size_y_m",
                                                                                     "size_z_m"};
  for (std::size_t i = 0; i < 3; ++i) report.add(from[i], figures.least_m[i]);
  for (std::size_t i = 0; i < 3; ++i) report.add(sizes[i], figures.most_m[i] - figures.least_m[i]);
  const bool closed = faults.open_edges + faults.odd_edges == 0;
  report.add("longest_edge_m", figures.longest_edge_m).add("closed", closed);
  if (closed) report.add("volume_m3", figures.volume_m3);
  if (faults.open_edges > 0) report.add("open_edges", faults.open_edges);
  if (faults.odd_edges > 0) report.add("edges_of_three_or_more_triangles", faults.odd_edges);
}

Result<cli::Report> describe_mesh(const std::string& path) {
  const auto mesh = read_mesh(path);
  TACTO_TRY(mesh);
  if (const auto note = unknown_note(path, mesh->newer_version, {}); !note.empty()) cli::warn(note);
  cli::Report report = report_of(FileKind::mesh, path, "");
  add_mesh(report, *mesh);
  for (const auto& [key, text] :
       {std::pair{"source", &mesh->source}, {"notes", &mesh->notes}, {"created", &mesh->created}})
    add_text(report, key, *text);
  return report;
}

}  // namespace tacto::schema
