// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/experiment/live_setting.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <thread>

#include "analysis/experiment/interval_facts.hpp"
#include "data-schema/base/decibels.hpp"
#include "playback/strokes/stroke_report.hpp"

namespace tacto::analysis {

using schema::ErrorKind;
using schema::Result;
using schema::Turn;

namespace {

constexpr auto kDiskWait = std::chrono::milliseconds(1);
constexpr int kMostDiskWaits = 5000;

// The recorder's thread writes the ticks; the session can be read when it has them all.
Result<void> wait_for_disk(const playback::Player& player) {
  const std::uint64_t ticks = player.status().ticks.ticks();
  for (int i = 0; i < kMostDiskWaits; ++i) {
    const auto recorded = player.recorded();
    if (!recorded || recorded->ticks + recorded->lost() >= ticks) return {};
    std::this_thread::sleep_for(kDiskWait);
  }
  return schema::fail(ErrorKind::cannot_write, "the session is not on the disk after 5 s", {},
                      "the disk is too slow");
}

}  // namespace

double stepped(const schema::Protocol& protocol, double ratio, Turn turn) {
  if (turn == Turn::accept) return ratio;
  const double factor = schema::amplitude_of_db(protocol.step_db);
  const double next = turn == Turn::stronger ? ratio * factor : ratio / factor;
  return protocol.smallest_ratio <= next && next <= protocol.largest_ratio ? next : ratio;
}

bool is_lowest(const schema::Protocol& protocol, double ratio) {
  return stepped(protocol, ratio, Turn::weaker) == ratio;
}

bool is_highest(const schema::Protocol& protocol, double ratio) {
  return stepped(protocol, ratio, Turn::stronger) == ratio;
}

Turn turn_towards(const schema::Protocol& protocol, double ratio, double measured, double wanted) {
  const double left_db = schema::amplitude_db(wanted / measured);
  if (std::abs(left_db) <= protocol.step_db / 2) return Turn::accept;
  const Turn turn = left_db > 0 ? Turn::stronger : Turn::weaker;
  return stepped(protocol, ratio, turn) == ratio ? Turn::accept : turn;
}

Result<void> LiveSetting::mark(playback::Player& player) const {
  const auto marked = player.mark(fmt::format("setting {:.9g}", ratio_));
  TACTO_TRY(marked);
  return {};
}

Result<SettingNow> LiveSetting::now(const playback::Player& player) {
  SettingNow now{ratio_, 0};
  if (asked_at_ != AskedAt::pass_with_ratio) return now;
  TACTO_TRY(wait_for_disk(player));
  if (unit_rms_m_ == 0) {
    const auto report = playback::report_strokes(session_);
    if (!report || report->strokes.empty() || report->strokes.front().target_rms_m == 0) return now;
    unit_rms_m_ = report->strokes.front().target_rms_m / ratio_;
  }
  const auto rms_m = predicted_rms_m(session_, passes_ * static_cast<std::uint64_t>(protocol_.pace.strokes));
  if (rms_m) now.presented_ratio = *rms_m / unit_rms_m_;
  return now;
}

Result<bool> LiveSetting::operator()(playback::Player& player, double played_s) {
  if (!begun_) {
    TACTO_TRY(mark(player));
    begun_ = true;
  }
  const bool passed = played_s >= static_cast<double>(passes_ + 1) * pass_s_;
  if (passed) ++passes_;
  if (!passed && asked_at_ != AskedAt::any_time) return true;
  const auto asked = now(player);
  TACTO_TRY(asked);
  const auto turn = ask_(*asked);
  TACTO_TRY(turn);
  if (!*turn) return true;
  if (**turn == Turn::accept) {
    accepted_ = true;
    const auto marked = player.mark("end");
    TACTO_TRY(marked);
    return false;
  }
  const double next = stepped(protocol_, ratio_, **turn);
  if (next == ratio_) return true;
  ratio_ = next;
  TACTO_TRY(player.gain(ratio_));
  TACTO_TRY(mark(player));
  return true;
}

}  // namespace tacto::analysis
