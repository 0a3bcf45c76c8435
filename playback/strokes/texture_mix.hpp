// SPDX-License-Identifier: GPL-3.0-or-later
// Which textures a session's drive was of in each row, and how much of each.
#pragma once

#include <span>
#include <vector>

#include "playback/session/session_rows.hpp"

namespace tacto::playback {

/// Set 0 is the header's, set n what the n-th change brought. The rest of a row is of the one that plays.
struct MixRow {
  std::uint32_t playing = 0, leaving = 0;
  float leaving_part = 0;
};

/// Row by row as core::TexturePlayer fades: w = u^2 (3 - 2 u), a second change beginning from what is nearer;
/// a row that was put in is no tick.
class MixFollower {
 public:
  /// Of the next row; `turns` are the changes so far (RowMaker::turns).
  MixRow next(const SessionRow& row, std::span<const TextureTurn> turns);

 private:
  std::uint32_t playing_ = 0, leaving_ = 0;
  float fade_ = 0, step_ = 0;  // single precision, as there
  bool begun_ = false;
};

/// The factor on the textures' gains as the kernel follows it: evenly to a new one, within 10 ms.
class GainFollower {
 public:
  explicit GainFollower(double rate_hz);
  double next(const SessionRow& row);

 private:
  double ticks_, gain_ = 0, aim_ = 0, step_ = 0, left_ = 0;
  bool begun_ = false;
};

/// A set of textures in consecutive rows: parts of the whole, 0 to 1, all sets' together 1.
struct MixedSet {
  std::size_t first = 0;
  std::vector<float> part;
};

struct TextureMix {
  std::vector<MixedSet> sets;
  std::vector<bool> unknown;  ///< a row: what is not known had a part in it
};

/// In the place of a set that is not `known` the last known one goes on: its rows are unknown, those beside
/// them do not end in a step. Precondition: known.size() is above every set of the rows.
TextureMix texture_mix(std::span<const MixRow> rows, const std::vector<bool>& known);

}  // namespace tacto::playback
