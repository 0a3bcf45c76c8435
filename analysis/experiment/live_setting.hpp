// SPDX-License-Identifier: GPL-3.0-or-later
// One setting of an adjustment: the gain of a playback is changed step by step until it is accepted.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "data-schema/experiment/protocol.hpp"
#include "playback/player/player.hpp"

namespace tacto::analysis {

/// What the one who adjusts is asked with.
struct SettingNow {
  double ratio = 0;  ///< of the gain, to that of the protocol
  /// RMS of the predicted displacement of the last stroke over that of the texture at the ratio 1; 0: not
  /// computed, or unknown because ticks are missing.
  double presented_ratio = 0;
};

/// When it is asked: at any time, by keys; or whenever the finger has moved along the whole pace, a person
/// then waits in emulated time, and an observer also gets presented_ratio.
enum class AskedAt { any_time, pass, pass_with_ratio };

/// For PlayOptions::steer. Each setting is a gain command and a mark in the session, "setting 0.25"; after
/// "end" nothing is adjusted. What is accepted is the last gain of the session.
class LiveSetting {
 public:
  /// None: nothing yet.
  using Ask = std::function<schema::Result<std::optional<schema::Turn>>(const SettingNow& now)>;

  LiveSetting(const schema::Protocol& protocol, std::string session, double pass_s, double start_ratio,
              AskedAt asked_at, Ask ask)
      : protocol_(protocol),
        session_(std::move(session)),
        pass_s_(pass_s),
        ratio_(start_ratio),
        asked_at_(asked_at),
        ask_(std::move(ask)) {}

  /// False: accepted. Errors: of `ask`, of the player.
  schema::Result<bool> operator()(playback::Player& player, double played_s);

  bool accepted() const { return accepted_; }

 private:
  schema::Result<SettingNow> now(const playback::Player& player);
  schema::Result<void> mark(playback::Player& player) const;

  const schema::Protocol& protocol_;
  std::string session_;
  double pass_s_, ratio_;
  AskedAt asked_at_;
  Ask ask_;
  std::uint64_t passes_ = 0;  // that were completed
  double unit_rms_m_ = 0;     // of the texture at the ratio 1, along a stroke
  bool accepted_ = false, begun_ = false;
};

/// Whether a step leads out of the protocol's range: what is accepted here is a bound.
bool is_lowest(const schema::Protocol& protocol, double ratio);
bool is_highest(const schema::Protocol& protocol, double ratio);

/// The ratio after a step; the same, if that would leave the range of the protocol.
double stepped(const schema::Protocol& protocol, double ratio, schema::Turn turn);

/// The step towards `wanted`; accept: the next setting is not nearer to it in dB, by what `measured` is of
/// it now.
schema::Turn turn_towards(const schema::Protocol& protocol, double ratio, double measured, double wanted);

}  // namespace tacto::analysis
