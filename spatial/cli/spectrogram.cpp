// SPDX-License-Identifier: GPL-3.0-or-later
// tactograph spectrogram: textures to pictures and tables of their spatial spectrum.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "data-schema/cli/progress.hpp"
#include "data-schema/file_kind.hpp"
#include "data-schema/texture.hpp"
#include "spatial/cli/verbs.hpp"
#include "spatial/formants.hpp"
#include "spatial/picture/spectrogram_output.hpp"
#include "spatial/spectrogram.hpp"
#include "spatial/spectrogram_summary.hpp"

namespace tacto::spatial {
namespace {

using cli::Report;
using schema::Dimension;
using schema::Fault;
using schema::Result;
using schema::Spectrogram;
using schema::Texture;

struct Options {
  std::vector<std::string> names, outputs;
  SpectrogramOptions spectrogram;
  SpectrogramPictureOptions picture;
  bool formants = false;
};

using FormantLists = std::vector<std::vector<schema::Formant>>;

struct Named {
  std::string path, name;
  Texture texture;
};

std::string length(double metres) {
  return schema::for_people(metres, Dimension::length);
}

// The textures among the files that a name stands for. Where many are named, other kinds are passed over.
Result<std::vector<std::string>> texture_paths(const std::string& name, bool alone) {
  const auto files = schema::stored_files(name);
  if (!files) return schema::forward_error(files);
  std::vector<std::string> paths;
  for (const auto& file : *files)
    if (file.kind == schema::FileKind::texture) paths.push_back(file.path);
  if (!paths.empty()) return paths;
  const std::string what = fmt::format("is a {}, not a texture", schema::kind_name(files->front().kind));
  if (alone)
    return schema::fail(Fault::unsuitable, what, name, "'tactograph spatial' makes textures from recordings");
  cli::warn(fmt::format("{}: {}; skipped", name, what));
  return paths;
}

std::string name_of(const std::string& path) {
  return std::filesystem::path(schema::stem_of(path, ".texture")).filename().string();
}

Result<Named> open_texture(const std::string& path) {
  auto texture = schema::read_texture(path);
  if (!texture) return schema::forward_error(texture);
  if (!texture->newer_version.empty())
    cli::warn(fmt::format("{}: is of the newer version {}; what is unknown in it is left alone", path,
                          texture->newer_version));
  return Named{path, name_of(path), std::move(*texture)};
}

Result<void> check_alike(const Named& first, const Named& other) {
  const double pitch_m = first.texture.signal.pitch_m;
  if (std::abs(other.texture.signal.pitch_m - pitch_m) > 1e-9 * pitch_m)
    return schema::fail(Fault::unsuitable,
                        fmt::format("has a grid of {}, but {} has {}", length(other.texture.signal.pitch_m),
                                    first.path, length(pitch_m)),
                        other.path,
                        "make a spectrogram of each alone, or textures on one grid ('spatial --grid')");
  if (other.texture.quantity != first.texture.quantity || other.texture.unit != first.texture.unit)
    return schema::fail(
        Fault::unsuitable,
        fmt::format("holds {}, but {} holds {}", other.texture.quantity, first.path, first.texture.quantity),
        other.path, "make a spectrogram of each alone");
  return {};
}

Result<std::vector<Named>> open_textures(const std::vector<std::string>& names) {
  std::vector<std::string> paths;
  for (const std::string& name : names) {
    const auto found = texture_paths(name, names.size() == 1);
    if (!found) return schema::forward_error(found);
    for (const std::string& path : *found)
      if (std::ranges::find(paths, path) == paths.end()) paths.push_back(path);
  }
  if (paths.empty()) return schema::fail(Fault::unsuitable, "there is no texture among the files named");
  std::vector<Named> textures;
  for (const std::string& path : paths) {
    auto texture = open_texture(path);
    if (!texture) return schema::forward_error(texture);
    textures.push_back(std::move(*texture));
    if (auto alike = check_alike(textures.front(), textures.back()); !alike)
      return schema::forward_error(alike);
  }
  return textures;
}

void warn_of_odd_options(const Options& options, double pitch_m) {
  if (options.spectrogram.hop_m > options.spectrogram.window_m)
    cli::warn(
        fmt::format("the hop of {} is longer than the window of {}: what lies between windows is not seen",
                    length(options.spectrogram.hop_m), length(options.spectrogram.window_m)));
  if (options.spectrogram.max_frequency_per_m > 0.5 / pitch_m)
    cli::warn(fmt::format("a grid of {} holds no frequencies above {}", length(pitch_m),
                          schema::for_people(0.5 / pitch_m, Dimension::spatial_frequency)));
}

void warn_if_little_is_seen(const Named& texture, const Spectrogram& spectrogram) {
  const double length_m = texture.texture.signal.length_m();
  const double seen_m = spectrogram.position_m.back() - spectrogram.position_m.front();
  if (seen_m < 0.25 * length_m)
    cli::warn(fmt::format(
        "{}: is hardly longer than the window, so the spectrogram covers only {} of {}; a shorter "
        "--window shows more",
        texture.path, length(seen_m), length(length_m)));
}

Result<std::vector<Spectrogram>> transform(const std::vector<Named>& textures,
                                           const SpectrogramOptions& options) {
  cli::Progress progress("spectrogram");
  std::vector<Spectrogram> spectrograms;
  const auto count = static_cast<double>(textures.size());
  for (const Named& texture : textures) {
    const auto done = static_cast<double>(spectrograms.size());
    auto spectrogram = spatial_spectrogram(texture.texture, options,
                                           [&](double part) { progress.update((done + part) / count); });
    if (!spectrogram) {
      schema::Error error = spectrogram.error();
      if (error.fault == Fault::unsuitable) error.where = texture.path + ": " + error.where;
      return tl::unexpected(error);
    }
    spectrogram->name = texture.name;
    warn_if_little_is_seen(texture, *spectrogram);
    spectrograms.push_back(std::move(*spectrogram));
  }
  return spectrograms;
}

// Empty lists where they are not asked for.
Result<FormantLists> formants_of(const std::vector<Named>& textures,
                                 const std::vector<Spectrogram>& spectrograms, bool wanted) {
  FormantLists lists(textures.size());
  for (std::size_t i = 0; wanted && i < textures.size(); ++i) {
    auto found = find_formants(spectrograms[i], textures[i].texture.valid_band);
    if (!found) return schema::forward_error(found);
    lists[i] = std::move(*found);
  }
  return lists;
}

SpectrogramFigure figure_of(const std::vector<Named>& textures, const std::vector<Spectrogram>& spectrograms,
                            const FormantLists& formants, const SpectrogramPictureOptions& options) {
  std::vector<SpectrogramPanel> panels;
  for (std::size_t i = 0; i < textures.size(); ++i)
    panels.push_back({&textures[i].texture, &spectrograms[i], formants[i]});
  return SpectrogramFigure(panels, options);
}

std::string rms_key(const std::string& unit) {
  if (unit == "N") return "band_rms_n";
  if (unit == "m") return "band_rms_m";
  if (unit == "V") return "band_rms_v";
  return "band_rms";
}

Report row_of(const Spectrogram& spectrogram, double lowest_per_m) {
  const SpectralPeak peak = strongest_peak(spectrogram, lowest_per_m);
  Report row;
  row.add("texture", spectrogram.name)
      .add("positions", spectrogram.position_m.size())
      .add("peak_position_m", peak.position_m)
      .add("peak_frequency_per_m", peak.frequency_per_m)
      .add("peak_level_db", level_db(peak.density, level_reference(spectrogram)))
      .add(rms_key(spectrogram.unit), band_rms(spectrogram, lowest_per_m));
  return row;
}

Report report_of(const std::vector<Spectrogram>& spectrograms, double lowest_per_m, const Options& options) {
  const Spectrogram& first = spectrograms.front();
  std::vector<Report> rows;
  for (const Spectrogram& each : spectrograms) rows.push_back(row_of(each, lowest_per_m));
  Report report;
  report.add("textures", std::move(rows))
      .add("window_m", first.window_m)
      .add("hop_m", first.hop_m)
      .add("padded_samples", first.padded_samples)
      .add("detrend", first.detrend)
      .add("bins", first.bins)
      .add("bin_spacing_per_m", first.frequency_step_per_m)
      .add("resolution_per_m", resolution_per_m(first))
      .add("band_from_per_m", lowest_per_m)
      .add("band_to_per_m", first.frequency_per_m(first.bins - 1))
      .add("level_reference", level_reference(first).unit)
      .add("files", options.outputs);
  return report;
}

Result<void> check_options(const Options& options) {
  const auto& lowest = options.picture.min_frequency_per_m;
  if (lowest && !(*lowest > 0 && *lowest < options.spectrogram.max_frequency_per_m))
    return schema::fail(Fault::usage, "the minimum frequency must lie between 0 and the maximum",
                        "--min-frequency");
  if (!(options.picture.dynamic_range_db > 0))
    return schema::fail(Fault::usage, "the dynamic range must be above 0 dB", "--dynamic-range",
                        "60dB is usual");
  return check_outputs(options.outputs);
}

Result<Report> run(const Options& options) {
  if (auto checked = check_options(options); !checked) return schema::forward_error(checked);
  const auto textures = open_textures(options.names);
  if (!textures) return schema::forward_error(textures);
  const auto spectrograms = transform(*textures, options.spectrogram);
  if (!spectrograms) return schema::forward_error(spectrograms);
  warn_of_odd_options(options, textures->front().texture.signal.pitch_m);
  const auto formants = formants_of(*textures, *spectrograms, options.formants);
  if (!formants) return schema::forward_error(formants);
  const SpectrogramFigure figure = figure_of(*textures, *spectrograms, *formants, options.picture);
  if (auto written = write_outputs(options.outputs, figure, *spectrograms); !written)
    return schema::forward_error(written);
  return report_of(*spectrograms, figure.lowest_per_m(), options);
}

void declare_options(CLI::App& app, Options& options) {
  auto& spectrogram = options.spectrogram;
  app.add_option("TEXTURE", options.names, "Textures, by stem or file; several share one picture")
      ->required();
  app.add_option("-o,--output", options.outputs,
                 "What to write: .png, .svg, .nc (netCDF-4) or .csv; may be repeated")
      ->required()
      ->allow_extra_args(false);
  cli::add_quantity(app, "--window", spectrogram.window_m, Dimension::length,
                    "Length of the Blackman window");
  cli::add_quantity(app, "--hop", spectrogram.hop_m, Dimension::length,
                    "Distance from one window to the next");
  cli::add_quantity(app, "--padding", spectrogram.padded_m, Dimension::length,
                    "Length of a window with the zeros after it [the next power of two in samples]");
  cli::add_quantity(app, "--max-frequency", spectrogram.max_frequency_per_m, Dimension::spatial_frequency,
                    "Highest spatial frequency that is kept");
  cli::add_quantity(
      app, "--min-frequency", options.picture.min_frequency_per_m, Dimension::spatial_frequency,
      "Lower end of the picture's axis and of the band that is summed up [0.7 of the texture's valid "
      "band, else 0.1/mm]");
  cli::add_quantity(app, "--dynamic-range", options.picture.dynamic_range_db, Dimension::level,
                    "Levels from the darkest to the brightest colour");
  app.add_flag("--formants", options.formants, "Draw the formants ('tactograph formants' lists them)");
  const std::map<std::string, Detrend> detrends = {{"none", Detrend::none}, {"constant", Detrend::constant}};
  app.add_option("--detrend", spectrogram.detrend,
                 "Take each window's mean off first (constant), or not (none)")
      ->transform(CLI::CheckedTransformer(detrends).description("{constant,none}"))
      ->default_str("constant");
}

cli::Action declare(CLI::App& app) {
  auto options = std::make_shared<Options>();
  declare_options(app, *options);
  return [options] { return run(*options); };
}

}  // namespace

const cli::Verb kSpectrogramVerb{
    "spectrogram", "Show a texture's spatial spectrum along its length, as a picture or a file",
    "tactograph spectrogram oak -o oak.png -o oak.nc --window 10mm --max-frequency 15/mm", declare};

}  // namespace tacto::spatial
