// SPDX-License-Identifier: GPL-3.0-or-later
// tactograph describe: each texture in a few numbers, as a table.
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "data-schema/base/creation_time.hpp"
#include "data-schema/command/output_options.hpp"
#include "data-schema/texture/description.hpp"
#include "data-schema/version.hpp"
#include "spatial/cli/table_output.hpp"
#include "spatial/cli/texture_inputs.hpp"
#include "spatial/cli/verbs.hpp"
#include "spatial/features/description.hpp"
#include "spatial/job/description_options.hpp"

namespace tacto::spatial {
namespace {

using cli::Report;
using schema::Description;
using schema::Result;

struct DescribeOptions {
  std::vector<std::string> names;
  std::string output;
  schema::Existing existing = schema::Existing::keep;
  DescriptionOptions description;
};

Result<schema::DescriptionFile> described(const std::vector<NamedTexture>& files,
                                          const DescriptionOptions& options) {
  schema::DescriptionFile all;
  for (const NamedTexture& file : files) {
    auto description = describe(file.texture, options);
    if (!description) return with_file(file, description);
    description->texture = file.name;
    all.textures.push_back(std::move(*description));
  }
  all.created = schema::creation_time();
  all.creator = kCreator;
  return all;
}

Report row_of(const Description& each) {
  Report row;
  row.add("texture", each.texture).add("from_m", each.from_m).add("to_m", each.to_m);
  if (each.mean_speed_mps > 0) row.add("mean_speed_mps", each.mean_speed_mps);
  row.add("low_per_m", each.low_per_m).add("high_per_m", each.high_per_m);
  row.add(schema::key_in("rms", each.unit), each.rms)
      .add(schema::key_in("total_rms", each.unit), each.total_rms);
  if (std::isfinite(each.centroid_per_m)) row.add("centroid_per_m", each.centroid_per_m);
  if (std::isfinite(each.slope_db_per_octave)) row.add("slope_db_per_octave", each.slope_db_per_octave);
  return row;
}

// One row per band: one column per texture would be too wide for a terminal; files have that form.
std::vector<Report> band_rows(const schema::DescriptionFile& file) {
  std::vector<Report> rows;
  for (const Description& each : file.textures)
    for (const auto& band : each.bands) {
      Report row;
      row.add("texture", each.texture).add("centre_per_m", band.centre_per_m);
      row.add(schema::key_in("rms", each.unit), band.rms).add("partial", band.partial);
      rows.push_back(std::move(row));
    }
  return rows;
}

Report report_of(const schema::DescriptionFile& file, const std::string& path) {
  std::vector<Report> rows;
  for (const Description& each : file.textures) rows.push_back(row_of(each));
  Report report;
  report.add("textures", std::move(rows));
  report.add("rms_band",
             "rms: from low to high of its row; total rms: all samples from `from` to `to`, in any band");
  report.add("third_octaves", band_rows(file));
  if (!path.empty()) report.add("file", path);
  return report;
}

Result<Report> run_describe(const DescribeOptions& options) {
  const auto where = table_path(options.output, "descriptions");
  TACTO_TRY(where);
  if (!options.output.empty()) TACTO_TRY(check_table(*where, options.existing));
  const auto files = open_textures(options.names);
  TACTO_TRY(files);
  const auto all = described(*files, options.description);
  TACTO_TRY(all);
  if (options.output.empty()) return report_of(*all, {});
  const auto written = write_table(
      *where, options.existing, [&] { return schema::descriptions_json(*all); },
      [&] { return schema::descriptions_csv(*all); });
  TACTO_TRY(written);
  return report_of(*all, where->path);
}

cli::Action declare_describe(CLI::App& app) {
  auto options = std::make_shared<DescribeOptions>();
  app.add_option("TEXTURE", options->names, kTextureInputs)->required();
  app.add_option("-o,--output", options->output,
                 "Output file, one row per texture: .csv, .json, or NAME (NAME.descriptions.json)");
  cli::declare_force(app, options->existing);
  declare_description(app, options->description);
  return [options] { return run_describe(*options); };
}

}  // namespace

const cli::Verb kDescribeVerb{
    "describe", "Describe textures in numbers: RMS, one-third-octave bands, spectral centroid and slope",
    "tactograph describe oak pine -o woods.csv", declare_describe};

}  // namespace tacto::spatial
