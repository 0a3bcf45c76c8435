// SPDX-License-Identifier: GPL-3.0-or-later
// The samples of a session's tray sensor, read beside its ticks.
#pragma once

#include <deque>
#include <optional>

#include "playback/session/session_rows.hpp"

namespace tacto::playback {

/// One sample: the sensor's frame, when it was by the clock of the ticks, and the displacement.
struct SensorFrame {
  std::uint64_t number = 0;
  double time_s = 0, displacement_m = 0;
};

/// Reads the file a second time, as far as it is asked for; memory is that of the frames that are kept.
class SensorSamples {
 public:
  /// Holds nothing where the header names no sensor. The overview stays where it is.
  explicit SensorSamples(const SessionOverview& overview);

  /// Up to the first frame behind a time (SessionRow::device_time_s), or the end.
  void read_to(double time_s);
  /// All before the last frame that is before a time: that one stays, so that a hole behind it is seen.
  void forget_before(double time_s);
  const std::deque<SensorFrame>& frames() const { return frames_; }
  /// Whether numbers and times grew so far; frames that do not are left out.
  bool sound() const { return sound_; }

  /// The displacement at the frame nearest to a time, within half a period. Times do not fall from call to
  /// call.
  std::optional<double> at(double time_s);

 private:
  void take(const schema::SessionSamples& samples);

  const SessionOverview& overview_;
  std::optional<schema::SessionReader> reader_;  // none: at its end
  std::deque<SensorFrame> frames_;
  bool sound_ = true;
};

}  // namespace tacto::playback
