// SPDX-License-Identifier: GPL-3.0-or-later
// Finds the strokes of a session row by row, and sums over each, so that memory does not depend on their
// length.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>

#include "playback/model/limit_tally.hpp"
#include "playback/session/session_rows.hpp"
#include "playback/strokes/shifted_row.hpp"

namespace tacto::playback {

/// The contribution of a row to its stroke.
struct StrokeRow {
  std::uint64_t index = 0;  ///< in the session
  SessionRow row;
  double target_m = 0;
  bool known = true;  ///< the target
  ShiftedRow predicted{};
  std::optional<ShiftedRow> measured;
  std::optional<float> unlimited_v;  ///< before the limits; none: unknown
};

/// Sums of a displacement and of its difference from the target at each shift, m^2.
struct ShiftedSums {
  double displacement_m2 = 0;
  std::array<double, kShifts> difference_m2{};

  void add(const ShiftedRow& row, double target_m);
  void add(const ShiftedSums& later);
};

/// Sums over consecutive rows.
struct StrokeSums {
  StrokeRow first, last;
  std::uint64_t rows = 0;
  double target_m2 = 0;
  ShiftedSums predicted, measured;
  std::uint64_t limited_ticks = 0, energy_limited_ticks = 0, gated_ticks = 0;
  bool known = true, unlimited_known = true, measured_known = true;  ///< true for every row
  LimitTally limits;                                                 ///< of the ticks among them

  void add(const StrokeRow& row);
  void add(const StrokeSums& later);
};

/// A stroke is a movement of the finger without turning (a way back below 0.2 mm is not a turn), during
/// playback, at least kShortestStroke_m long. It ends at the farthest place in its direction, and is found
/// when the finger has gone back from there. A blind tick, in which the finger's place is unknown, ends it
/// too, and the next one begins at a tick with a known place.
class StrokeFinder {
 public:
  explicit StrokeFinder(std::function<void(const StrokeSums&)> found) : found_(std::move(found)) {}
  /// Call for the rows in order.
  void add(const StrokeRow& row);
  /// Call after the last row.
  void end();
  /// Number of rows during playback.
  std::uint64_t played() const { return played_; }
  /// The longest movement without turning that has ended, even if it was too short for a stroke.
  double longest_way_m() const { return longest_way_m_; }

 private:
  void start_at(const StrokeRow& row);
  void turn();

  std::function<void(const StrokeSums&)> found_;
  StrokeSums so_far_;  // to the farthest place; while there is no direction, the first row
  StrokeSums since_;   // after that place
  int direction_ = 0;
  bool begun_ = false;
  std::uint64_t played_ = 0;
  double longest_way_m_ = 0;
};

}  // namespace tacto::playback
