// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "data-schema/cli/describe.hpp"
#include "data-schema/recording/statistics.hpp"
#include "data-schema/texture/texture.hpp"

namespace tacto::schema {
namespace {

using cli::Report;

void add_values(Report& report, const Texture& texture) {
  const Statistics statistics = statistics_of(texture.signal.values);
  report.add("quantity", texture.quantity).add("unit", texture.unit);
  report.add(key_in("min", texture.unit), statistics.min())
      .add(key_in("max", texture.unit), statistics.max());
  report.add(key_in("mean", texture.unit), statistics.mean())
      .add(key_in("rms", texture.unit), statistics.rms());
  report.add("rms_band", whole_rms_band(texture));
}

void add_grid(Report& report, const Texture& texture) {
  report.add("pitch_m", texture.signal.pitch_m).add("length_m", texture.signal.length_m());
  report.add("samples", texture.signal.values.size()).add("direction", texture.direction);
  report.add("source_origin_m", texture.source_origin_m);
}

// The band that is valid at every position, and the one that is valid somewhere.
void add_band(Report& report, const std::vector<BandPoint>& band) {
  if (band.empty()) return;
  const auto low = std::ranges::minmax_element(band, {}, &BandPoint::low_per_m);
  const auto high = std::ranges::minmax_element(band, {}, &BandPoint::high_per_m);
  if (low.max->low_per_m < high.min->high_per_m)
    report.add("band_low_per_m", low.max->low_per_m).add("band_high_per_m", high.min->high_per_m);
  else
    report.add("band_throughout", "no frequency");
  report.add("widest_band_low_per_m", low.min->low_per_m).add("widest_band_high_per_m", high.max->high_per_m);
}

void add_source(Report& report, const TextureSource& source) {
  if (source.recording.empty()) return;
  report.add("recording", source.recording);
  if (source.stroke != 0) report.add("stroke", source.stroke);
  report.add("from_s", source.from_s).add("to_s", source.to_s);
  report.add("mean_speed_mps", source.mean_speed_mps);
  report.add("min_speed_mps", source.min_speed_mps).add("max_speed_mps", source.max_speed_mps);
  add_text(report, "reduction", reduction_in_words(source));
  if (source.waveform_correlation) report.add("waveform_correlation", *source.waveform_correlation);
  add_text(report, "method", source.method);
  add_text(report, "filter", source.filter);
  if (source.order != 0) report.add("order", source.order);
  add_text(report, "edges", source.edges);
  if (source.high_per_m)
    report.add("low_per_m", source.low_per_m.value_or(0)).add("high_per_m", *source.high_per_m);
  else if (source.high_hz > 0)
    report.add("low_hz", source.low_hz).add("high_hz", source.high_hz);
  if (source.interpolated_frames > 0) report.add("interpolated_frames", source.interpolated_frames);
  report.add("equalised", source.equalised).add("position_moved_m", source.position_moved_m);
}

void add_position(Report& report, const TextureSource& source) {
  if (source.recording.empty()) return;
  report.add("position_quantum_m", source.position_quantum_m);
  if (source.position_noise_m > 0) report.add("position_noise_m", source.position_noise_m);
  if (source.counter_bits > 0)
    report.add("counter_bits", source.counter_bits).add("counter_wraps", source.counter_wraps);
  if (source.normal_force_n)
    report.add("normal_force_n", *source.normal_force_n).add("finger", source.finger_up ? "up" : "down");
}

void add_average(Report& report, const Texture& texture) {
  if (!texture.average) return;
  const TextureAverage& average = *texture.average;
  report.add("averaged_strokes", average.strokes.size()).add("aligned_by", average.align);
  report.add(key_in("spread_rms", texture.unit), statistics_of(average.spread).rms());
  const auto [least, most] = std::ranges::minmax(average.counts, {}, &StrokeCount::strokes);
  report.add("fewest_strokes", least.strokes).add("most_strokes", most.strokes);
}

void add_certificate(Report& report, const std::optional<Certificate>& certificate) {
  if (!certificate) return;
  const auto count = [&](PeakVerdict verdict) {
    return std::ranges::count(certificate->peaks, verdict, &CertifiedPeak::verdict);
  };
  report.add("certified_textures", certificate->textures.size());
  report.add("certified_speed_ratio", certificate->speed_ratio);
  report.add("spatial_peaks", count(PeakVerdict::spatial));
  report.add("temporal_peaks", count(PeakVerdict::temporal));
  report.add("undecided_peaks", count(PeakVerdict::undecided));
}

Report step_row(const TransformStep& step) {
  Report row;
  row.add("operation", operation_name(step.operation));
  if (step.keep_slope) row.add("keep_slope", *step.keep_slope);
  if (step.lengthening) row.add("lengthening", lengthening_name(*step.lengthening));
  if (step.joints) row.add("joints", *step.joints);
  for (const auto& [key, member] : kTransformNumbers)
    if (step.*member) row.add(key, *(step.*member));
  return row;
}

}  // namespace

void add_transform(Report& report, const TextureTransform& transform) {
  const bool mixed = !transform.steps.empty() && !transform.steps.front().weights.empty();
  std::vector<Report> sources, steps;
  for (std::size_t i = 0; i < transform.sources.size(); ++i) {
    const auto& [texture, sha256] = transform.sources[i];
    sources.push_back(Report().add("texture", texture).add("wav_sha256", sha256));
    if (mixed && i < transform.steps.front().weights.size())
      sources.back().add("weight", transform.steps.front().weights[i]);
  }
  for (const TransformStep& step : transform.steps) steps.push_back(step_row(step));
  report.add("made_from", std::move(sources)).add("steps", std::move(steps));
}

Result<Report> describe_texture(const std::string& path) {
  const auto texture = read_texture(path);
  TACTO_TRY(texture);
  warn_of_unknown(path, *texture);
  Report report = report_of(FileKind::texture, path, texture->simulated);
  add_grid(report, *texture);
  add_values(report, *texture);
  add_band(report, texture->valid_band);
  add_source(report, texture->source);
  add_position(report, texture->source);
  if (texture->transform) add_transform(report, *texture->transform);
  add_average(report, *texture);
  add_certificate(report, texture->certificate);
  if (texture->playback_gain) {
    report.add("playback_gain_m_per_n", texture->playback_gain->gain_m_per_n);
    add_text(report, "gain_set_by", texture->playback_gain->who);
    add_text(report, "gain_set_on", texture->playback_gain->when);
  }
  add_text(report, "surface", texture->surface);
  add_text(report, "finger", texture->finger);
  add_text(report, "subject", texture->subject);
  add_text(report, "notes", texture->notes);
  add_text(report, "created", texture->created);
  add_text(report, "creator", texture->creator);
  return report;
}

}  // namespace tacto::schema
