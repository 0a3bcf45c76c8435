// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/cli/watched_play.hpp"

#include <algorithm>
#include <array>
#include <chrono>

#include "data-schema/command/stop_signals.hpp"

namespace tacto::playback {
namespace {

using cli::Report;
using schema::ControlFields;
using schema::ControlRequest;
using schema::ControlVerb;
using schema::Result;

constexpr int kBeatMs = 250;
constexpr double kDeadManS = 2;  // eight heartbeats, because a busy computer delays some

Result<ControlFields> asked(ControlConnection& connection, ControlVerb verb) {
  ControlRequest request;
  request.verb = verb;
  return connection.ask(request);
}

Result<void> arm_while_connected(ControlConnection& connection) {
  ControlRequest request;
  request.verb = ControlVerb::arm;
  request.while_connected = true;
  request.dead_man_s = kDeadManS;
  const auto armed = connection.ask(request);
  TACTO_TRY(armed);
  return {};
}

bool goes_on(const ControlFields& status) {
  const std::string state = schema::control_text(status, "state");
  return state == "armed" || state == "playing";
}

Result<Report> report_of_end(ControlConnection& connection) {
  const auto status = asked(connection, ControlVerb::status);
  TACTO_TRY(status);
  constexpr std::array<std::string_view, 9> kTold = {
      "state", "why", "fault", "session", "played_s", "armed_s", "lost_ticks", "late_ticks", "drive_peak_v"};
  Report report;
  for (const auto& [name, value] : *status) {
    if (std::ranges::find(kTold, name) == kTold.end()) continue;
    if (const auto* text = std::get_if<std::string>(&value)) report.add(name, *text);
    if (const auto* number = std::get_if<double>(&value)) report.add(name, *number);
    if (const auto* count = std::get_if<std::int64_t>(&value)) report.add(name, *count);
  }
  const std::string state = schema::control_text(*status, "state");
  if (state == "fault" || state == "lost") report.ends_with(schema::ErrorKind::device);
  return report;
}

// Each request for a status also shows that this client is alive.
Result<void> watch_until_the_end(ControlConnection& connection, std::optional<double> time_s,
                                 const cli::StopSignals& signals,
                                 const std::function<void(const ControlFields&)>& show) {
  const auto begun = std::chrono::steady_clock::now();
  const auto over = [&] {
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begun;
    return time_s && elapsed.count() >= *time_s;
  };
  while (!signals.stop_asked() && !over()) {
    const auto status = asked(connection, ControlVerb::status);
    TACTO_TRY(status);
    show(*status);
    if (!goes_on(*status)) return {};
    // No events come: this only waits, and a signal ends it.
    TACTO_TRY(connection.next_event(kBeatMs));
  }
  TACTO_TRY(asked(connection, ControlVerb::stop));
  const auto disarmed = asked(connection, ControlVerb::disarm);
  return disarmed ? Result<void>() : schema::forward_error(disarmed);
}

}  // namespace

Result<Report> watched_play(ControlConnection& connection, std::optional<double> time_s,
                            const std::function<void(const ControlFields&)>& show) {
  const cli::StopSignals signals;
  TACTO_TRY(arm_while_connected(connection));
  TACTO_TRY(asked(connection, ControlVerb::play));
  TACTO_TRY(watch_until_the_end(connection, time_s, signals, show));
  return report_of_end(connection);
}

}  // namespace tacto::playback
