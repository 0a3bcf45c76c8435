// SPDX-License-Identifier: GPL-3.0-or-later
// Tables and results that verbs wrote, height maps, and the plan of a corpus.
#include <vector>

#include "data-schema/cli/describe.hpp"
#include "data-schema/corpus/corpus_plan.hpp"
#include "data-schema/height/height_map.hpp"
#include "data-schema/results/results.hpp"
#include "data-schema/results/trade_table.hpp"
#include "data-schema/session/session_netcdf.hpp"
#include "data-schema/texture/description.hpp"
#include "data-schema/texture/formants.hpp"

namespace tacto::schema {

Result<cli::Report> describe_formants(const std::string& path) {
  const auto file = read_formants(path);
  TACTO_TRY(file);
  warn_of_unknown(path, *file);
  cli::Report report = report_of(FileKind::formants, path, "");
  std::vector<cli::Report> rows;
  for (const FormantTable& table : file->tables)
    rows.push_back(cli::Report()
                       .add("texture", table.texture)
                       .add("formants", table.formants.size())
                       .add("window_m", table.window_m)
                       .add("resolution_per_m", table.resolution_per_m)
                       .add("level_reference", table.level_reference)
                       .add("simulated", table.simulated));
  report.add("textures", std::move(rows));
  add_text(report, "created", file->created);
  add_text(report, "creator", file->creator);
  return report;
}

Result<cli::Report> describe_descriptions(const std::string& path) {
  const auto file = read_descriptions(path);
  TACTO_TRY(file);
  warn_of_unknown(path, *file);
  cli::Report report = report_of(FileKind::descriptions, path, "");
  std::vector<cli::Report> rows;
  for (const Description& each : file->textures)
    rows.push_back(cli::Report()
                       .add("texture", each.texture)
                       .add(key_in("rms", each.unit), each.rms)
                       .add("low_per_m", each.low_per_m)
                       .add("high_per_m", each.high_per_m)
                       .add("bands", each.bands.size())
                       .add("simulated", each.simulated));
  report.add("textures", std::move(rows));
  add_text(report, "created", file->created);
  add_text(report, "creator", file->creator);
  return report;
}

Result<cli::Report> describe_session_table(const std::string& path) {
  const auto table = read_session_table(path);
  TACTO_TRY(table);
  cli::Report report = report_of(FileKind::session_table, path, table->simulated);
  add_text(report, "created", table->created);
  add_text(report, "creator", table->creator);
  add_text(report, "device", table->device);
  add_text(report, "transducer", table->transducer);
  report.add("rate_hz", table->rate_hz).add("ticks", table->times).add("duration_s", table->duration_s);
  report.add("textures", table->textures);
  if (!table->changes.empty()) report.add("changes", table->changes);
  return report;
}

Result<cli::Report> describe_trade(const std::string& path) {
  const auto file = read_trade_table(path);
  TACTO_TRY(file);
  warn_of_unknown(path, *file);
  cli::Report report = report_of(FileKind::trade, path, {});
  add_text(report, "machine", file->machine);
  add_text(report, "created", file->created);
  add_text(report, "creator", file->creator);
  std::vector<cli::Report> rows;
  for (const MeasuredChoice& choice : file->choices)
    rows.push_back(cli::Report()
                       .add("stage", choice.stage)
                       .add("choice", choice.name)
                       .add("per", choice.per)
                       .add("cost_ns", choice.cost_ns)
                       .add("error_at_10_points", choice.error_at(10)));
  return report.add("choices", std::move(rows));
}

Result<cli::Report> describe_results(const std::string& path) {
  const auto file = read_results(path);
  TACTO_TRY(file);
  warn_of_unknown(path, *file);
  cli::Report report = report_of(FileKind::results, path, file->simulated);
  report.add("verb", file->verb).add("inputs", file->inputs);
  add_text(report, "device", file->device);
  add_text(report, "created", file->created);
  add_text(report, "creator", file->creator);
  std::vector<cli::Report> rows;
  for (const ResultFigure& figure : file->figures)
    rows.push_back(cli::Report().add("name", figure.name).add("value", figure.value));
  return report.add("figures", std::move(rows));
}

Result<cli::Report> describe_corpus(const std::string& path) {
  const auto plan = read_corpus_plan(path);
  TACTO_TRY(plan);
  warn_of_unknown(path, *plan);
  cli::Report report = report_of(FileKind::corpus, path, "");
  add_text(report, "created", plan->created);
  add_text(report, "creator", plan->creator);
  report.add("recordings", plan->recordings.size());
  std::vector<cli::Report> rows;
  for (const CorpusStep& step : plan->steps)
    rows.push_back(cli::Report().add("step", step.step).add("options", step.options));
  return report.add("steps", std::move(rows));
}

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
