// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/session/force_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <utility>

#include "firmware-host/core/scene/scene_kernel.hpp"
#include "firmware-host/core/wire/message_types.hpp"
#include "playback/session/session_replay.hpp"
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

std::vector<std::uint32_t> sliding_layers(const core::SceneView& scene) {
  std::vector<std::uint32_t> layers;
  for (std::uint32_t i = 0; i < scene.layer_count && scene.in_space; ++i)
    if (core::table_of<core::PieceTable>(scene, scene.layers[i]).slide != 0) layers.push_back(i);
  return layers;
}

// Of the pieces that slide, one after the other, tick by tick; and why there are no more.
std::pair<std::vector<float>, std::string> slides_of(const std::string& name, std::size_t slides) {
  std::vector<float> places_m;
  if (slides == 0) return {};
  std::vector<std::uint32_t> layers;
  const auto replayed = replay_session(name, {}, {}, [&](const core::SceneKernel& kernel) {
    if (places_m.empty()) layers = sliding_layers(kernel.scene());
    if (layers.size() != slides) return;
    for (const std::uint32_t layer : layers) places_m.push_back(kernel.slid_m(layer));
  });
  if (!replayed) return {places_m, schema::message(replayed.error())};
  if (replayed->same()) return {places_m, ""};
  return {places_m, fmt::format("from tick {} on the places of pieces that slide can't be computed again",
                                places_m.size() / slides)};
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

Result<std::string> export_force_session(const std::string& name, const std::string& file,
                                         schema::Existing existing) {
  auto reader = schema::SessionReader::open(name);
  TACTO_TRY(reader);
  const std::vector<schema::DeviceAxis> axes = reader->header().forces->axes;
  const std::vector<std::string> slides = reader->header().forces->slides;
  const auto computed = slides_of(name, slides.size());
  const std::vector<float>& slid_m = computed.first;
  std::size_t slid = 0;
  schema::PendingFiles files;
  const auto temporary = files.add(file);
  TACTO_TRY(temporary);
  std::ofstream out(*temporary, std::ios::binary);
  out << "tick,time_s";
  for (const schema::DeviceAxis& axis : axes) out << ',' << axis.name << "_m";
  for (const schema::DeviceAxis& axis : axes) out << ",force_" << axis.name << "_n";
  out << ",playing,fault,late,limited,rms_limited";
  for (const std::string& piece : slides) out << ",slide_" << piece << "_m";
  out << '\n';
  const auto write = [&](const SessionTick& tick, double time_s) {
    out << fmt::format("{},{:.9f}", tick.tick, time_s);
    for (std::size_t i = 0; i < axes.size(); ++i)
      out << fmt::format(",{}", tick.counts[i] * axes[i].encoder_step_m);
    for (std::size_t i = 0; i < axes.size(); ++i) out << fmt::format(",{}", tick.force_n[i]);
    for (const std::uint32_t flags :
         {std::uint32_t{wire::kTickPlaying}, std::uint32_t{wire::kTickFault}, std::uint32_t{wire::kTickLate},
          wire::kTickAmplitudeLimited | wire::kTickSlewLimited, std::uint32_t{wire::kTickEnergyLimited}})
      out << ((tick.flags & flags) != 0 ? ",1" : ",0");
    for (std::size_t i = 0; i < slides.size(); ++i)
      out << (slid < slid_m.size() ? fmt::format(",{}", slid_m[slid++]) : ",");
    out << '\n';
  };
  TACTO_TRY(read_force_session(name, write));
  out.flush();
  if (!out) return fail(ErrorKind::cannot_write, "can't be written", file, "is the disk full?");
  TACTO_TRY(files.commit(existing));
  return computed.second;
}

}  // namespace tacto::playback
