// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/experiment/interval_guide.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "analysis/experiment/interval_play.hpp"

namespace tacto::analysis {

PressedAs pressed_as(const schema::ForceRange& range, double force_n) {
  if (force_n < range.low_n) return PressedAs::below;
  return force_n > range.high_n ? PressedAs::above : PressedAs::within;
}

std::optional<double> IntervalGuide::force_within() const {
  return known_s_ > 0 ? std::optional(within_s_ / known_s_) : std::nullopt;
}

void IntervalGuide::operator()(playback::Player& player, double played_s) {
  Guidance guidance{std::max(0.0, -played_s), {}};
  if (const auto force_n = player.normal_force_n(); force_n && protocol_.normal_force) {
    guidance.pressed = pressed_as(*protocol_.normal_force, *force_n);
    const double since_s = std::max(0.0, played_s - last_s_);
    known_s_ += since_s;
    if (guidance.pressed == PressedAs::within) within_s_ += since_s;
  }
  last_s_ = std::max(0.0, played_s);
  if (!show_) return;
  if (protocol_.pace.cue) {
    const CuedPlace cued = cued_place(protocol_.pace, played_s);
    guidance.cued_part = cued.part;
    if (cued.stroke > cued_) player.note(fmt::format("cue {}", cued.stroke));
    cued_ = cued.stroke;
  }
  show_(guidance);
}

}  // namespace tacto::analysis
