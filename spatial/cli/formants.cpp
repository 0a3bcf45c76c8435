// SPDX-License-Identifier: GPL-3.0-or-later
// tactograph formants: the ridges of the spatial spectrograms of textures, as a table.
#include "spatial/features/formants.hpp"

#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "data-schema/base/creation_time.hpp"
#include "data-schema/command/output_options.hpp"
#include "data-schema/report/progress.hpp"
#include "data-schema/texture/formants.hpp"
#include "data-schema/version.hpp"
#include "spatial/cli/formant_row.hpp"
#include "spatial/cli/spectrogram_options.hpp"
#include "spatial/cli/table_output.hpp"
#include "spatial/cli/texture_inputs.hpp"
#include "spatial/cli/verbs.hpp"

namespace tacto::spatial {
namespace {

using cli::Report;
using schema::Dimension;
using schema::Result;

struct FormantsOptions {
  std::vector<std::string> names;
  std::string output;
  schema::Existing existing = schema::Existing::keep;
  SpectrogramOptions spectrogram;
  FormantOptions formants;
};

Result<schema::FormantTable> table_of(const NamedTexture& file, const FormantsOptions& options) {
  auto spectrogram = spatial_spectrogram(file.texture, options.spectrogram);
  if (!spectrogram) return with_file(file, spectrogram);
  spectrogram->name = file.name;
  return formant_table(*spectrogram, options.formants);
}

Result<schema::FormantFile> found(const std::vector<NamedTexture>& files, const FormantsOptions& options) {
  schema::FormantFile all;
  cli::Progress progress("formants");
  for (const NamedTexture& file : files) {
    auto table = table_of(file, options);
    TACTO_TRY(table);
    all.tables.push_back(std::move(*table));
    progress.update(static_cast<double>(all.tables.size()) / static_cast<double>(files.size()));
  }
  all.created = schema::creation_time();
  all.creator = kCreator;
  return all;
}

// The background of a line is the median of cells between 3.5 and 16 times 1 / window away. Where lines of 3
// times 1 / window on each side repeat more closely than this, they are most of these cells.
constexpr double kWindowOverPeriod = 10;

Report report_of(const schema::FormantFile& file, const std::string& path) {
  std::vector<Report> rows;
  for (const auto& table : file.tables)
    for (const auto& formant : table.formants) rows.push_back(formant_row(table.texture, formant));
  const auto& first = file.tables.front();
  Report report;
  report.add("textures", file.tables.size()).add("found", rows.size());
  report.add("formants", std::move(rows));
  report.add("periods",
             fmt::format("the lines of a grating are found up to a period of {}; for longer ones give a "
                         "--window of ten periods (closer lines hide each other)",
                         schema::length_for_people(first.window_m / kWindowOverPeriod)));
  report.add("level_reference", first.level_reference).add("window_m", first.window_m);
  report.add("resolution_per_m", first.resolution_per_m);
  if (!path.empty()) report.add("file", path);
  return report;
}

Result<Report> run_formants(const FormantsOptions& options) {
  const auto where = table_path(options.output, "formants");
  TACTO_TRY(where);
  if (!options.output.empty()) TACTO_TRY(check_table(*where, options.existing));
  const auto files = open_textures(options.names);
  TACTO_TRY(files);
  const auto formants = found(*files, options);
  TACTO_TRY(formants);
  if (options.output.empty()) return report_of(*formants, {});
  const auto written = write_table(
      *where, options.existing, [&] { return schema::formants_json(*formants); },
      [&] { return schema::formants_csv(*formants); });
  TACTO_TRY(written);
  return report_of(*formants, where->path);
}

cli::Action declare_formants(CLI::App& app) {
  auto options = std::make_shared<FormantsOptions>();
  app.add_option("TEXTURE", options->names, kTextureInputs)->required();
  app.add_option("-o,--output", options->output, "Output file: NAME (NAME.formants.json), .json or .csv");
  cli::declare_force(app, options->existing);
  declare_spectrogram(app, options->spectrogram);
  cli::add_quantity(app, "--prominence", options->formants.start_db, Dimension::level,
                    "Minimum level of a formant above its background, at its highest point");
  cli::add_quantity(app, "--go-on", options->formants.continue_db, Dimension::level,
                    "Minimum level of each of its points above the background");
  cli::add_quantity(app, "--shortest", options->formants.shortest_m, Dimension::length,
                    "Shortest formant [half a window]");
  cli::add_quantity(app, "--bridge", options->formants.bridge_m, Dimension::length,
                    "Longest gap in a formant [half a window]");
  return [options] { return run_formants(*options); };
}

}  // namespace

const cli::Verb kFormantsVerb{
    "formants", "Find a texture's spatial formants: frequency, width, extent and strength",
    "tactograph formants oak\n  tactograph formants oak pine -o woods --prominence 15dB", declare_formants};

}  // namespace tacto::spatial
