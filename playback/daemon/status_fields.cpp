// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/daemon/status_fields.hpp"

namespace tacto::playback {

using schema::ControlFields;

void add_ticks(ControlFields& fields, const TickView& view, std::uint64_t not_recorded) {
  const auto count = [](std::uint64_t n) { return static_cast<std::int64_t>(n); };
  fields.emplace_back("ticks", count(view.ticks()));
  fields.emplace_back("lost_ticks", count(view.lost() + not_recorded));
  fields.emplace_back("late_ticks", count(view.late()));
  fields.emplace_back("limited_ticks", count(view.limited()));
  fields.emplace_back("energy_limited_ticks", count(view.energy_limited()));
  fields.emplace_back("gated_ticks", count(view.gated()));
  fields.emplace_back("blind_ticks", count(view.blind()));
  fields.emplace_back("played_s", view.playing_s());
  fields.emplace_back("armed_s", view.span_s());
  fields.emplace_back("device_s", 1e-9 * static_cast<double>(view.last().time_ns));
  fields.emplace_back("encoder_count", std::int64_t{view.last().encoder});
  fields.emplace_back("position_m", view.position_m());
  fields.emplace_back("speed_mps", view.speed_mps());
  fields.emplace_back("drive_v", double{view.last().drive_v});
  fields.emplace_back("drive_rms_v", view.drive_rms_v());
  fields.emplace_back("drive_peak_v", view.drive_peak_v());
}

void add_forces(ControlFields& fields, const TickView& view, const schema::SessionForces& forces) {
  for (std::size_t i = 0; i < forces.axes.size(); ++i) {
    const schema::DeviceAxis& axis = forces.axes[i];
    fields.emplace_back(axis.name + "_m", view.last().counts[i] * axis.encoder_step_m);
    fields.emplace_back("force_" + axis.name + "_n", double{view.last().force_n[i]});
  }
  fields.emplace_back("force_peak_n", view.force_peak_n());
}

void add_limits(ControlFields& fields, const PlayerStatus& status) {
  if (status.ticks.limited() + status.ticks.energy_limited() == 0) return;
  const LimitsTook& took = status.limits;
  if (took.db) fields.emplace_back("limits_took_db", *took.db);
  if (took.last_second_db) fields.emplace_back("limits_took_last_second_db", *took.last_second_db);
  if (!took.unknown.empty()) fields.emplace_back("limits_took", "unknown: " + took.unknown);
  if (!status.session.empty()) fields.emplace_back("limits_in_db", "tactograph session " + status.session);
}

void add_stay(ControlFields& fields, const StayRules& rules) {
  if (rules.client) fields.emplace_back("while_connected", true);
  if (rules.dead_man_s) fields.emplace_back("dead_man_s", *rules.dead_man_s);
}

void add_recorder(ControlFields& fields, const RecorderCounts& counts) {
  fields.emplace_back("recorded_ticks", static_cast<std::int64_t>(counts.ticks));
  fields.emplace_back("recorder_lost_ticks", static_cast<std::int64_t>(counts.lost()));
  if (!counts.failure.empty()) fields.emplace_back("recorder_failure", counts.failure);
}

void add_loop(ControlFields& fields, const HostLoopStatus& loop) {
  fields.emplace_back("wake_p50_s", loop.wake_p50_s);
  fields.emplace_back("wake_p99_s", loop.wake_p99_s);
  fields.emplace_back("wake_p999_s", loop.wake_p999_s);
  fields.emplace_back("busy_p99_s", loop.busy_p99_s);
  for (std::size_t i = 0; i < kLateBoundsS.size(); ++i)
    fields.emplace_back(late_part_name(kLateBoundsS[i]), loop.late_parts[i]);
  fields.emplace_back("looked_ahead_s", loop.looked_ahead_s);
  fields.emplace_back("latency_p50_s", loop.latency.p50_s);
  fields.emplace_back("latency_p99_s", loop.latency.p99_s);
  fields.emplace_back("missed_ticks", static_cast<std::int64_t>(loop.missed_ticks));
  fields.emplace_back("stale_drives", static_cast<std::int64_t>(loop.stale_drives));
  fields.emplace_back("trimmed_drives", static_cast<std::int64_t>(loop.trimmed_drives));
  fields.emplace_back("real_time", loop.real_time);
  if (!loop.device_fault.empty()) fields.emplace_back("device_fault", loop.device_fault);
}

}  // namespace tacto::playback
