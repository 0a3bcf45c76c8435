// SPDX-License-Identifier: GPL-3.0-or-later
// Why a play was felt nowhere.
#pragma once

#include <cmath>
#include <optional>
#include <string>

#include "playback/player/program.hpp"
#include "playback/session/tick_view.hpp"

namespace tacto::playback {

/// What a program says of where and when it can be felt.
struct Feelable {
  double start_m = 0, end_m = 0;
  bool stops = true;          ///< at its ends
  double contact_on_n = 0;    ///< 0: always
  double reach_m = INFINITY;  ///< from the encoder's zero
};

Feelable feelable(const Program& program);

/// A sentence where ticks were played and none of them had a drive: by the gate, by the finger's way, or for
/// a reason that neither tells; none where something was felt.
std::optional<std::string> note_of_silence(const TickView& ticks, const Feelable& what);

}  // namespace tacto::playback
