// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of a session with what those before them leave in each: any stretch of them can be judged by itself.
#pragma once

#include <optional>
#include <span>

#include "firmware-host/core/kernel/envelope.hpp"
#include "playback/model/hysteresis_inverse.hpp"
#include "playback/session/session_rows.hpp"
#include "playback/strokes/texture_mix.hpp"

namespace tacto::playback {

struct JudgedRow {
  SessionRow row;
  MixRow mix;
  double followed_gain = 1;
  double envelope = 1;  ///< of the drive, by which it rises and falls
  /// What the linear model is given: the drive, through the bender's hysteresis where it has one.
  double linear_drive_v = 0;
};

/// Whether the drive has not risen in the first of them, and has fallen in the last: beside them, too, the
/// tray stands still then. Precondition: not empty.
bool begins_at_rest(std::span<const JudgedRow> rows);
bool ends_at_rest(std::span<const JudgedRow> rows);

/// Takes all rows of a session in their order.
class RowFollower {
 public:
  explicit RowFollower(const SessionOverview& overview);
  /// `turns` are the changes so far (RowMaker::turns).
  JudgedRow next(const SessionRow& row, std::span<const TextureTurn> turns);

 private:
  MixFollower mix_;
  GainFollower gain_;
  core::Envelope envelope_;
  float weight_ = 0;
  std::optional<LinearDrive> bender_;
};

/// By how much a slow change of the drive itself arrives later at the tray: the phase delay of actuator,
/// filter and hold at the band's lower edge, and of a loop closed on the host the way to the device.
double drive_delay_s(const schema::SessionHeader& header);

/// What the model makes of the recorded drive, in the session's band: displacement in m, one a row. Before
/// and after the rows the drive is zero.
std::vector<double> predicted_displacement_m(const schema::SessionHeader& header,
                                             std::span<const JudgedRow> rows);

}  // namespace tacto::playback
