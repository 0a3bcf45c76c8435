// SPDX-License-Identifier: GPL-3.0-or-later
// Judges a session block by block: what was wanted, predicted and measured in each row, into the strokes.
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

/// Whether the way that the finger is on in the last row is known to its end.
enum class LastWay { whole, cut };

class BlockJudge {
 public:
  /// The overview stays where it is.
  BlockJudge(const SessionOverview& overview, const JudgedBlocks& blocks,
             std::function<void(const StrokeSums&)> found);

  /// Ticks in their order; `wished_v` before the limits, where it is known.
  void take(const schema::SessionTick& tick, std::optional<float> unlimited_v);
  /// After the last one. Precondition: there was one.
  void finish(LastWay last);
  std::vector<std::string> notes() const { return target_.notes(maker_.turns()); }
  const StrokeFinder& strokes() const { return strokes_; }

 private:
  void judge(std::size_t rows);

  const SessionOverview& overview_;
  std::size_t block_rows_, around_rows_;
  RowMaker maker_;
  RowFollower follower_;
  WantedReader target_;
  std::optional<MeasuredReader> measured_;  // of a session that holds samples
  StrokeFinder strokes_;
  std::vector<JudgedRow> rows_;
  std::vector<std::optional<float>> wished_v_;
  std::size_t judged_ = 0;       // of rows_: what is around the next block
  std::uint64_t first_row_ = 0;  // of rows_, in the session
};

}  // namespace tacto::playback
