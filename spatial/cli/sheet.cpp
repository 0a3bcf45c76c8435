// SPDX-License-Identifier: GPL-3.0-or-later
// tactograph sheet: many textures on one page, with common scales.
#include "spatial/picture/sheet_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "data-schema/command/output_options.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/report/progress.hpp"
#include "spatial/cli/spectrogram_options.hpp"
#include "spatial/cli/texture_inputs.hpp"
#include "spatial/cli/verbs.hpp"
#include "spatial/features/formants.hpp"
#include "spatial/spectrogram/spectrogram_summary.hpp"

namespace tacto::spatial {
namespace {

using cli::Report;
using schema::Dimension;
using schema::ErrorKind;
using schema::Result;
using schema::Spectrogram;

struct SheetOptions {
  std::vector<std::string> names;
  std::string output, title = "Textures";
  schema::Existing existing = schema::Existing::keep;
  SpectrogramOptions spectrogram;
  SpectrogramPictureOptions picture;
  std::size_t columns = 0;
  bool formants = false;
};

struct Drawn {
  Spectrogram spectrogram;
  std::vector<schema::Formant> formants;
};

Result<Drawn> drawn(const NamedTexture& file, const SheetOptions& options) {
  auto spectrogram = spatial_spectrogram(file.texture, options.spectrogram);
  if (!spectrogram) return with_file(file, spectrogram);
  spectrogram->name = file.name;
  Drawn made{std::move(*spectrogram), {}};
  if (!options.formants) return made;
  auto formants = find_formants(made.spectrogram);
  if (!formants) return with_file(file, formants);
  made.formants = std::move(*formants);
  return made;
}

Result<std::vector<Drawn>> all_drawn(const std::vector<NamedTexture>& files, const SheetOptions& options) {
  std::vector<Drawn> all;
  cli::Progress progress("spectrograms");
  for (const NamedTexture& file : files) {
    auto made = drawn(file, options);
    TACTO_TRY(made);
    all.push_back(std::move(*made));
    progress.update(static_cast<double>(all.size()) / static_cast<double>(files.size()));
  }
  return all;
}

std::size_t pages_of(std::size_t textures) {
  return (textures + kCellsOfAPage - 1) / kCellsOfAPage;
}

// "sheet.png", or "sheet-01.png" and so on.
std::string page_path(const std::string& output, std::size_t page, std::size_t pages) {
  if (pages == 1) return output;
  const std::filesystem::path path(output);
  const std::string name =
      fmt::format("{}-{:02}{}", path.stem().string(), page + 1, path.extension().string());
  return (path.parent_path() / name).string();
}

Result<std::vector<std::string>> write_pages(const std::vector<SpectrogramPanel>& panels,
                                             const SheetScales& scales, const SheetOptions& options) {
  const std::size_t pages = pages_of(panels.size());
  std::vector<std::string> paths;
  schema::PendingFiles files;
  for (std::size_t page = 0; page < pages; ++page) {
    const auto from = panels.begin() + static_cast<std::ptrdiff_t>(page * kCellsOfAPage);
    const auto to =
        panels.begin() + static_cast<std::ptrdiff_t>(std::min(panels.size(), (page + 1) * kCellsOfAPage));
    const std::string title =
        pages == 1 ? options.title : fmt::format("{}, page {} of {}", options.title, page + 1, pages);
    paths.push_back(page_path(options.output, page, pages));
    const SheetFigure figure({from, to}, scales, title, options.columns);
    TACTO_TRY(add_figure(files, paths.back(), figure));
  }
  TACTO_TRY(files.commit(options.existing));
  return paths;
}

Report report_of(const std::vector<SpectrogramPanel>& panels, const SheetScales& scales,
                 const std::vector<std::string>& paths) {
  std::vector<std::string> names;
  for (const SpectrogramPanel& panel : panels) names.push_back(panel.spectrogram->name);
  Report report;
  report.add("textures", std::move(names)).add("length_m", 1e-3 * scales.length_mm);
  report.add("low_per_m", 1e3 * scales.low_per_mm).add("high_per_m", 1e3 * scales.high_per_mm);
  report.add("lowest_level_db", scales.levels.low_db).add("highest_level_db", scales.levels.high_db);
  report.add("level_reference", level_reference(*panels.front().spectrogram).unit).add("files", paths);
  return report;
}

Result<void> check_pages(const SheetOptions& options, std::size_t textures) {
  const std::size_t pages = pages_of(textures);
  for (std::size_t page = 0; page < pages; ++page)
    if (auto free = schema::check_output_free(page_path(options.output, page, pages), options.existing);
        !free)
      return free;
  return {};
}

Result<void> check_options(const SheetOptions& options) {
  if (options.output.ends_with(".png") || options.output.ends_with(".svg")) return {};
  return schema::fail(ErrorKind::usage, "this picture format is not supported", options.output,
                      "use .png or .svg");
}

Result<Report> run_sheet(const SheetOptions& options) {
  TACTO_TRY(check_options(options));
  const auto files = open_textures(options.names);
  TACTO_TRY(files);
  TACTO_TRY(check_pages(options, files->size()));
  const auto all = all_drawn(*files, options);
  TACTO_TRY(all);
  std::vector<SpectrogramPanel> panels;
  for (std::size_t i = 0; i < files->size(); ++i)
    panels.push_back({&(*files)[i].texture, &(*all)[i].spectrogram, (*all)[i].formants});
  const auto scales = sheet_scales(panels, options.picture);
  TACTO_TRY(scales);
  const auto paths = write_pages(panels, *scales, options);
  TACTO_TRY(paths);
  return report_of(panels, *scales, *paths);
}

cli::Action declare_sheet(CLI::App& app) {
  auto options = std::make_shared<SheetOptions>();
  app.add_option("TEXTURE", options->names, kTextureInputs)->required();
  app.add_option("-o,--output", options->output,
                 "Output file, .png or .svg; more than 24 textures make SHEET-01, SHEET-02 ...")
      ->required();
  cli::declare_force(app, options->existing);
  app.add_option("--title", options->title, "Title of the sheet")->capture_default_str();
  app.add_option("--columns", options->columns, "Textures side by side [automatic, at most 4]")
      ->check(CLI::Range(1, 12));
  app.add_flag("--formants", options->formants, "Draw the formants");
  declare_spectrogram(app, options->spectrogram);
  cli::add_quantity(app, "--min-frequency", options->picture.min_frequency_per_m,
                    Dimension::spatial_frequency,
                    "Lower end of the frequency axis [0.7 of the lowest valid frequency, else 0.1/mm]");
  cli::add_quantity(app, "--dynamic-range", options->picture.dynamic_range_db, Dimension::level,
                    "Range of levels from the darkest to the brightest colour");
  return [options] { return run_sheet(*options); };
}

}  // namespace

const cli::Verb kSheetVerb{"sheet", "Draw many textures on one page at one scale, for comparison",
                           "tactograph sheet *.texture.json -o sheet.png", declare_sheet};

}  // namespace tacto::spatial
