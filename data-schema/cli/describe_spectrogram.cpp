// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "data-schema/cli/describe.hpp"
#include "data-schema/spectrogram/spectrogram.hpp"

namespace tacto::schema {
namespace {

using cli::Report;

void add_axes(Report& report, const Spectrogram& s) {
  report.add("positions", s.position_m.size());
  if (!s.position_m.empty()) report.add("from_m", s.position_m.front()).add("to_m", s.position_m.back());
  report.add("frequencies", s.bins).add("frequency_step_per_m", s.frequency_step_per_m);
  if (s.bins > 0) report.add("max_frequency_per_m", s.frequency_per_m(s.bins - 1));
}

void add_windowing(Report& report, const Spectrogram& s) {
  report.add("window", s.window)
      .add("window_length_m", s.window_m)
      .add("hop_m", s.hop_m)
      .add("pitch_m", s.pitch_m);
  report.add("padded_samples", s.padded_samples);
  report.add("scaling", s.scaling == Scaling::amplitude ? "amplitude" : "density");
  if (s.coherent_gain > 0) report.add("window_coherent_gain", s.coherent_gain);
  report.add("decimation", s.decimation);
}

void add_peak(Report& report, const Spectrogram& s) {
  if (s.cells.empty()) return;
  const auto peak = static_cast<std::size_t>(std::ranges::max_element(s.cells) - s.cells.begin());
  report.add("peak_position_m", s.position_m[peak / s.bins]);
  report.add("peak_frequency_per_m", s.frequency_per_m(peak % s.bins));
}

}  // namespace

Result<Report> describe_spectrogram(const std::string& path) {
  const auto spectrogram = read_spectrogram_nc(path);
  TACTO_TRY(spectrogram);
  if (const auto note = unknown_note(path, spectrogram->newer_version, {}); !note.empty()) cli::warn(note);
  Report report = report_of(FileKind::spectrogram, path, spectrogram->simulated);
  report.add("texture", spectrogram->name)
      .add("quantity", spectrogram->quantity)
      .add("unit", spectrogram->unit);
  // With several strokes the rest of the report describes the first.
  report.add("strokes", spectrogram->strokes);
  add_axes(report, *spectrogram);
  add_windowing(report, *spectrogram);
  add_peak(report, *spectrogram);
  return report;
}

}  // namespace tacto::schema
