// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/spectrogram_axes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tacto::schema {
namespace {

bool alphabetic(const std::string& text) {
  return std::ranges::all_of(text, [](unsigned char c) { return std::isalpha(c) != 0; });
}

// Equal but for rounding: positions were computed as index times pitch.
bool same_positions(const Spectrogram& a, const Spectrogram& b) {
  const std::size_t shared = std::min(a.position_m.size(), b.position_m.size());
  for (std::size_t p = 0; p < shared; ++p)
    if (std::abs(a.position_m[p] - b.position_m[p]) > 1e-6 * a.hop_m) return false;
  return true;
}

const char* difference(const Spectrogram& a, const Spectrogram& b) {
  if (a.quantity != b.quantity || a.unit != b.unit) return "quantities";
  if (a.bins != b.bins || a.frequency_step_per_m != b.frequency_step_per_m) return "frequency axes";
  if (a.window != b.window || a.window_m != b.window_m || a.hop_m != b.hop_m) return "windows";
  if (a.pitch_m != b.pitch_m || a.padded_samples != b.padded_samples) return "pitches";
  return same_positions(a, b) ? nullptr : "position axes";
}

}  // namespace

std::string density_unit(const std::string& unit) {
  if (unit == "1") return "mm";
  return alphabetic(unit) ? unit + "2 mm" : "(" + unit + ")2 mm";
}

Result<void> check_axes(std::span<const Spectrogram> spectrograms) {
  if (spectrograms.empty()) return fail(Fault::unsuitable, "there is no spectrogram to write");
  for (const Spectrogram& each : spectrograms) {
    if (each.position_m.empty() || each.bins == 0 ||
        each.cells.size() != each.position_m.size() * each.bins)
      return fail(Fault::unsuitable, "the spectrogram has no cells", each.name);
    if (const char* what = difference(spectrograms.front(), each); what != nullptr)
      return fail(Fault::unsuitable,
                  fmt::format("its {} differ from those of '{}'", what, spectrograms.front().name), each.name,
                  "write it to a file of its own");
  }
  return {};
}

const Spectrogram& longest(std::span<const Spectrogram> spectrograms) {
  return *std::ranges::max_element(spectrograms, {},
                                   [](const Spectrogram& s) { return s.position_m.size(); });
}

}  // namespace tacto::schema
