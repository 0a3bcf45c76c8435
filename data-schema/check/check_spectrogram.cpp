// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "data-schema/check/check_parts.hpp"
#include "data-schema/spectrogram/spectrogram.hpp"

namespace tacto::schema {
namespace {

void add_axes(const std::string& path, const Spectrogram& spectrogram, std::vector<Finding>& findings) {
  const auto& positions = spectrogram.position_m;
  if (positions.empty() || spectrogram.bins == 0) findings.push_back({path, "has no cells"});
  // `not less` instead of `greater or equal`: NaN is not a position either.
  const auto stuck = std::ranges::adjacent_find(positions, [](double a, double b) { return !(a < b); });
  if (stuck != positions.end())
    findings.push_back(
        {fmt::format("{}, position {}", path, stuck - positions.begin() + 1), "positions must increase"});
}

void add_windowing(const std::string& path, const Spectrogram& spectrogram, std::vector<Finding>& findings) {
  const std::pair<const char*, double> numbers[] = {
      {"window_mm", spectrogram.window_m}, {"hop_mm", spectrogram.hop_m}, {"pitch_mm", spectrogram.pitch_m}};
  for (const auto& [name, value] : numbers)
    if (!(value > 0))
      findings.push_back({path, fmt::format("its attribute {} is not a number above 0", name)});
}

void add_cells(const std::string& path, const Spectrogram& spectrogram, std::vector<Finding>& findings) {
  const auto broken = [](float each) { return !(std::isfinite(each) && each >= 0); };
  const auto found = std::ranges::find_if(spectrogram.cells, broken);
  if (found == spectrogram.cells.end()) return;
  const auto cell = static_cast<std::size_t>(found - spectrogram.cells.begin());
  findings.push_back(
      {fmt::format("{}, position {}, bin {}", path, cell / spectrogram.bins, cell % spectrogram.bins),
       fmt::format("{} is not a density", *found)});
}

}  // namespace

Result<Checked> check_spectrogram(const std::string& path) {
  Checked checked;
  for (std::size_t stroke = 0, strokes = 1; stroke < strokes; ++stroke) {
    const auto spectrogram = read_spectrogram_nc(path, stroke);
    TACTO_TRY(spectrogram);
    strokes = spectrogram->strokes;
    checked.newer_version = spectrogram->newer_version;
    const std::string where = strokes == 1 ? path : fmt::format("{}, stroke {}", path, stroke + 1);
    add_axes(where, *spectrogram, checked.findings);
    add_windowing(where, *spectrogram, checked.findings);
    add_cells(where, *spectrogram, checked.findings);
  }
  const auto stored = check_spectrogram_cells(path);
  TACTO_TRY(stored);
  checked.findings.insert(checked.findings.end(), stored->begin(), stored->end());
  return checked;
}

}  // namespace tacto::schema
