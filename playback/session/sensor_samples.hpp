// SPDX-License-Identifier: GPL-3.0-or-later
// The samples of the tray's sensor in a session, read in parallel to its ticks.
#pragma once

#include <deque>
#include <optional>

#include "playback/session/session_rows.hpp"

namespace tacto::playback {

/// One sample: the sensor's frame number, its time on the clock of the ticks, and the displacement.
struct SensorFrame {
  std::uint64_t number = 0;
  double time_s = 0, displacement_m = 0;
};

/// Reads the file a second time, up to the requested time; only the frames that are still needed are in
/// memory.
class SensorSamples {
 public:
  /// Empty if the header names no sensor. The overview must outlive this.
  explicit SensorSamples(const SessionOverview& overview);

  /// Reads up to the first frame after a time (SessionRow::device_time_s), or to the end.
  void read_to(double time_s);
  /// Removes all frames before the last one that is before a time. That one is kept, to detect missing frames
  /// after it.
  void forget_before(double time_s);
  const std::deque<SensorFrame>& frames() const { return frames_; }
  /// Whether all numbers and times increased so far; frames that do not increase are skipped.
  bool sound() const { return sound_; }

  /// The displacement at the frame nearest to a time, within half a period. Times must not decrease from call
  /// to call.
  std::optional<double> at(double time_s);

 private:
  void take(const schema::SessionSamples& samples);

  const SessionOverview& overview_;
  std::optional<schema::SessionReader> reader_;  // none at the end of the file
  std::deque<SensorFrame> frames_;
  bool sound_ = true;
};

}  // namespace tacto::playback
