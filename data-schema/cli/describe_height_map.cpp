// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/cli/describe.hpp"
#include "data-schema/height/height_map.hpp"

namespace tacto::schema {

Result<cli::Report> describe_height_map(const std::string& path) {
  const auto map = read_height_map(path);
  TACTO_TRY(map);
  if (const auto note = unknown_note(path, map->newer_version, {}); !note.empty()) cli::warn(note);
  cli::Report report = report_of(FileKind::height_map, path, "");
  const HeightFigures figures = figures_of(*map);
  report.add("columns", map->columns).add("rows", map->rows).add("pitch_m", map->pitch_m);
  report.add("width_m", static_cast<double>(map->columns - 1) * map->pitch_m)
      .add("length_m", static_cast<double>(map->rows - 1) * map->pitch_m);
  report.add("lowest_m", figures.lowest_m).add("highest_m", figures.highest_m);
  report.add("rms_slope", figures.rms_slope);
  for (const auto& [key, text] : {std::pair{"surface", &map->surface},
                                  {"source", &map->source},
                                  {"notes", &map->notes},
                                  {"created", &map->created}})
    add_text(report, key, *text);
  return report;
}

}  // namespace tacto::schema
