// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/experiment/interval_play.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "playback/player/play.hpp"
#include "playback/player/player_device.hpp"
#include "playback/prepare/displacement_limit.hpp"
#include "playback/prepare/upload.hpp"

namespace tacto::analysis {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

namespace {

using SteadyClock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

constexpr double kRestS = 0.05, kTurnS = 0.05, kKnotS = 0.005;
constexpr double kLateStartS = 0.005;  // the device's next tick and message come within it
constexpr std::string_view kSimulated = "sim:";

bool is_emulated(const std::string& device_uri) {
  return device_uri.starts_with(kSimulated);
}

// One stroke of a pace: even acceleration in the first kTurnS, even deceleration in the last.
struct PacedStroke {
  double moving_s, whole_s, speed_mps;

  explicit PacedStroke(const schema::ProtocolPace& pace)
      : moving_s(std::max((pace.to_m - pace.from_m) / pace.speed_mps, kTurnS)),
        whole_s(moving_s + kTurnS),
        speed_mps((pace.to_m - pace.from_m) / moving_s) {}

  // The way after `t` seconds of it.
  double way_m(double t) const {
    const double a = speed_mps / kTurnS, left = whole_s - t;
    if (t < kTurnS) return a * t * t / 2;
    if (t < moving_s) return speed_mps * (t - kTurnS / 2);
    return speed_mps * moving_s - a * left * left / 2;
  }
};

playback::PlayOptions options_of(const schema::Protocol& protocol, const IntervalPlay& play) {
  playback::PlayOptions options;
  options.program.file = play.stimulus;
  options.program.at_m = 0;
  options.program.gain = schema::Gain{(play.steer ? 1 : play.ratio) * protocol.gain_m_per_n, false};
  if (play.steer) options.gain = play.ratio;
  options.device_uri = play.device_uri;
  options.session = play.session;
  playback::FingerPath path = paced_path(pace_of(protocol, play));
  options.time_s = play.steer ? kLongestSettingS : path.duration_s();
  options.path_repeated = static_cast<bool>(play.steer);
  options.steer = play.steer;
  options.watch = play.watch;
  options.follow_force = protocol.normal_force.has_value();
  if (is_emulated(play.device_uri)) options.finger_path = std::move(path);
  return options;
}

// From opening the device until it has the texture: what an interval needs before it can begin, but its
// session's file. Errors: of opening the device, of make_program, of check_displacement, of the upload.
Result<double> load_time_s(const Study& study, const std::string& code, const std::string& device_uri) {
  const SteadyClock::time_point begun = SteadyClock::now();
  const auto device = playback::open_player_device(device_uri, {});
  TACTO_TRY(device);
  const auto& transducer = device->device->capabilities().transducer;
  if (!transducer)
    return fail(ErrorKind::unsuitable, "the device does not report its transducer", device_uri,
                "give the device its calibration, or use another one");
  const auto options = options_of(
      study.protocol, {device_uri, study.stimulus(code), {}, false, {}, study.protocol.largest_ratio, {}});
  playback::PrepareOptions prepare;
  prepare.most_samples = device->client->description().welcome.profile_samples;
  const auto program = playback::make_program(options.program, transducer->name, prepare);
  TACTO_TRY(program);
  auto near = playback::check_displacement(program->tray_peak_m, 1, program->prepared.gain_m_per_n,
                                           program->default_gain_m_per_n, program->session.transducer);
  if (!near) near.error().where = schema::protocol_path(study.stem) + "#/gain_m_per_n";
  TACTO_TRY(near);
  if (!device->device->is_real_time()) {
    TACTO_TRY(playback::check_upload(*device->client, program->prepared));
    return 0.0;
  }
  TACTO_TRY(playback::upload(*device->client, program->prepared));
  return Seconds(SteadyClock::now() - begun).count();
}

}  // namespace

playback::FingerPath paced_path(const schema::ProtocolPace& pace) {
  const PacedStroke paced(pace);
  playback::FingerPath path{{0, kRestS}, {pace.from_m, pace.from_m}};
  const int knots = static_cast<int>(std::ceil(paced.whole_s / kKnotS));
  for (int stroke = 0; stroke < pace.strokes; ++stroke)
    for (int i = 1; i <= knots; ++i) {
      const double t = paced.whole_s * i / knots, way = paced.way_m(t);
      path.time_s.push_back(kRestS + stroke * paced.whole_s + t);
      path.position_m.push_back(stroke % 2 == 0 ? pace.from_m + way : pace.to_m - way);
    }
  path.time_s.push_back(path.time_s.back() + kRestS);
  path.position_m.push_back(path.position_m.back());
  return path;
}

CuedPlace cued_place(const schema::ProtocolPace& pace, double played_s) {
  const PacedStroke paced(pace);
  const double pass_s = 2 * kRestS + pace.strokes * paced.whole_s, passes = std::floor(played_s / pass_s);
  const double moved_s = played_s - passes * pass_s - kRestS;
  if (passes < 0) return {};
  const int before = static_cast<int>(passes) * pace.strokes;
  const int stroke = std::clamp(static_cast<int>(std::floor(moved_s / paced.whole_s)), 0, pace.strokes - 1);
  const double way_m = paced.way_m(std::clamp(moved_s - stroke * paced.whole_s, 0.0, paced.whole_s));
  const double part = way_m / (pace.to_m - pace.from_m);
  return {(before + stroke) % 2 == 0 ? part : 1 - part, moved_s < 0 ? before : before + stroke + 1};
}

schema::ProtocolPace pace_of(const schema::Protocol& protocol, const IntervalPlay& play) {
  schema::ProtocolPace pace = protocol.pace;
  if (play.hurried) pace.speed_mps = 2 * protocol.delivered.fastest_mps;
  return pace;
}

Result<std::string> play_interval(const schema::Protocol& protocol, const IntervalPlay& play) {
  const Seconds lead(protocol.lead_s);
  playback::PlayOptions options = options_of(protocol, play);
  options.begins_at = SteadyClock::now() + std::chrono::duration_cast<SteadyClock::duration>(lead);
  const auto outcome = playback::play_once(options, play.stop_asked);
  TACTO_TRY(outcome);
  return outcome->late_s > kLateStartS ? fmt::format("began {:.3f} s late", outcome->late_s) : std::string();
}

Result<bool> reports_normal_force(const std::string& device_uri) {
  const auto device = playback::open_player_device(device_uri, {});
  TACTO_TRY(device);
  return playback::force_channel(*device->client) != nullptr;
}

Result<SlowestLoad> check_on_device(const Study& study, const std::string& device_uri) {
  SlowestLoad slowest;
  for (const schema::CodedStimulus& stimulus : study.key.stimuli) {
    const auto time_s = load_time_s(study, stimulus.code, device_uri);
    TACTO_TRY(time_s);
    if (*time_s > slowest.time_s) slowest = {*time_s, stimulus.code};
  }
  if (slowest.time_s <= study.protocol.lead_s) return slowest;
  return fail(
      ErrorKind::unsuitable,
      fmt::format("intervals are to begin {:g} s after the go-ahead, but stimulus {} is on the device "
                  "only after {:.3f} s",
                  study.protocol.lead_s, slowest.code, slowest.time_s),
      schema::protocol_path(study.stem) + "#/lead_s",
      fmt::format("choose twice as long, {:.1f} s",
                  std::ceil(10 * kUsualLeadOverLoad * slowest.time_s) / 10));
}

}  // namespace tacto::analysis
