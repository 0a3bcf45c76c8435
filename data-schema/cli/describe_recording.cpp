// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "data-schema/cli/describe.hpp"
#include "data-schema/recording/recording.hpp"
#include "data-schema/recording/statistics.hpp"
#include "data-schema/report/progress.hpp"

namespace tacto::schema {
namespace {

using cli::Report;

Report channel_row(const Channel& channel, const Statistics& statistics) {
  Report row;
  row.add("name", channel.name).add("quantity", channel.quantity).add("unit", channel.unit);
  row.add("min", statistics.min()).add("max", statistics.max());
  row.add("mean", statistics.mean()).add("rms", statistics.rms());
  row.add("scale", channel.scale).add("offset", channel.offset);
  if (channel.native_rate_hz) row.add("native_rate_hz", *channel.native_rate_hz);
  if (channel.range_min) row.add("range_min", *channel.range_min);
  if (channel.range_max) row.add("range_max", *channel.range_max);
  if (statistics.not_finite() > 0) row.add("not_finite", statistics.not_finite());
  add_text(row, "source", channel.source);
  add_text(row, "derivation", channel.derivation);
  add_text(row, "calibrated", channel.calibrated);
  if (channel.calibration && channel.calibration->scale_uncertainty)
    row.add("scale_uncertainty_percent",
            100 * std::abs(*channel.calibration->scale_uncertainty / channel.scale));
  return row;
}

void add_clocks(Report& report, const RecordingHeader& header) {
  if (header.clock_drift_ppm) report.add("clock_drift_ppm", *header.clock_drift_ppm);
  if (header.clock_drift_uncertainty_ppm)
    report.add("clock_drift_uncertainty_ppm", *header.clock_drift_uncertainty_ppm);
  if (header.clock_offset_s) report.add("clock_offset_s", *header.clock_offset_s);
  if (header.clock_scatter_s) report.add("clock_scatter_s", *header.clock_scatter_s);
}

Report stroke_row(const StrokeFigures& stroke, std::size_t number) {
  Report row;
  row.add("stroke", number).add("direction", stroke.direction).add("length_m", stroke.length_m);
  row.add("mean_speed_mps", stroke.mean_speed_mps);
  row.add("speed_in_band", kTargetSpeed_mps.holds(stroke.mean_speed_mps));
  if (stroke.mean_normal_n)
    row.add("mean_normal_n", *stroke.mean_normal_n)
        .add("load_in_band", kTargetLoad_n.holds(*stroke.mean_normal_n));
  return row.add("clipped_samples", stroke.clipped_samples).add("lost_frames", stroke.lost_frames);
}

void add_time(Report& report, const RecordingHeader& header) {
  std::uint64_t missing = 0;
  for (const Gap& gap : header.gaps) missing += gap.count;
  report.add("sample_rate_hz", header.sample_rate_hz).add("duration_s", duration_s(header));
  report.add("frames", header.frames).add("gaps", header.gaps.size()).add("missing_frames", missing);
  report.add("marks", header.marks.size());
  if (!header.faults.empty()) report.add("faults", header.faults.size());
  add_clocks(report, header);
  add_text(report, "ended", header.ended);
  add_text(report, "clock", header.clock);
}

void add_origin(Report& report, const RecordingHeader& header) {
  add_text(report, "device", header.device);
  add_text(report, "serial", header.serial);
  add_text(report, "firmware", header.firmware);
  if (header.transducer) report.add("transducer", header.transducer->name);
  add_text(report, "source_file", header.source_file);
  add_text(report, "surface", header.surface);
  add_text(report, "finger", header.finger);
  add_text(report, "subject", header.subject);
  if (header.humidity_percent) report.add("humidity_percent", *header.humidity_percent);
  add_text(report, "notes", header.notes);
  add_text(report, "created", header.created);
  add_text(report, "creator", header.creator);
  if (!header.warnings.empty()) report.add("warnings", header.warnings);
}

}  // namespace

void add_strokes(Report& report, const RecordingHeader& header) {
  std::vector<Report> rows;
  for (const StrokeFigures& stroke : header.strokes) rows.push_back(stroke_row(stroke, rows.size() + 1));
  if (!rows.empty()) report.add("strokes", std::move(rows));
}

Result<Report> describe_recording(const std::string& path) {
  const auto recording = open_recording(path);
  TACTO_TRY(recording);
  const RecordingHeader& header = recording->header;
  warn_of_unknown(path, header);
  cli::Progress progress("reading");
  const auto statistics = channel_statistics(wav_path(*recording), header.channels,
                                             [&](double fraction) { progress.update(fraction); });
  TACTO_TRY(statistics);
  Report report = report_of(FileKind::recording, path, header.simulated);
  add_time(report, header);
  add_origin(report, header);
  std::vector<Report> rows;
  for (std::size_t c = 0; c < header.channels.size(); ++c)
    rows.push_back(channel_row(header.channels[c], (*statistics)[c]));
  report.add("channels", std::move(rows));
  add_strokes(report, header);
  return report;
}

}  // namespace tacto::schema
