// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of a session with the state left by earlier rows, so that any section of them can be judged alone.
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
  double envelope = 1;  ///< of the drive
  /// The input of the linear model: the drive, or its equivalent through the bender's hysteresis.
  double linear_drive_v = 0;
};

/// Whether the drive is zero before the first row, and after the last: then the tray rests there.
/// Precondition: not empty.
bool begins_at_rest(std::span<const JudgedRow> rows);
bool ends_at_rest(std::span<const JudgedRow> rows);

/// Receives all rows of a session in order.
class RowFollower {
 public:
  explicit RowFollower(const SessionOverview& overview);
  /// `turns` are the changes of texture so far (RowMaker::turns).
  JudgedRow next(const SessionRow& row, std::span<const TextureChange> turns);

 private:
  MixFollower mix_;
  GainFollower gain_;
  core::Envelope envelope_;
  float weight_ = 0;
  std::optional<LinearDrive> bender_;
};

/// The delay from the drive to the tray for a slow change: the phase delay of actuator, filter and hold at
/// the band's lower edge, and the way to the device if the loop is closed on the host.
double drive_delay_s(const schema::SessionHeader& header);

/// The model's displacement for the recorded drive, in the session's band: m, `between` samples per row, the
/// first at the first row. Before and after the rows the drive is zero.
std::vector<double> predicted_displacement_m(const schema::SessionHeader& header,
                                             std::span<const JudgedRow> rows, std::size_t between = 1);

}  // namespace tacto::playback
