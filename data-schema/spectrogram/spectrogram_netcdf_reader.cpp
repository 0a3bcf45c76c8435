// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "data-schema/base/format_version.hpp"
#include "data-schema/spectrogram/netcdf_file.hpp"
#include "data-schema/spectrogram/spectrogram_axes.hpp"

namespace tacto::schema {
namespace {

// Its version, if it is newer than this program's, else "".
Result<std::string> check_kind(NetcdfReader& file, const std::string& path) {
  TACTO_TRY(file.status(path));
  if (file.text("kind") != "spectrogram")
    return fail(ErrorKind::malformed, "is netCDF, but not a spectrogram of tactograph", path);
  return newer_version(file.text("version"), path, path);
}

std::string nth_line(const std::string& text, std::size_t n) {
  std::size_t start = 0;
  for (; n > 0; --n) start = std::min(text.find('\n', start), text.size() - 1) + 1;
  return text.substr(start, text.find('\n', start) - start);
}

void read_attributes(NetcdfReader& file, std::size_t stroke, Spectrogram& spectrogram) {
  spectrogram.name = nth_line(file.text("texture"), stroke);
  spectrogram.quantity = file.text("quantity");
  spectrogram.unit = file.text("quantity_unit");
  spectrogram.window = file.text("window");
  spectrogram.detrend = file.text("detrend");
  spectrogram.simulated = file.text("simulated");
  spectrogram.window_m = file.number("window_mm") / kMillimetres;
  spectrogram.hop_m = file.number("hop_mm") / kMillimetres;
  spectrogram.pitch_m = file.number("pitch_mm") / kMillimetres;
  if (file.text("scaling").starts_with("amplitude")) spectrogram.scaling = Scaling::amplitude;
  const double gain = file.number("window_coherent_gain"), decimation = file.number("decimation");
  if (gain > 0) spectrogram.coherent_gain = gain;
  if (decimation >= 1 && decimation < 1e15) spectrogram.decimation = static_cast<std::size_t>(decimation);
  const double padded = file.number("padded_samples");
  if (padded > 0 && padded < 1e15) spectrogram.padded_samples = static_cast<std::size_t>(padded);
}

void read_axes(NetcdfReader& file, Spectrogram& spectrogram) {
  spectrogram.position_m = file.axis("position");
  for (double& each : spectrogram.position_m) each /= kMillimetres;
  const std::vector<double> frequencies = file.axis("spatial_frequency");
  spectrogram.bins = frequencies.size();
  if (frequencies.size() > 1)
    spectrogram.frequency_step_per_m =
        frequencies.back() * kMillimetres / static_cast<double>(frequencies.size() - 1);
}

// A stroke shorter than the file's longest ends in NaN.
void drop_absent_rows(Spectrogram& spectrogram) {
  const auto bins = static_cast<std::ptrdiff_t>(spectrogram.bins);
  auto& cells = spectrogram.cells;
  const auto last_is_absent = [&] {
    return std::all_of(cells.end() - bins, cells.end(), [](float each) { return std::isnan(each); });
  };
  while (!spectrogram.position_m.empty() && last_is_absent()) {
    cells.resize(cells.size() - spectrogram.bins);
    spectrogram.position_m.pop_back();
  }
}

Part part_of(NetcdfReader& file, std::size_t stroke, std::vector<std::size_t> lengths) {
  Part part{std::vector<std::size_t>(lengths.size(), 0), std::move(lengths)};
  if (file.length("stroke") == 0) return part;
  part.start.insert(part.start.begin(), stroke);
  part.count.insert(part.count.begin(), 1);
  return part;
}

void read_cells(NetcdfReader& file, std::size_t stroke, Spectrogram& spectrogram) {
  const char* name = spectrogram.scaling == Scaling::amplitude ? "amplitude" : "density";
  const Part part = part_of(file, stroke, {spectrogram.position_m.size(), spectrogram.bins});
  spectrogram.cells = file.cells(name, part);
  const float factor = cell_factor(spectrogram.scaling);
  for (float& each : spectrogram.cells) each /= factor;
  if (part.count.size() == 3 && !spectrogram.cells.empty()) drop_absent_rows(spectrogram);
}

// A file whose textures had no valid band lacks both; NaN if one of several had none.
void read_known(NetcdfReader& file, std::size_t stroke, Spectrogram& spectrogram) {
  if (!file.has("known_from") || !file.has("known_to")) return;
  const Part part = part_of(file, stroke, {spectrogram.position_m.size()});
  const auto low = file.values("known_from", part), high = file.values("known_to", part);
  if (low.size() != high.size() || low.empty() || std::isnan(low.front())) return;
  for (std::size_t p = 0; p < low.size(); ++p)
    spectrogram.known.push_back({low[p] * kMillimetres, high[p] * kMillimetres});
}

Result<Spectrogram> read_stroke(NetcdfReader& file, std::size_t stroke, const std::string& path) {
  Spectrogram spectrogram;
  spectrogram.strokes = std::max(file.length("stroke"), std::size_t{1});
  if (stroke >= spectrogram.strokes)
    return fail(ErrorKind::unsuitable,
                fmt::format("contains {} spectrograms, not {}", spectrogram.strokes, stroke + 1), path);
  read_attributes(file, stroke, spectrogram);
  read_axes(file, spectrogram);
  read_cells(file, stroke, spectrogram);
  read_known(file, stroke, spectrogram);
  TACTO_TRY(file.status(path));
  return spectrogram;
}

}  // namespace

Result<Spectrogram> read_spectrogram_nc(const std::string& path, std::size_t stroke) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored))
    return fail(ErrorKind::not_found, "there is no such file", path);
  NetcdfReader file(path);
  auto newer = check_kind(file, path);
  TACTO_TRY(newer);
  auto spectrogram = read_stroke(file, stroke, path);
  if (spectrogram) spectrogram->newer_version = std::move(*newer);
  return spectrogram;
}

bool is_spectrogram_nc(const std::string& path) {
  return NetcdfReader(path).text("kind") == "spectrogram";
}

}  // namespace tacto::schema
