// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of a session with what those before them leave in each: any stretch of them can be judged by itself.
#pragma once

#include <optional>
#include <span>

#include "playback/daemon/session_rows.hpp"
#include "playback/daemon/texture_mix.hpp"
#include "playback/hysteresis_inverse.hpp"

namespace tacto::playback {

struct JudgedRow {
  SessionRow row;
  MixRow mix;
  double followed_gain = 1;
  /// What the linear model is given: the drive, through the bender's hysteresis where it has one.
  double linear_drive_v = 0;
};

/// Takes all rows of a session in their order.
class RowFollower {
 public:
  explicit RowFollower(const schema::SessionHeader& header);
  /// `turns` are the changes so far (RowMaker::turns).
  JudgedRow next(const SessionRow& row, std::span<const TextureTurn> turns);

 private:
  MixFollower mix_;
  GainFollower gain_;
  std::optional<LinearDrive> bender_;
};

/// What the model makes of the recorded drive, in the session's band: displacement in m, one a row. Before
/// and after the rows the drive is zero.
std::vector<double> received_displacement_m(const schema::SessionHeader& header,
                                            std::span<const JudgedRow> rows);

}  // namespace tacto::playback
