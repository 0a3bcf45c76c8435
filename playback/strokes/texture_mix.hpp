// SPDX-License-Identifier: GPL-3.0-or-later
// The weight of each texture in the drive at each row of a session, also while one replaces another.
#pragma once

#include <span>
#include <vector>

#include "playback/session/session_rows.hpp"

namespace tacto::playback {

/// Set 0 is that of the header, set n that of the n-th change. The remaining part of a row is that of
/// `playing`.
struct MixRow {
  std::uint32_t playing = 0, leaving = 0;
  float leaving_part = 0;
};

/// The cross-fade of core::TexturePlayer row by row: w = u^2 (3 - 2 u). A second change begins from the
/// texture with the larger part. A filled row is not a tick.
class MixFollower {
 public:
  /// For the next row; `turns` are the changes so far (RowMaker::turns).
  MixRow next(const SessionRow& row, std::span<const TextureChange> turns);

 private:
  std::uint32_t playing_ = 0, leaving_ = 0;
  float fade_ = 0, step_ = 0;  // single precision, as in core::TexturePlayer
  bool begun_ = false;
};

/// The factor of the textures' gains with the kernel's ramp: linear, within 10 ms.
class GainFollower {
 public:
  explicit GainFollower(double rate_hz);
  double next(const SessionRow& row);

 private:
  double ticks_, gain_ = 0, aim_ = 0, step_ = 0, left_ = 0;
  bool begun_ = false;
};

/// A set of textures in consecutive rows: its parts, 0 to 1; the parts of all sets add up to 1.
struct MixedSet {
  std::size_t first = 0;
  std::vector<float> part;
};

struct TextureMix {
  std::vector<MixedSet> sets;
  std::vector<bool> unknown;  ///< per row: whether an unknown set has a part in it
};

/// An unknown set is replaced by the last known one: its rows are marked unknown, and rows beside them get no
/// step. Precondition: known.size() is above every set of the rows.
TextureMix texture_mix(std::span<const MixRow> rows, const std::vector<bool>& known);

}  // namespace tacto::playback
