// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/cli/describe.hpp"
#include "data-schema/report/choices_report.hpp"
#include "data-schema/session/session_reader.hpp"

namespace tacto::schema {
namespace {

const char* words_of(SessionEnding ending) {
  if (ending == SessionEnding::closed) return "closed";
  if (ending == SessionEnding::unclosed)
    return "not closed: it is still being written, or its writer was killed";
  return "damaged: only the part before the damage was read";
}

cli::Report& add_texture(cli::Report& row, const SessionTexture& texture) {
  row.add("texture", texture.file)
      .add("at_m", texture.at_m)
      .add("gain_m_per_n", texture.gain_m_per_n)
      .add("ends", to_string(texture.ends));
  if (texture.ends == TextureEnds::loop) row.add("loop_seam_m", texture.seam_m);
  return row;
}

void add_axes(cli::Report& report, const SessionForces& forces) {
  std::vector<cli::Report> rows;
  for (const DeviceAxis& axis : forces.axes)
    rows.push_back(cli::Report()
                       .add("axis", axis.name)
                       .add("encoder_step_m", axis.encoder_step_m)
                       .add("peak_force_n", axis.peak_force_n)
                       .add("continuous_force_n", axis.continuous_force_n));
  report.add("axes", std::move(rows));
}

void add_device(cli::Report& report, const SessionHeader& header) {
  report.add("device", header.device_uri).add("loop", header.loop).add("rate_hz", header.rate_hz);
  if (!header.forces) report.add("transducer", header.transducer.name);
  report.add("encoder_step_m", header.metres_per_count);
  add_text(report, "scene", header.scene_file);
  if (header.forces) return add_axes(report, *header.forces);
  std::vector<cli::Report> rows;
  for (const SessionTexture& texture : header.textures) {
    cli::Report row;
    rows.push_back(add_texture(row, texture));
  }
  report.add("textures", std::move(rows));
  if (!header.choices.inverse) report.add("inverse", header.inverse);
  cli::add_choices(report, header.choices);
  report.add("delay_s", header.delay_s);
}

void add_measured(cli::Report& report, const SessionHeader& header, const SessionTotals& totals) {
  if (!header.sensor) return;
  report.add("measured", header.sensor->source.empty() ? header.sensor->channel : header.sensor->source)
      .add("measured_rate_hz", header.sensor->rate_hz)
      .add("measured_samples", totals.samples)
      .add("lost_measured_samples", totals.lost_samples);
}

// The tick after which it took effect, because the device may be ahead of the host's knowledge.
void add_changes(cli::Report& report, const std::vector<SessionChange>& changes) {
  if (changes.empty()) return;
  std::vector<cli::Report> rows;
  for (const SessionChange& change : changes)
    for (const SessionTexture& texture : change.program.textures) {
      cli::Report row;
      row.add("tick", change.not_before);
      add_text(row, "scene", change.program.scene_file);
      rows.push_back(add_texture(row, texture));
    }
  report.add("changes", std::move(rows));
}

void add_totals(cli::Report& report, const SessionTotals& totals) {
  report.add("ending", words_of(totals.ending)).add("ticks", totals.ticks);
  report.add("duration_s", 1e-9 * static_cast<double>(totals.last_ns - totals.first_ns));
  report.add("lost_ticks", totals.lost_ticks).add("late_ticks", totals.late_ticks);
  report.add("commands", totals.commands);
  std::vector<cli::Report> rows;
  for (const SessionEvent& event : totals.events)
    rows.push_back(cli::Report().add("tick", event.tick).add("event", event.text));
  if (totals.event_count > totals.events.size())
    report.add("events_left_out", totals.event_count - totals.events.size());
  report.add("events", std::move(rows));
}

}  // namespace

Result<cli::Report> describe_session(const std::string& path) {
  auto reader = SessionReader::open(path);
  TACTO_TRY(reader);
  warn_of_unknown(path, reader->header());
  cli::Report report = report_of(FileKind::session, path, reader->header().simulated);
  report.add("created", reader->header().created).add("creator", reader->header().creator);
  add_device(report, reader->header());
  const SessionTotals totals = session_totals(*reader);
  add_measured(report, reader->header(), totals);
  add_changes(report, totals.changes);
  add_totals(report, totals);
  return report;
}

}  // namespace tacto::schema
