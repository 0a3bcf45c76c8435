// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/spectrogram/spectrogram_axes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tacto::schema {
namespace {

bool alphabetic(const std::string& text) {
  return std::ranges::all_of(text, [](unsigned char c) { return std::isalpha(c) != 0; });
}

// Equal except for rounding: positions were computed as index times pitch.
bool same_positions(const SpectrogramHeader& a, const SpectrogramHeader& b) {
  const std::size_t shared = std::min(a.position_m.size(), b.position_m.size());
  for (std::size_t p = 0; p < shared; ++p)
    if (std::abs(a.position_m[p] - b.position_m[p]) > 1e-6 * a.hop_m) return false;
  return true;
}

const char* difference(const SpectrogramHeader& a, const SpectrogramHeader& b) {
  if (a.quantity != b.quantity || a.unit != b.unit) return "quantities";
  if (a.scaling != b.scaling) return "scalings";
  if (a.bins != b.bins || a.frequency_step_per_m != b.frequency_step_per_m) return "frequency axes";
  if (a.window != b.window || a.window_m != b.window_m || a.hop_m != b.hop_m) return "windows";
  if (a.pitch_m != b.pitch_m || a.padded_samples != b.padded_samples) return "pitches";
  return same_positions(a, b) ? nullptr : "position axes";
}

}  // namespace

std::string cell_unit(const SpectrogramHeader& header) {
  const std::string& unit = header.unit;
  if (header.scaling == Scaling::amplitude) return unit;
  if (unit == "1") return "mm";
  return alphabetic(unit) ? unit + "2 mm" : "(" + unit + ")2 mm";
}

float cell_factor(Scaling scaling) {
  return scaling == Scaling::amplitude ? 1.0F : static_cast<float>(kMillimetres);
}

Result<void> check_axes(const std::optional<SpectrogramHeader>& first, const SpectrogramHeader& header) {
  if (header.position_m.empty() || header.bins == 0)
    return fail(ErrorKind::unsuitable, "the spectrogram has no cells", header.name);
  if (!first) return {};
  if (const char* what = difference(*first, header); what != nullptr)
    return fail(ErrorKind::unsuitable, fmt::format("its {} differ from those of '{}'", what, first->name),
                header.name, "write it to a separate file");
  return {};
}

}  // namespace tacto::schema
