// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/experiment/interval_play.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include "playback/player/play.hpp"
#include "playback/player/player_device.hpp"

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

// The way after `t` seconds of a stroke that lasts `moving_s` + kTurnS: even acceleration in the first
// kTurnS, even deceleration in the last.
double stroke_way_m(double t, double speed_mps, double moving_s) {
  const double a = speed_mps / kTurnS;
  if (t < kTurnS) return a * t * t / 2;
  if (t < moving_s) return speed_mps * (t - kTurnS / 2);
  const double left = moving_s + kTurnS - t;
  return speed_mps * moving_s - a * left * left / 2;
}

playback::PlayOptions options_of(const schema::Protocol& protocol, const IntervalPlay& play) {
  playback::PlayOptions options;
  options.program.file = play.stimulus;
  options.program.at_m = 0;
  options.program.gain = schema::Gain{protocol.gain_m_per_n, false};
  options.device_uri = play.device_uri;
  options.session = play.session;
  schema::ProtocolPace pace = protocol.pace;
  if (play.hurried) pace.speed_mps *= 2;
  playback::FingerPath path = paced_path(pace);
  options.time_s = path.duration_s();
  if (is_emulated(play.device_uri)) options.finger_path = std::move(path);
  return options;
}

// Waits for a time of the clock; whether that was still ahead.
bool wait_until(SteadyClock::time_point when, const std::function<bool()>& stop_asked) {
  const bool ahead =
      SteadyClock::now() <= when + std::chrono::duration_cast<SteadyClock::duration>(Seconds(kLateStartS));
  while (SteadyClock::now() < when && !stop_asked())
    std::this_thread::sleep_until(std::min(when, SteadyClock::now() + std::chrono::milliseconds(10)));
  return ahead;
}

}  // namespace

playback::FingerPath paced_path(const schema::ProtocolPace& pace) {
  const double stroke_m = pace.to_m - pace.from_m;
  const double moving_s = std::max(stroke_m / pace.speed_mps, kTurnS), whole_s = moving_s + kTurnS;
  const double speed_mps = stroke_m / moving_s;
  playback::FingerPath path{{0, kRestS}, {pace.from_m, pace.from_m}};
  const int knots = static_cast<int>(std::ceil(whole_s / kKnotS));
  for (int stroke = 0; stroke < pace.strokes; ++stroke)
    for (int i = 1; i <= knots; ++i) {
      const double t = whole_s * i / knots, way = stroke_way_m(t, speed_mps, moving_s);
      path.time_s.push_back(kRestS + stroke * whole_s + t);
      path.position_m.push_back(stroke % 2 == 0 ? pace.from_m + way : pace.to_m - way);
    }
  path.time_s.push_back(path.time_s.back() + kRestS);
  path.position_m.push_back(path.position_m.back());
  return path;
}

Result<std::string> play_interval(const schema::Protocol& protocol, const IntervalPlay& play) {
  const SteadyClock::time_point asked = SteadyClock::now();
  std::string late;
  playback::PlayOptions options = options_of(protocol, play);
  options.ready = [&](bool real_time) {
    const auto begin = asked + std::chrono::duration_cast<SteadyClock::duration>(Seconds(protocol.lead_s));
    if (!real_time || wait_until(begin, play.stop_asked)) return;
    late = fmt::format("began {:.3f} s late", Seconds(SteadyClock::now() - begin).count());
  };
  const auto outcome = playback::play_once(options, play.stop_asked);
  TACTO_TRY(outcome);
  return late;
}

Result<void> check_on_device(const Study& study, const std::string& device_uri) {
  const auto device = playback::open_player_device(device_uri, {});
  TACTO_TRY(device);
  const auto& transducer = device->device->capabilities().transducer;
  if (!transducer)
    return fail(ErrorKind::unsuitable, "the device does not report its transducer", device_uri,
                "give the device its calibration, or use another one");
  for (const schema::CodedStimulus& stimulus : study.key.stimuli) {
    const auto options =
        options_of(study.protocol, {device_uri, study.stimulus(stimulus.code), {}, false, {}});
    playback::PrepareOptions prepare;
    prepare.most_samples = device->client->description().welcome.profile_samples;
    TACTO_TRY(playback::make_program(options.program, transducer->name, prepare));
  }
  return {};
}

}  // namespace tacto::analysis
