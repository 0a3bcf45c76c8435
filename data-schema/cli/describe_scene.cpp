// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/cli/describe.hpp"
#include "data-schema/report/choices_report.hpp"
#include "data-schema/scene/scene.hpp"

namespace tacto::schema {
namespace {

cli::Report row_of(const TextureLayer& layer) {
  cli::Report row;
  row.add("type", "texture").add("texture", layer.texture).add("at_m", layer.at_m);
  row.add("gain_m_per_n", layer.gain_m_per_n).add("ends", to_string(layer.ends));
  add_text(row, "gain_set_by", layer.gain_set_by);
  add_text(row, "gain_set_on", layer.gain_set_on);
  return row;
}

}  // namespace

Result<cli::Report> describe_scene(const std::string& path) {
  const auto scene = read_scene(path);
  TACTO_TRY(scene);
  warn_of_version(path, scene->newer_version);
  cli::Report report = report_of(FileKind::scene, path, "");
  add_text(report, "name", scene->name);
  std::vector<cli::Report> rows;
  for (const Layer& layer : scene->layers)
    rows.push_back(layer.visit([](const TextureLayer& texture) { return row_of(texture); }));
  report.add("layers", std::move(rows));
  cli::add_choices(report, scene->playback);
  add_text(report, "notes", scene->notes);
  return report;
}

}  // namespace tacto::schema
