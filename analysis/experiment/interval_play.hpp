// SPDX-License-Identifier: GPL-3.0-or-later
// Plays one interval of a trial, as the verb `play` does.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "analysis/experiment/study.hpp"
#include "playback/model/finger_path.hpp"
#include "playback/player/player.hpp"

namespace tacto::analysis {

/// The finger's path at the protocol's pace, with 50 ms of rest before and after, and even
/// acceleration over 50 ms at both ends of each stroke.
playback::FingerPath paced_path(const schema::ProtocolPace& pace);

/// Where the finger is to be.
struct CuedPlace {
  double part = 0;  ///< of the way from pace.from_m to pace.to_m
  int stroke = 0;   ///< the last one that has begun, from 1; 0: none
};

/// At `played_s` of an interval whose finger moves along paced_path(); after its end it repeats that path,
/// without end, forth and back. Before 0: at the beginning.
CuedPlace cued_place(const schema::ProtocolPace& pace, double played_s);

struct IntervalPlay {
  std::string device_uri;
  std::string stimulus;  ///< stem of the texture
  std::string session;   ///< to be written
  bool hurried = false;  ///< an emulated finger moves at twice the fastest speed that is accepted
  std::function<bool()> stop_asked;
  double ratio = 1;  ///< gain over that of the protocol
  /// Of an interval in which the gain is changed, from `ratio` on: PlayOptions::steer. The interval then
  /// lasts until this ends it, or kLongestSettingS; an emulated finger repeats the pace.
  std::function<schema::Result<bool>(playback::Player&, double)> steer = {};
  std::function<void(playback::Player&, double)> watch = {};  ///< PlayOptions::watch
};

inline constexpr double kLongestSettingS = 600;

/// The pace of the interval's finger.
schema::ProtocolPace pace_of(const schema::Protocol& protocol, const IntervalPlay& play);

/// Begins `lead_s` after this call on a device that keeps time, when the texture is on the device, and lasts
/// as long as the pace. An emulated finger follows the pace. Returns words if it could begin only later, else
/// nothing. Errors: those of playback::play_once.
schema::Result<std::string> play_interval(const schema::Protocol& protocol, const IntervalPlay& play);

/// The lead over the slowest load that leaves a reserve: a load varies, and each is measured once.
inline constexpr double kUsualLeadOverLoad = 2;

/// The stimulus that needs the longest time until the device has it. 0 on a device that does not keep time:
/// there no interval waits for a clock.
struct SlowestLoad {
  double time_s = 0;
  std::string code;

  bool keeps_time() const { return !code.empty(); }  ///< of the device
};

/// Errors: of opening the device.
schema::Result<bool> reports_normal_force(const std::string& device_uri);

/// Whether the device can play every stimulus, at the largest gain, each of them loaded once, as an interval
/// loads it. Errors: those of opening the device, of make_program, of the upload; unsuitable: a stimulus
/// exceeds the transducer's displacement limit, the lead is shorter than the slowest load.
schema::Result<SlowestLoad> check_on_device(const Study& study, const std::string& device_uri);

}  // namespace tacto::analysis
