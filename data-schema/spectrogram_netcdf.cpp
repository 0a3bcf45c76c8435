// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>

#include "data-schema/files.hpp"
#include "data-schema/netcdf_file.hpp"
#include "data-schema/spectrogram_axes.hpp"
#include "data-schema/version.hpp"

namespace tacto::schema {
namespace {

constexpr int kMajor = 1, kMinor = 0;
constexpr std::size_t kChunkCells = std::size_t{1} << 18;  // 1 MB of floats

using Spectrograms = std::span<const Spectrogram>;

std::vector<double> in_millimetres(const std::vector<double>& position_m) {
  std::vector<double> values(position_m.size());
  std::ranges::transform(position_m, values.begin(), [](double m) { return m * kMillimetres; });
  return values;
}

std::vector<double> frequencies_per_mm(const Spectrogram& spectrogram) {
  std::vector<double> values(spectrogram.bins);
  for (std::size_t k = 0; k < values.size(); ++k) values[k] = spectrogram.frequency_per_m(k) / kMillimetres;
  return values;
}

std::vector<float> densities(const Spectrogram& spectrogram) {
  std::vector<float> values(spectrogram.cells.size());
  constexpr auto kPer = static_cast<float>(kMillimetres);
  std::ranges::transform(spectrogram.cells, values.begin(), [](float each) { return each * kPer; });
  return values;
}

std::string names_of(Spectrograms spectrograms) {
  std::string names;
  for (const Spectrogram& each : spectrograms) names += (names.empty() ? "" : "\n") + each.name;
  return names;
}

void put_identity(NetcdfWriter& file, Spectrograms spectrograms) {
  file.attribute("Conventions", std::string("CF-1.10"));
  file.attribute("kind", std::string("spectrogram"));
  file.attribute("version", fmt::format("{}.{}", kMajor, kMinor));
  file.attribute("title", fmt::format("Spatial spectrogram of {}", spectrograms.front().name));
  file.attribute("source", std::string(kCreator));
  file.attribute("texture", names_of(spectrograms));  // one a line
  const auto simulated =
      std::ranges::find_if(spectrograms, [](const auto& each) { return !each.simulated.empty(); });
  if (simulated != spectrograms.end()) file.attribute("simulated", simulated->simulated);
}

void put_windowing(NetcdfWriter& file, const Spectrogram& first) {
  file.attribute("quantity", first.quantity);
  file.attribute("quantity_unit", first.unit);
  file.attribute("scaling", std::string("density, one-sided"));
  file.attribute("window", first.window);
  file.attribute("detrend", first.detrend);
  file.attribute("window_mm", first.window_m * kMillimetres);
  file.attribute("hop_mm", first.hop_m * kMillimetres);
  file.attribute("pitch_mm", first.pitch_m * kMillimetres);
  file.attribute("padded_samples", static_cast<long long>(first.padded_samples));
}

// The variables' ids; stroke is -1 where there is one spectrogram only.
struct Layout {
  int stroke = -1, position = -1, frequency = -1, density = -1;
};

Layout define(NetcdfWriter& file, Spectrograms spectrograms) {
  const Spectrogram& first = spectrograms.front();
  const std::size_t positions = longest(spectrograms).position_m.size();
  const bool several = spectrograms.size() > 1;
  std::vector<int> dimensions;
  if (several) dimensions.push_back(file.dimension("stroke", spectrograms.size()));
  dimensions.push_back(file.dimension("position", positions));
  dimensions.push_back(file.dimension("spatial_frequency", first.bins));
  std::vector<std::size_t> chunk = {1, std::clamp(kChunkCells / first.bins, std::size_t{1}, positions),
                                    first.bins};
  if (!several) chunk.erase(chunk.begin());
  Layout layout;
  if (several) layout.stroke = file.axis("stroke", dimensions[0], "", "stroke");
  layout.position =
      file.axis("position", dimensions[several ? 1 : 0], "mm", "position of the window's centre");
  layout.frequency = file.axis("spatial_frequency", dimensions.back(), "1/mm", "spatial frequency");
  layout.density = file.density(dimensions, chunk, density_unit(first.unit),
                                "power spectral density of " + first.quantity);
  return layout;
}

void put_cells(NetcdfWriter& file, const Layout& layout, Spectrograms spectrograms) {
  for (std::size_t i = 0; i < spectrograms.size(); ++i) {
    std::vector<std::size_t> start = {i, 0, 0};
    std::vector<std::size_t> count = {1, spectrograms[i].position_m.size(), spectrograms[i].bins};
    if (layout.stroke < 0) start.erase(start.begin()), count.erase(count.begin());
    file.put(layout.density, start, count, densities(spectrograms[i]));
  }
}

void put_all(NetcdfWriter& file, Spectrograms spectrograms) {
  put_identity(file, spectrograms);
  put_windowing(file, spectrograms.front());
  const Layout layout = define(file, spectrograms);
  if (layout.stroke >= 0) {
    std::vector<double> strokes(spectrograms.size());
    std::ranges::generate(strokes, [n = 0.0]() mutable { return n += 1; });
    file.put(layout.stroke, strokes);
  }
  file.put(layout.position, in_millimetres(longest(spectrograms).position_m));
  file.put(layout.frequency, frequencies_per_mm(spectrograms.front()));
  put_cells(file, layout, spectrograms);
}

struct Version {
  int major = 0, minor = 0;
};

Version version_of(const std::string& text) {
  Version version;
  const char* end = text.data() + text.size();
  const auto [dot, fault] = std::from_chars(text.data(), end, version.major);
  if (fault == std::errc() && dot != end) std::from_chars(dot + 1, end, version.minor);
  return version;
}

Result<Version> check_kind(NetcdfReader& file, const std::string& path) {
  if (const auto sound = file.status(path); !sound) return forward_error(sound);
  const std::string text = file.text("version");
  const Version version = version_of(text);
  if (file.text("kind") != "spectrogram" || version.major == 0)
    return fail(Fault::malformed, "is netCDF, but no spectrogram of tactograph", path);
  if (version.major > kMajor)
    return fail(Fault::unsupported_version,
                fmt::format("is of version {}; this program reads {}.x", text, kMajor), path,
                "use a newer tactograph");
  return version;
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

void read_density(NetcdfReader& file, std::size_t stroke, Spectrogram& spectrogram) {
  const bool several = file.length("stroke") > 0;
  std::vector<std::size_t> start = {stroke, 0, 0};
  std::vector<std::size_t> count = {1, spectrogram.position_m.size(), spectrogram.bins};
  if (!several) start.erase(start.begin()), count.erase(count.begin());
  spectrogram.cells = file.cells("density", start, count);
  for (float& each : spectrogram.cells) each /= static_cast<float>(kMillimetres);
  if (several && !spectrogram.cells.empty()) drop_absent_rows(spectrogram);
}

Result<Spectrogram> read_stroke(NetcdfReader& file, std::size_t stroke, const std::string& path) {
  Spectrogram spectrogram;
  spectrogram.strokes = std::max(file.length("stroke"), std::size_t{1});
  if (stroke >= spectrogram.strokes)
    return fail(Fault::unsuitable,
                fmt::format("holds {} spectrograms, not {}", spectrogram.strokes, stroke + 1), path);
  read_attributes(file, stroke, spectrogram);
  read_axes(file, spectrogram);
  read_density(file, stroke, spectrogram);
  if (const auto sound = file.status(path); !sound) return forward_error(sound);
  return spectrogram;
}

}  // namespace

Result<void> write_spectrogram_nc(const std::string& path, Spectrograms spectrograms) {
  if (auto fitting = check_axes(spectrograms); !fitting) return fitting;
  PendingFiles pending;
  const auto temporary = pending.add(path);
  if (!temporary) return forward_error(temporary);
  NetcdfWriter file(*temporary);
  put_all(file, spectrograms);
  if (auto closed = file.close(path); !closed) return closed;
  return pending.commit();
}

Result<Spectrogram> read_spectrogram_nc(const std::string& path, std::size_t stroke) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored))
    return fail(Fault::not_found, "there is no such file", path);
  NetcdfReader file(path);
  const auto version = check_kind(file, path);
  if (!version) return forward_error(version);
  auto spectrogram = read_stroke(file, stroke, path);
  if (spectrogram && version->minor > kMinor) spectrogram->newer_version = file.text("version");
  return spectrogram;
}

}  // namespace tacto::schema
