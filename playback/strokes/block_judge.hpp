// SPDX-License-Identifier: GPL-3.0-or-later
// Judges a session block by block: the target, the predicted and the measured value of each row, summed over
// strokes.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "playback/strokes/judged_rows.hpp"
#include "playback/strokes/measured_rows.hpp"
#include "playback/strokes/session_target.hpp"
#include "playback/strokes/stroke_finder.hpp"
#include "playback/strokes/stroke_report.hpp"

namespace tacto::playback {

/// Whether the stroke of the last row is complete.
enum class LastStroke { whole, cut };

/// At least 1, at most 2^19.
std::size_t rows_in(double seconds, double rate_hz);

class BlockJudge {
 public:
  /// The overview must outlive this.
  BlockJudge(const SessionOverview& overview, const JudgedBlocks& blocks,
             std::function<void(const StrokeSums&)> found);

  /// Call for the ticks in order; `unlimited_v`: the drive before the limits, if known.
  void take(const schema::SessionTick& tick, std::optional<float> unlimited_v);
  /// Call after the last tick. Precondition: there was one.
  void finish(LastStroke last);
  std::vector<std::string> notes() const { return target_.notes(maker_.turns()); }
  const StrokeFinder& strokes() const { return strokes_; }

 private:
  void judge(std::size_t rows);

  const SessionOverview& overview_;
  std::size_t block_rows_, around_rows_;
  RowMaker maker_;
  RowFollower follower_;
  TargetReader target_;
  std::optional<MeasuredReader> measured_;  // if the session has samples of a sensor
  StrokeFinder strokes_;
  std::vector<JudgedRow> rows_;
  std::vector<std::optional<float>> unlimited_v_;
  std::size_t judged_ = 0;       // of rows_; kept as surroundings of the next block
  std::uint64_t first_row_ = 0;  // index of rows_[0] in the session
};

}  // namespace tacto::playback
