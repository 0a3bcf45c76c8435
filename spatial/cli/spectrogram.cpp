// SPDX-License-Identifier: GPL-3.0-or-later
// tactograph spectrogram: pictures and tables of the spatial spectra of textures.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/base/quantity.hpp"
#include "data-schema/command/budget_options.hpp"
#include "data-schema/command/output_options.hpp"
#include "data-schema/command/verb.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/report/progress.hpp"
#include "data-schema/spectrogram/spectrogram.hpp"
#include "data-schema/spectrogram/spectrogram_writer.hpp"
#include "spatial/cli/formant_row.hpp"
#include "spatial/cli/texture_inputs.hpp"
#include "spatial/cli/verbs.hpp"
#include "spatial/features/formants.hpp"
#include "spatial/picture/figure.hpp"
#include "spatial/picture/spectrogram_figure.hpp"
#include "spatial/picture/spectrogram_output.hpp"
#include "spatial/spectrogram/budget.hpp"
#include "spatial/spectrogram/spectrogram_maker.hpp"
#include "spatial/spectrogram/spectrogram_summary.hpp"
#include "spatial/spectrogram/spectrogram_tally.hpp"

namespace tacto::spatial {
namespace {

using cli::Report;
using schema::Dimension;
using schema::ErrorKind;
using schema::Result;
using schema::SpectrogramHeader;

// The outputs of a run of 'tactograph spectrogram': tables and netCDF row by row, pictures at the end; they
// appear together or not at all.

class SpectrogramFiles {
 public:
  // Precondition: check_outputs(paths). Errors: cannot_write.
  Result<void> open(std::span<const std::string> paths, bool several, bool compress) {
    for (const std::string& path : paths) {
      const OutputForm form = form_of(path);
      if (form == OutputForm::picture) {
        pictures_.push_back(path);
        continue;
      }
      const auto temporary = pending_.add(path);
      TACTO_TRY(temporary);
      const auto open =
          form == OutputForm::netcdf ? schema::open_spectrogram_nc : schema::open_spectrogram_csv;
      auto writer = open(*temporary, {several, compress, path});
      TACTO_TRY(writer);
      writers_.push_back(std::move(*writer));
    }
    return {};
  }

  // Whether a figure is needed.
  bool has_pictures() const { return !pictures_.empty(); }

  Result<void> begin(const schema::SpectrogramHeader& header) {
    for (const auto& writer : writers_)
      if (auto begun = writer->begin(header); !begun) return begun;
    return {};
  }

  Result<void> rows(std::size_t first, std::span<const float> cells) {
    for (const auto& writer : writers_)
      if (auto written = writer->rows(first, cells); !written) return written;
    return {};
  }

  // Ends all files, draws the pictures (`figure` may be null if there are none) and renames all files
  // together. Errors: of the writers and the figure; cannot_write; usage, if a file that must not be
  // replaced has the name.
  Result<void> finish(const Figure* figure, schema::Existing existing) {
    for (const auto& writer : writers_)
      if (auto closed = writer->close(); !closed) return closed;
    writers_.clear();
    for (const std::string& path : pictures_)
      if (auto added = add_figure(pending_, path, *figure); !added) return added;
    return pending_.commit(existing);
  }

 private:
  schema::PendingFiles pending_;
  std::vector<std::unique_ptr<schema::SpectrogramWriter>> writers_;
  std::vector<std::string> pictures_;
};

// A run of 'tactograph spectrogram': computes texture after texture with one maker and writes all files.

void warn_of_odd_options(const SpectrogramOptions& options, double pitch_m) {
  if (options.hop_m > options.window_m)
    cli::warn(
        fmt::format("the hop of {} is longer than the window of {}: the parts between windows are ignored",
                    schema::length_for_people(options.hop_m), schema::length_for_people(options.window_m)));
  if (options.max_frequency_per_m > 0.5 / pitch_m)
    cli::warn(fmt::format("a grid of {} contains no frequencies above {}", schema::length_for_people(pitch_m),
                          schema::for_people(0.5 / pitch_m, Dimension::spatial_frequency)));
}

void warn_if_little_is_seen(const NamedTexture& texture, const SpectrogramHeader& header) {
  const double length_m = texture.texture.signal.length_m();
  const double seen_m = header.position_m.back() - header.position_m.front();
  if (seen_m < 0.25 * length_m)
    cli::warn(
        fmt::format("{}: is only slightly longer than the window, so the spectrogram covers only {} of {}; "
                    "use a shorter --window",
                    texture.path, schema::length_for_people(seen_m), schema::length_for_people(length_m)));
}

template <class T>
tl::unexpected<schema::Error> naming(const NamedTexture& texture, const Result<T>& failed) {
  schema::Error error = failed.error();
  if (error.kind == ErrorKind::unsuitable) error.where = texture.path + ": " + error.where;
  return tl::unexpected(error);
}

// Stores only a few numbers of each spectrogram; with `keep` (for pictures) also all of it, and its texture.
class SpectrogramRun {
 public:
  struct Line {
    std::string name;
    std::size_t positions = 0;
    SpectrogramTally tally;
  };

  // `lowest_per_m`: lower limit of the band over which the lines are summed. Default: that of the pictures.
  SpectrogramRun(const SpectrogramOptions& options, std::optional<double> lowest_per_m,
                 SpectrogramFiles& files, bool keep)
      : options_(options), asked_lowest_per_m_(lowest_per_m), files_(files), keep_(keep) {}

  // Errors: of the inputs, the maker and the files; unsuitable, with both names, for a texture with another
  // pitch or quantity than the first.
  Result<void> transform(TextureInputs& inputs) {
    expected_ = inputs.expected();
    for (;;) {
      auto texture = inputs.next();
      TACTO_TRY(texture);
      if (!*texture) break;
      if (auto taken = take(std::move(**texture)); !taken) return taken;
    }
    if (lines_.empty()) return schema::fail(ErrorKind::unsuitable, "none of the given files is a texture");
    return {};
  }

  // After transform(): one line for each texture, and their common values.
  const std::vector<Line>& lines() const { return lines_; }
  const schema::SpectrogramHeader& first() const { return *first_; }
  const Decimation& decimation() const { return maker_->decimation(); }
  double lowest_per_m() const { return asked_lowest_per_m_.value_or(lowest_shown_per_m(lowest_, *first_)); }
  const std::vector<NamedTexture>& textures() const { return textures_; }
  const std::vector<schema::Spectrogram>& spectrograms() const { return spectrograms_; }

 private:
  Result<void> take(NamedTexture texture) {
    const auto ready = first_ ? check_alike(texture) : prepare(texture);
    if (!ready) return ready;
    auto header = maker_->describe(texture.texture);
    if (!header) return naming(texture, header);
    header->name = texture.name;
    warn_if_little_is_seen(texture, *header);
    if (!first_) {
      first_ = *header;
      lowest_ = INFINITY;
    }
    lowest_ = std::min(lowest_, lowest_of_interest_per_m(texture.texture));
    lines_.push_back({texture.name, header->position_m.size(), {*header, lowest_per_m()}});
    if (auto made = make(texture, *header); !made) return naming(texture, made);
    if (keep_) textures_.push_back(std::move(texture));
    return {};
  }

  // The number of rows is estimated from the first texture, because most others are about as long.
  Result<void> prepare(const NamedTexture& first) {
    const auto& signal = first.texture.signal;
    const auto shape = frame_shape(options_, signal.pitch_m);
    TACTO_TRY(shape);
    auto maker = SpectrogramMaker::prepare(options_, signal.pitch_m,
                                           expected_ * (1 + signal.values.size() / shape->hop));
    TACTO_TRY(maker);
    maker_.emplace(std::move(*maker));
    first_path_ = first.path;
    warn_of_odd_options(options_, signal.pitch_m);
    return {};
  }

  Result<void> check_alike(const NamedTexture& other) const {
    const double pitch_m = first_->pitch_m;
    const auto& texture = other.texture;
    if (std::abs(texture.signal.pitch_m - pitch_m) > 1e-9 * pitch_m)
      return schema::fail(
          ErrorKind::unsuitable,
          fmt::format("has a grid of {}, but {} has {}", schema::length_for_people(texture.signal.pitch_m),
                      first_path_, schema::length_for_people(pitch_m)),
          other.path, "make one spectrogram of each, or make textures with equal grids ('spatial --grid')");
    if (texture.quantity != first_->quantity || texture.unit != first_->unit)
      return schema::fail(
          ErrorKind::unsuitable,
          fmt::format("contains {}, but {} contains {}", texture.quantity, first_path_, first_->quantity),
          other.path, "make one spectrogram of each");
    return {};
  }

  Result<void> make(const NamedTexture& texture, const SpectrogramHeader& header) {
    if (auto begun = files_.begin(header); !begun) return begun;
    if (keep_) spectrograms_.push_back({header, {}});
    const auto before = static_cast<double>(lines_.size() - 1),
               rows = static_cast<double>(header.position_m.size());
    return maker_->make(
        texture.texture, [&](std::size_t first, std::span<const float> cells) -> Result<void> {
          lines_.back().tally.add(first, cells);
          if (keep_) {
            auto& kept = spectrograms_.back().cells;
            kept.insert(kept.end(), cells.begin(), cells.end());
          }
          progress_.update(
              std::min(1.0, (before + static_cast<double>(first) / rows) / static_cast<double>(expected_)));
          return files_.rows(first, cells);
        });
  }

  SpectrogramOptions options_;
  std::optional<double> asked_lowest_per_m_;
  SpectrogramFiles& files_;
  bool keep_;
  cli::Progress progress_{"spectrogram"};
  std::size_t expected_ = 0;
  std::optional<SpectrogramMaker> maker_;
  std::optional<schema::SpectrogramHeader> first_;
  std::string first_path_;
  double lowest_ = 0;
  std::vector<Line> lines_;
  std::vector<NamedTexture> textures_;
  std::vector<schema::Spectrogram> spectrograms_;
};

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
