// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/session/force_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "firmware-host/core/wire/message_types.hpp"
#include "playback/session/session_rows.hpp"

namespace tacto::playback {

using schema::ErrorKind;
using schema::fail;
using schema::Result;
using schema::SessionTick;

namespace {

void add_tick(ForceSession& session, const SessionTick& tick, const std::vector<schema::DeviceAxis>& axes) {
  for (std::size_t i = 0; i < session.axes.size() && i < tick.axes; ++i) {
    ForceSessionAxis& axis = session.axes[i];
    const double place_m = tick.counts[i] * axes[i].encoder_step_m, force_n = double{tick.force_n[i]};
    axis.from_m = session.ticks == 0 ? place_m : std::min(axis.from_m, place_m);
    axis.to_m = session.ticks == 0 ? place_m : std::max(axis.to_m, place_m);
    axis.force_rms_n += force_n * force_n;
    axis.force_peak_n = std::max(axis.force_peak_n, std::abs(force_n));
  }
  session.limits.add(tick.flags);
  ++session.ticks;
}

}  // namespace

Result<ForceSession> read_force_session(const std::string& name, const ForceTickSink& sink) {
  auto reader = schema::SessionReader::open(name);
  TACTO_TRY(reader);
  const std::vector<schema::DeviceAxis>& axes = reader->header().forces->axes;
  ForceSession session;
  for (const schema::DeviceAxis& axis : axes) session.axes.push_back({axis.name, 0, 0, 0, 0});
  std::int64_t first_ns = 0;
  while (const auto block = reader->next()) {
    if (const auto* loss = std::get_if<schema::SessionLoss>(&*block)) session.lost += loss->count;
    const auto* ticks = std::get_if<std::vector<SessionTick>>(&*block);
    if (ticks == nullptr) continue;
    if (session.ticks == 0) first_ns = ticks->front().time_ns;
    for (const SessionTick& tick : *ticks) {
      add_tick(session, tick, axes);
      if (sink) sink(tick, 1e-9 * static_cast<double>(tick.time_ns - first_ns));
    }
  }
  session.damaged = reader->ending() == schema::SessionEnding::damaged;
  const auto damaged_at = session.damaged ? std::optional(reader->sound_bytes()) : std::nullopt;
  if (session.ticks == 0) return tl::unexpected(no_ticks_in(reader->path(), damaged_at));
  for (ForceSessionAxis& axis : session.axes)
    axis.force_rms_n = std::sqrt(axis.force_rms_n / static_cast<double>(session.ticks));
  return session;
}

Result<void> export_force_session(const std::string& name, const std::string& file,
                                  schema::Existing existing) {
  auto reader = schema::SessionReader::open(name);
  TACTO_TRY(reader);
  const std::vector<schema::DeviceAxis> axes = reader->header().forces->axes;
  schema::PendingFiles files;
  const auto temporary = files.add(file);
  TACTO_TRY(temporary);
  std::ofstream out(*temporary, std::ios::binary);
  out << "tick,time_s";
  for (const schema::DeviceAxis& axis : axes) out << ',' << axis.name << "_m";
  for (const schema::DeviceAxis& axis : axes) out << ",force_" << axis.name << "_n";
  out << ",playing,fault,late,limited,rms_limited\n";
  const auto write = [&](const SessionTick& tick, double time_s) {
    out << fmt::format("{},{:.9f}", tick.tick, time_s);
    for (std::size_t i = 0; i < axes.size(); ++i)
      out << fmt::format(",{}", tick.counts[i] * axes[i].encoder_step_m);
    for (std::size_t i = 0; i < axes.size(); ++i) out << fmt::format(",{}", tick.force_n[i]);
    for (const std::uint32_t flags :
         {std::uint32_t{wire::kTickPlaying}, std::uint32_t{wire::kTickFault}, std::uint32_t{wire::kTickLate},
          wire::kTickAmplitudeLimited | wire::kTickSlewLimited, std::uint32_t{wire::kTickEnergyLimited}})
      out << ((tick.flags & flags) != 0 ? ",1" : ",0");
    out << '\n';
  };
  TACTO_TRY(read_force_session(name, write));
  out.flush();
  if (!out) return fail(ErrorKind::cannot_write, "can't be written", file, "is the disk full?");
  return files.commit(existing);
}

}  // namespace tacto::playback
