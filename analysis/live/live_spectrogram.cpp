// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/live/live_spectrogram.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>

#include "analysis/live/live_query.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/report/report.hpp"
#include "spatial/features/formants.hpp"
#include "spatial/picture/spectrogram_figure.hpp"
#include "spatial/spectrogram/spectrogram.hpp"
#include "spatial/spectrogram/spectrogram_summary.hpp"

namespace tacto::analysis {
namespace {

namespace fs = std::filesystem;

using schema::ErrorKind;
using schema::fail;
using schema::Result;

constexpr std::size_t kLeastRows = 2;

Result<void> check_size(const schema::Texture& texture, const std::string& file) {
  const spatial::SpectrogramOptions options;
  const auto& signal = texture.signal;
  const auto shape = spatial::frame_shape(options, signal.pitch_m);
  TACTO_TRY(shape);
  const double bins = options.max_frequency_per_m * static_cast<double>(shape->padded) * signal.pitch_m;
  if (bins * signal.length_m() / options.hop_m <= static_cast<double>(kMostLiveCells)) return {};
  return fail(ErrorKind::unsuitable,
              fmt::format("is {:.3g} m long: its spectrogram has more than {} cells", signal.length_m(),
                          kMostLiveCells),
              file,
              "see it with 'tactograph spectrogram', or make a shorter texture with 'spatial --from --to'");
}

spatial::SpectrogramFigure figure_of(const LiveSpectrogram& live, const SpectrogramPart& part) {
  spatial::SpectrogramPictureOptions options;
  options.min_frequency_per_m = part.low_per_m;
  options.dynamic_range_db = part.range_db;
  spatial::SpectrogramPanel panel{&live.texture, &live.spectrogram, {}};
  if (part.formants) panel.formants = live.formants;
  return spatial::SpectrogramFigure({panel}, options);
}

cli::Report formant_row(const schema::Formant& formant) {
  std::vector<cli::Report> track;
  for (const schema::FormantPoint& point : formant.track)
    track.push_back(
        cli::Report().add("position_m", point.position_m).add("frequency_per_m", point.frequency_per_m));
  cli::Report row;
  row.add("from_m", formant.from_m)
      .add("to_m", formant.to_m)
      .add("frequency_per_m", formant.frequency_per_m)
      .add("width_per_m", formant.width_per_m)
      .add("level_db", formant.level_db)
      .add("prominence_db", formant.prominence_db)
      .add("track", std::move(track));
  return row;
}

// The texture under the windows of a spectrogram.
schema::Texture under(const schema::Spectrogram& spectrogram, const schema::Texture& whole) {
  const schema::SpaceSignal& signal = whole.signal;
  const auto sample = [&](double position_m) {
    const double index = std::round((position_m - signal.origin_m) / signal.pitch_m);
    return static_cast<std::ptrdiff_t>(std::clamp(index, 0.0, static_cast<double>(signal.values.size())));
  };
  const auto first = sample(spectrogram.position_m.front() - spectrogram.window_m / 2);
  const auto end = sample(spectrogram.position_m.back() + spectrogram.window_m / 2);
  schema::Texture part = whole;
  part.signal.origin_m = signal.position_m(static_cast<std::size_t>(first));
  part.signal.values.assign(signal.values.begin() + first, signal.values.begin() + end);
  return part;
}

Result<LiveSpectrogram> part_of(const LiveSpectrogram& live, const SpectrogramPart& part) {
  const schema::Spectrogram& whole = live.spectrogram;
  const auto& positions = whole.position_m;
  const auto first = std::ranges::lower_bound(positions, part.from_m.value_or(-INFINITY)) - positions.begin();
  const auto end = std::ranges::upper_bound(positions, part.to_m.value_or(INFINITY)) - positions.begin();
  if (end - first < static_cast<std::ptrdiff_t>(kLeastRows))
    return fail(ErrorKind::unsuitable, "contains fewer than two windows", "the selection",
                "select a longer part of the positions");
  const double last_bin = part.high_per_m.value_or(INFINITY) / whole.frequency_step_per_m;
  const schema::SpectrogramHeader& header = whole;
  LiveSpectrogram made{{}, {header, {}}, live.formants};
  schema::Spectrogram& spectrogram = made.spectrogram;
  spectrogram.bins =
      static_cast<std::size_t>(std::clamp(last_bin + 1 + 1e-9, 2.0, static_cast<double>(whole.bins)));
  spectrogram.position_m.assign(positions.begin() + first, positions.begin() + end);
  if (!whole.known.empty()) spectrogram.known.assign(whole.known.begin() + first, whole.known.begin() + end);
  for (auto row = first; row < end; ++row) {
    const auto cells = whole.cells.begin() + row * static_cast<std::ptrdiff_t>(whole.bins);
    spectrogram.cells.insert(spectrogram.cells.end(), cells,
                             cells + static_cast<std::ptrdiff_t>(spectrogram.bins));
  }
  made.texture = under(spectrogram, live.texture);
  return made;
}

// The content of a file that `write` writes.
Result<std::string> written(const std::function<Result<void>(const std::string& path)>& write) {
  std::error_code ignored;
  std::string path = (fs::temp_directory_path(ignored) / "tactograph-XXXXXX").string();
  const int descriptor = mkstemp(path.data());
  if (descriptor < 0)
    return fail(ErrorKind::cannot_write, "no temporary file can be made", path,
                "set TMPDIR to a folder with room");
  close(descriptor);
  const auto done = write(path);
  auto content = done ? schema::read_file(path) : schema::forward_error(done);
  unlink(path.c_str());
  return content;
}

Result<std::string> file_of(const LiveSpectrogram& live, const SpectrogramPart& part,
                            const std::string& form) {
  const std::span<const schema::Spectrogram> one(&live.spectrogram, 1);
  if (form == "png") return spatial::to_png(figure_of(live, part));
  if (form == "svg") return spatial::to_svg(figure_of(live, part));
  if (form == "csv")
    return written([&](const std::string& path) { return schema::write_spectrogram_csv(path, one); });
  if (form == "nc")
    return written([&](const std::string& path) { return schema::write_spectrogram_nc(path, one); });
  return fail(ErrorKind::not_found, "is no format of a spectrogram", form, "use png, svg, csv or nc");
}

}  // namespace

Result<LiveSpectrogram> make_live_spectrogram(const std::string& file) {
  auto texture = schema::read_texture(file);
  TACTO_TRY(texture);
  TACTO_TRY(check_size(*texture, file));
  auto spectrogram = spatial::spatial_spectrogram(*texture, {});
  if (!spectrogram) {
    schema::Error error = spectrogram.error();
    error.where = file;
    return tl::unexpected(error);
  }
  spectrogram->name = fs::path(schema::stem_of(file, ".texture")).filename().string();
  auto formants = spatial::find_formants(*spectrogram);
  TACTO_TRY(formants);
  return LiveSpectrogram{std::move(*texture), std::move(*spectrogram), std::move(*formants)};
}

std::string spectrogram_json(std::size_t made, const LiveSpectrogram& live) {
  const schema::Spectrogram& spectrogram = live.spectrogram;
  const schema::SpaceSignal& signal = live.texture.signal;
  const spatial::LevelReference reference = spatial::level_reference(spectrogram);
  const spatial::SpectrogramFigure figure = figure_of(live, {});
  std::vector<cli::Report> formants;
  for (const schema::Formant& formant : live.formants) formants.push_back(formant_row(formant));
  cli::Report json;
  json.add("made", made)
      .add("name", spectrogram.name)
      .add("quantity", spectrogram.quantity)
      .add("rows", spectrogram.position_m.size())
      .add("bins", spectrogram.bins)
      .add("first_position_m", spectrogram.position_m.front())
      .add("last_position_m", spectrogram.position_m.back())
      .add("hop_m", spectrogram.hop_m)
      .add("frequency_step_per_m", spectrogram.frequency_step_per_m)
      .add("start_m", signal.origin_m)
      .add("end_m", signal.origin_m + signal.length_m())
      .add("window_m", spectrogram.window_m)
      .add("resolution_per_m", spatial::resolution_per_m(spectrogram))
      .add("cell_unit", schema::cell_unit(spectrogram))
      .add("level_unit", reference.unit)
      .add("level_factor", reference.factor / double{schema::cell_factor(spectrogram.scaling)})
      .add("level_decade_db", reference.decade_db)
      .add("lowest_per_m", figure.lowest_per_m())
      .add("low_db", figure.levels().low_db)
      .add("high_db", figure.levels().high_db)
      .add("speed_mps", live.texture.source.mean_speed_mps)
      .add("simulated", live.texture.simulated)
      .add("formants", std::move(formants));
  return json.json();
}

std::vector<float> stored_cells(const schema::Spectrogram& spectrogram) {
  std::vector<float> cells = spectrogram.cells;
  const float factor = schema::cell_factor(spectrogram.scaling);
  for (float& cell : cells) cell *= factor;
  return cells;
}

std::vector<float> known_limits(const schema::Spectrogram& spectrogram) {
  std::vector<float> limits;
  for (const schema::KnownBand& band : spectrogram.known) {
    limits.push_back(static_cast<float>(band.low_per_m));
    limits.push_back(static_cast<float>(band.high_per_m));
  }
  return limits;
}

Result<SpectrogramPart> parse_spectrogram_part(const std::string& query) {
  SpectrogramPart part;
  const auto read = read_query(query, "from_m, to_m, low_per_m, high_per_m, range_db, formants",
                               [&part](std::string_view name, double value) {
                                 if (name == "from_m")
                                   part.from_m = value;
                                 else if (name == "to_m")
                                   part.to_m = value;
                                 else if (name == "low_per_m")
                                   part.low_per_m = value;
                                 else if (name == "high_per_m")
                                   part.high_per_m = value;
                                 else if (name == "range_db")
                                   part.range_db = value;
                                 else if (name == "formants")
                                   part.formants = value != 0;
                                 else
                                   return false;
                                 return true;
                               });
  TACTO_TRY(read);
  return part;
}

Result<std::string> spectrogram_file(const LiveSpectrogram& live, const SpectrogramPart& part,
                                     const std::string& form) {
  if (!part.from_m && !part.to_m && !part.high_per_m) return file_of(live, part, form);
  const auto selected = part_of(live, part);
  TACTO_TRY(selected);
  return file_of(*selected, part, form);
}

}  // namespace tacto::analysis
