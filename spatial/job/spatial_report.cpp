// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/job/spatial_report.hpp"

#include <cmath>

#include "data-schema/recording/statistics.hpp"
#include "spatial/texture/make_texture.hpp"
#include "spatial/texture/valid_band.hpp"

namespace tacto::spatial {
namespace {

using cli::Report;

std::string rms_key(const schema::Texture& texture) {
  return schema::key_in(texture.unit == "N" ? "force_rms" : "rms", texture.unit);
}

void add_filter(Report& report, const schema::TextureSource& source) {
  report.add("filter", source.filter);
  if (source.high_per_m)
    report.add("low_per_m", source.low_per_m.value_or(0)).add("high_per_m", *source.high_per_m);
  else if (source.filter != "none")
    report.add("low_hz", source.low_hz).add("high_hz", source.high_hz);
  if (source.filter != "none") report.add("edges", source.edges);
  if (source.order != 0) report.add("order", source.order);
  report.add("equalised", source.equalised);
}

void add_texture_values(Report& row, const schema::Texture& texture) {
  row.add(rms_key(texture), rms_of(texture));
  const schema::BandPoint band = band_throughout(texture.valid_band);
  if (band.low_per_m < band.high_per_m)
    row.add("valid_low_per_m", band.low_per_m).add("valid_high_per_m", band.high_per_m);
  else
    row.add("valid_throughout", "no frequency");
  if (const auto& correlation = texture.source.waveform_correlation)
    row.add("waveform_correlation", *correlation);
  row.add("position_moved_m", texture.source.position_moved_m);
}

Report shift_row(const schema::AveragedStroke& stroke) {
  Report row;
  if (!stroke.recording.empty()) row.add("recording", stroke.recording);
  row.add("stroke", stroke.stroke).add("direction", stroke.direction).add("shift_m", stroke.shift_m);
  if (stroke.correlation) row.add("correlation", *stroke.correlation);
  return row;
}

}  // namespace

void add_position(Report& report, const TouchRecord& record) {
  report.add("position_quantum_m", record.facts().quantum_m);
  if (record.facts().noise_m > 0) report.add("position_noise_m", record.facts().noise_m);
  if (const CounterWraps& wraps = record.counter_wraps(); wraps.bits > 0)
    report.add("counter_bits", wraps.bits).add("counter_wraps", wraps.turns.size());
  if (const auto threshold_n = record.finger_up_below_n()) report.add("finger_up_below_n", *threshold_n);
}

Report stroke_row(const TouchRecord& record, const StrokeJob& job) {
  const Stroke& stroke = job.stroke;
  Report row;
  if (job.number > 0) row.add("stroke", job.number);
  row.add("from_s", record.from_s(stroke))
      .add("to_s", record.to_s(stroke))
      .add("direction", stroke.direction);
  row.add("length_m", record.length_m(stroke)).add("mean_speed_mps", record.mean_speed_mps(stroke));
  if (const auto force = record.mean_normal_force_n(stroke))
    row.add("normal_force_n", *force).add("finger", stroke.finger_up ? "up" : "down");
  return row;
}

std::vector<Report> jump_rows(const TouchRecord& record) {
  std::vector<Report> rows;
  for (const PositionJump& jump : record.jumps())
    rows.push_back(Report()
                       .add("sample", jump.frame)
                       .add("at_s", schema::frame_time_s(record.header(), jump.frame))
                       .add("step_m", jump.step_m));
  return rows;
}

Report head_of(const TouchRecord& record, const schema::Texture& texture) {
  Report report;
  report.add("recording", record.where());
  if (texture.source.axes.empty())
    report.add("channel", record.channel().name);
  else
    report.add("reduction", schema::reduction_in_words(texture.source));
  if (!texture.simulated.empty()) report.add("simulated", texture.simulated);
  report.add("grid_m", texture.signal.pitch_m);
  add_position(report, record);
  add_filter(report, texture.source);
  report.add("rms_band", schema::whole_rms_band(texture));
  return report;
}

Report texture_row(const TouchRecord& record, const StrokeJob& job, const schema::Texture& texture) {
  Report row = stroke_row(record, job);
  add_texture_values(row, texture);
  row.add("file", job.stem + ".texture.json");
  return row;
}

Report average_row(const std::string& stem, const schema::Texture& texture) {
  const schema::TextureAverage& average = *texture.average;
  Report row;
  row.add("strokes", average.strokes.size()).add("direction", texture.direction).add("align", average.align);
  row.add("length_m", texture.signal.length_m()).add("mean_speed_mps", texture.source.mean_speed_mps);
  add_texture_values(row, texture);
  row.add(schema::key_in("spread_rms", texture.unit), schema::statistics_of(average.spread).rms());
  row.add("file", stem + ".texture.json");
  std::vector<Report> shifts;
  for (const schema::AveragedStroke& stroke : average.strokes) shifts.push_back(shift_row(stroke));
  row.add("averaged", std::move(shifts));
  return row;
}

}  // namespace tacto::spatial
