// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of a session with the state left by earlier rows, so that any section of them can be judged alone.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "firmware-host/core/kernel/envelope.hpp"
#include "playback/model/hysteresis_inverse.hpp"
#include "playback/session/session_rows.hpp"

namespace tacto::playback {

// The weight of each texture in the drive at each row of a session, also while one replaces another.

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
