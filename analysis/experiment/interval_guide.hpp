// SPDX-License-Identifier: GPL-3.0-or-later
// What a participant sees in an interval: where the finger is to be, and whether it presses as asked.
#pragma once

#include <functional>
#include <optional>

#include "data-schema/experiment/protocol.hpp"
#include "playback/player/player.hpp"

namespace tacto::analysis {

enum class PressedAs { below, within, above };

PressedAs pressed_as(const schema::ForceRange& range, double force_n);

/// What a participant's screen shows while an interval is awaited and played.
struct Guidance {
  double begins_in_s = 0;                 ///< 0: it is played
  std::optional<double> cued_part;        ///< CuedPlace::part; none: the protocol has no cue
  std::optional<PressedAs> pressed = {};  ///< none: the protocol has no range, or the force is unknown
};

/// For IntervalPlay::watch, on the thread of the player. Where a stroke of the cue begins, the session gets
/// the event "cue N", N from 1.
class IntervalGuide {
 public:
  using Show = std::function<void(const Guidance&)>;

  /// Without `show` there is no screen, and so no cue. `protocol` must outlive this.
  /// A normal force is known only if PlayOptions::follow_force asks for it.
  IntervalGuide(const schema::Protocol& protocol, Show show) : protocol_(protocol), show_(std::move(show)) {}

  void operator()(playback::Player& player, double played_s);

  /// Share of the time of the playback in which the normal force was within the protocol's range; none:
  /// unknown.
  std::optional<double> force_within() const;

 private:
  const schema::Protocol& protocol_;
  Show show_;
  int cued_ = 0;  // strokes
  double last_s_ = 0, within_s_ = 0, known_s_ = 0;
};

}  // namespace tacto::analysis
