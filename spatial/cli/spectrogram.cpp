// SPDX-License-Identifier: GPL-3.0-or-later
// tactograph spectrogram: pictures and tables of the spatial spectra of textures.
#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "data-schema/command/budget_options.hpp"
#include "data-schema/command/output_options.hpp"
#include "spatial/cli/formant_row.hpp"
#include "spatial/cli/spectrogram_files.hpp"
#include "spatial/cli/spectrogram_run.hpp"
#include "spatial/cli/texture_inputs.hpp"
#include "spatial/cli/verbs.hpp"
#include "spatial/features/formants.hpp"
#include "spatial/picture/spectrogram_figure.hpp"
#include "spatial/picture/spectrogram_output.hpp"
#include "spatial/spectrogram/budget.hpp"
#include "spatial/spectrogram/spectrogram_summary.hpp"

namespace tacto::spatial {
namespace {

using cli::Report;
using schema::Dimension;
using schema::ErrorKind;
using schema::Result;
using schema::SpectrogramHeader;

struct SpectrogramVerbOptions {
  std::vector<std::string> names, outputs;
  schema::Existing existing = schema::Existing::keep;
  SpectrogramOptions spectrogram;
  SpectrogramPictureOptions picture;
  std::optional<Resolution> resolution;  // if the user named one
  cli::BudgetOptions chosen_by;
  bool compress = false;
  bool formants = false;
};

using FormantLists = std::vector<std::vector<schema::Formant>>;

// Empty lists if formants are not requested.
Result<FormantLists> formants_of(const SpectrogramRun& run, bool target) {
  FormantLists lists(run.spectrograms().size());
  for (std::size_t i = 0; target && i < lists.size(); ++i) {
    auto found = find_formants(run.spectrograms()[i]);
    TACTO_TRY(found);
    lists[i] = std::move(*found);
  }
  return lists;
}

std::vector<Report> formant_rows(const SpectrogramRun& run, const FormantLists& lists) {
  std::vector<Report> rows;
  for (std::size_t i = 0; i < lists.size(); ++i)
    for (const schema::Formant& formant : lists[i])
      rows.push_back(formant_row(run.textures()[i].name, formant));
  return rows;
}

SpectrogramFigure figure_of(const SpectrogramRun& run, const FormantLists& formants,
                            const SpectrogramPictureOptions& options) {
  std::vector<SpectrogramPanel> panels;
  for (std::size_t i = 0; i < run.textures().size(); ++i)
    panels.push_back({&run.textures()[i].texture, &run.spectrograms()[i], formants[i]});
  return SpectrogramFigure(panels, options);
}

Report row_of(const SpectrogramRun::Line& line, const SpectrogramHeader& header, double lowest_per_m) {
  const SpectralPeak peak = line.tally.strongest_peak(lowest_per_m);
  Report row;
  row.add("texture", line.name)
      .add("positions", line.positions)
      .add("peak_position_m", peak.position_m)
      .add("peak_frequency_per_m", peak.frequency_per_m)
      .add("peak_level_db", level_db(peak.cell, level_reference(header)))
      .add(schema::key_in("band_rms", header.unit), line.tally.band_rms(lowest_per_m));
  return row;
}

void add_grid(Report& report, const SpectrogramRun& run) {
  const Decimation& decimation = run.decimation();
  report.add("samples_used",
             decimation.factor == 1 ? std::string("all") : fmt::format("every {}th", decimation.factor));
  if (!decimation.whole_because.empty()) report.add("whole_because", decimation.whole_because);
}

Report report_of(const SpectrogramRun& run, double lowest_per_m, const SpectrogramVerbOptions& options) {
  const SpectrogramHeader& first = run.first();
  std::vector<Report> rows;
  for (const auto& line : run.lines()) rows.push_back(row_of(line, first, lowest_per_m));
  Report report;
  report.add("textures", std::move(rows))
      .add("window_m", first.window_m)
      .add("hop_m", first.hop_m)
      .add("padded_samples", first.padded_samples)
      .add("detrend", first.detrend)
      .add("bins", first.bins)
      .add("bin_spacing_per_m", first.frequency_step_per_m)
      .add("resolution_per_m", resolution_per_m(first));
  add_grid(report, run);
  report.add("scaling", first.scaling == schema::Scaling::density ? "density" : "amplitude")
      .add("window_coherent_gain", first.coherent_gain)
      .add("band_from_per_m", lowest_per_m)
      .add("band_to_per_m", first.frequency_per_m(first.bins - 1))
      .add("rms_band", fmt::format("{:.4g}-{:.4g} /mm, mean over the windows", 1e-3 * lowest_per_m,
                                   1e-3 * first.frequency_per_m(first.bins - 1)))
      .add("level_reference", level_reference(first).unit)
      .add("files", options.outputs);
  return report;
}

Result<void> check_options(const SpectrogramVerbOptions& options) {
  const auto& lowest = options.picture.min_frequency_per_m;
  if (lowest && !(*lowest > 0 && *lowest < options.spectrogram.max_frequency_per_m))
    return schema::fail(ErrorKind::usage, "the minimum frequency must be between 0 and the maximum",
                        "--min-frequency");
  if (!(options.picture.dynamic_range_db > 0))
    return schema::fail(ErrorKind::usage, "the dynamic range must be above 0 dB", "--dynamic-range",
                        "60dB is the default");
  if (options.formants && options.spectrogram.scaling != schema::Scaling::density)
    return schema::fail(ErrorKind::usage, "formants are computed from densities, not from amplitudes",
                        "--formants", "omit --scaling amplitude or --formants");
  return check_outputs(options.outputs, options.existing);
}

// The report of --explain about the choice.
Report explained(const ResolutionChoice& taken, const std::vector<ResolutionChoice>& all,
                 const schema::FoundTradeTable& found) {
  std::vector<Report> rows;
  for (const ResolutionChoice& choice : all)
    rows.push_back(Report()
                       .add("resolution", choice.resolution == Resolution::whole ? "whole" : "auto")
                       .add("error_percent", 100 * choice.error)
                       .add("cost_ns_per_cell", choice.cost_ns_per_cell)
                       .add("taken", choice.resolution == taken.resolution));
  return Report()
      .add("by_table", found.origin)
      .add("error_includes",
           "|X - exact X| re the largest |X|; window, hop and padding define the result and are not chosen")
      .add("tried", std::move(rows));
}

// Chooses the resolution by the budget, if there is a budget and no resolution was named.
Result<std::optional<Report>> choose_resolution(SpectrogramVerbOptions& options) {
  if (options.resolution) options.spectrogram.resolution = *options.resolution;
  const schema::Budget& budget = options.chosen_by.budget;
  if (!budget.asked() && options.chosen_by.explain)
    return schema::fail(ErrorKind::usage, "--explain needs a choice by --quality or --max-error", "--explain",
                        "add --quality or --max-error");
  if (!budget.asked()) return std::nullopt;
  const auto found = schema::find_trade_table();
  TACTO_TRY(found);
  const auto all = resolutions_of(found->table);
  TACTO_TRY(all);
  const auto taken = choose_resolution(found->table, options.resolution, budget);
  TACTO_TRY(taken);
  options.spectrogram.resolution = taken->resolution;
  if (!options.chosen_by.explain) return std::nullopt;
  return explained(*taken, *all, *found);
}

Result<Report> run_spectrogram(SpectrogramVerbOptions options) {
  TACTO_TRY(check_options(options));
  const auto chosen = choose_resolution(options);
  TACTO_TRY(chosen);
  auto inputs = TextureInputs::find(options.names, {});
  TACTO_TRY(inputs);
  SpectrogramFiles files;
  TACTO_TRY(files.open(options.outputs, inputs->several(), options.compress));
  if (options.formants && !files.has_pictures())
    return schema::fail(ErrorKind::usage, "formants are drawn in a picture, and no picture was requested",
                        "--formants", "add -o NAME.png, or list them with 'tactograph formants'");
  SpectrogramRun run(options.spectrogram, options.picture.min_frequency_per_m, files, files.has_pictures());
  TACTO_TRY(run.transform(*inputs));
  const auto formants = formants_of(run, options.formants);
  TACTO_TRY(formants);
  std::optional<SpectrogramFigure> figure;
  if (files.has_pictures()) figure = figure_of(run, *formants, options.picture);
  TACTO_TRY(files.finish(figure ? &*figure : nullptr, options.existing));
  Report report = report_of(run, run.lowest_per_m(), options);
  if (options.formants) report.add("formants", formant_rows(run, *formants));
  if (*chosen) report.add("chosen", std::vector<Report>{**chosen});
  return report;
}

void declare_windows(CLI::App& app, SpectrogramVerbOptions& verb) {
  SpectrogramOptions& options = verb.spectrogram;
  cli::add_quantity(app, "--window", options.window_m, Dimension::length, "Length of the Blackman window");
  cli::add_quantity(app, "--hop", options.hop_m, Dimension::length, "Distance from one window to the next");
  cli::add_quantity(app, "--padding", options.padded_m, Dimension::length,
                    "Length of a window with the zeros after it [the next power of two in samples]");
  cli::add_choice<Detrend>(app, "--detrend", options.detrend,
                           {{"constant", Detrend::constant}, {"none", Detrend::none}},
                           "Subtract the mean of each window first (constant), or not (none)");
  cli::add_choice<schema::Scaling>(
      app, "--scaling", options.scaling,
      {{"density", schema::Scaling::density}, {"amplitude", schema::Scaling::amplitude}},
      "Power spectral density (unit^2 mm), or the amplitude of a sine (unit)");
  cli::add_choice<std::optional<Resolution>>(app, "--resolution", verb.resolution,
                                             {{"auto", Resolution::automatic}, {"whole", Resolution::whole}},
                                             "Use the coarsest grid that keeps the bins (auto), or the "
                                             "texture's grid (whole) [auto, or by --quality]");
  cli::declare_budget(app, verb.chosen_by, "the resolution");
}

void declare_options(CLI::App& app, SpectrogramVerbOptions& options) {
  app.add_option("TEXTURE", options.names, std::string(kTextureInputs) + "; several share one output")
      ->required();
  app.add_option("-o,--output", options.outputs,
                 "Output file: .png, .svg, .nc (netCDF-4) or .csv; may be repeated")
      ->required()
      ->allow_extra_args(false);
  cli::declare_force(app, options.existing);
  declare_windows(app, options);
  cli::add_quantity(app, "--max-frequency", options.spectrogram.max_frequency_per_m,
                    Dimension::spatial_frequency, "Highest spatial frequency that is kept");
  cli::add_quantity(app, "--min-frequency", options.picture.min_frequency_per_m, Dimension::spatial_frequency,
                    "Lower end of the picture's axis and of the band of the RMS [0.7 of the lowest valid "
                    "frequency, else 0.1/mm]");
  cli::add_quantity(app, "--dynamic-range", options.picture.dynamic_range_db, Dimension::level,
                    "Range of levels from the darkest to the brightest colour");
  app.add_flag("--formants", options.formants, "Draw the formants ('tactograph formants' lists them)");
  app.add_flag("--compress", options.compress,
               "Compress the cells of a .nc file: slower, and only slightly smaller");
}

cli::Action declare_spectrogram_verb(CLI::App& app) {
  auto options = std::make_shared<SpectrogramVerbOptions>();
  declare_options(app, *options);
  return [options] { return run_spectrogram(*options); };
}

}  // namespace

const cli::Verb kSpectrogramVerb{
    "spectrogram", "Show a texture's spatial spectrum along its length, as a picture or a file",
    "tactograph spectrogram oak -o oak.png -o oak.nc --window 10mm --max-frequency 15/mm\n"
    "  tactograph spectrogram oak.json -o oak.nc        (a recording: its strokes, one after the other)",
    declare_spectrogram_verb};

}  // namespace tacto::spatial
