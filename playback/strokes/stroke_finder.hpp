// SPDX-License-Identifier: GPL-3.0-or-later
// Strokes of a session found row by row, and what is summed over each: none is too long.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>

#include "playback/model/limit_tally.hpp"
#include "playback/session/session_rows.hpp"
#include "playback/strokes/measured_row.hpp"

namespace tacto::playback {

/// What a row adds to its stroke.
struct StrokeRow {
  std::uint64_t index = 0;  ///< in the session
  SessionRow row;
  double target_m = 0, predicted_m = 0;
  bool known = true;  ///< what was wanted
  std::optional<MeasuredRow> measured;
  std::optional<float> unlimited_v;  ///< before the limits; none: not known
};

/// Over consecutive rows.
struct StrokeSums {
  StrokeRow first, last;
  std::uint64_t rows = 0;
  double wanted_m2 = 0, predicted_m2 = 0, difference_m2 = 0;
  std::uint64_t limited_ticks = 0, energy_limited_ticks = 0, gated_ticks = 0;
  bool known = true, wishes_known = true, measured_known = true;  ///< of every row
  double measured_m2 = 0;
  std::array<double, kMeasuredShifts> measured_difference_m2{};  ///< at each shift
  LimitTally limits;                                             ///< of the ticks among them

  void add(const StrokeRow& row);
  void add(const StrokeSums& later);

 private:
  void add_measured(const StrokeRow& row);
};

inline constexpr double kShortestStrokeM = 5e-3;

/// A stroke is one way of the finger without turning (a finger that goes back by less than 0.2 mm has not
/// turned), while playing, at least 5 mm long: the farthest place so far in a direction ends it once the
/// finger has gone back from there. It is found then. A blind tick, in which the finger's place is not known,
/// ends it too, and none begins before the next that sees.
class StrokeFinder {
 public:
  explicit StrokeFinder(std::function<void(const StrokeSums&)> found) : found_(std::move(found)) {}
  /// Rows in their order.
  void add(const StrokeRow& row);
  /// After the last one.
  void end();
  /// Rows in which something was played.
  std::uint64_t played() const { return played_; }
  /// The longest way without turning that ended, whether it was a stroke or too short.
  double longest_way_m() const { return longest_way_m_; }

 private:
  void start_at(const StrokeRow& row);
  void turn();

  std::function<void(const StrokeSums&)> found_;
  StrokeSums so_far_;  // to the farthest place; before there is a direction, the row that it starts in
  StrokeSums since_;   // from there on
  int direction_ = 0;
  bool begun_ = false;
  std::uint64_t played_ = 0;
  double longest_way_m_ = 0;
};

}  // namespace tacto::playback
