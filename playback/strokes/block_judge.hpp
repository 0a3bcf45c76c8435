// SPDX-License-Identifier: GPL-3.0-or-later
// Judges a session block by block: the target, the predicted and the measured value of each row, summed over
// strokes.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "playback/session/sensor_samples.hpp"
#include "playback/strokes/judged_rows.hpp"
#include "playback/strokes/session_target.hpp"
#include "playback/strokes/shifted_row.hpp"
#include "playback/strokes/stroke_finder.hpp"
#include "playback/strokes/stroke_report.hpp"

namespace tacto::playback {

// The displacement measured by the tray's sensor, at the times of a session's rows.

/// The measured displacement in a section of rows.
class MeasuredSection {
 public:
  /// None if samples are missing within 0.3 s, because the filter of the band's lower edge rings that long.
  std::optional<ShiftedRow> at(std::size_t row) const;

 private:
  friend class MeasuredReader;
  std::vector<double> fine_m_;   // in the band, interpolated between the frames
  std::vector<double> at_fine_;  // of each row: its index in fine_m_
  std::vector<bool> known_;      // of each row
  double fine_rate_hz_ = 0;
};

/// Reads the samples in parallel to the rows, each once; memory is that of a section. The sensor's frames are
/// filtered to the session's band as the target is (keep_band); missing ones are interpolated linearly. They
/// are evaluated at the rows' times, both on the ticks' clock: by Fourier interpolation to
/// kReadingsAPeriod, and between these by shifted_row().
class MeasuredReader {
 public:
  /// None if the session's header names no sensor. The overview must outlive this.
  static std::optional<MeasuredReader> open(const SessionOverview& overview);

  /// For consecutive rows, at least one; the rows of the next call must not begin earlier.
  MeasuredSection in(std::span<const JudgedRow> rows);

 private:
  // Frames without gaps, and the times between which frames were missing.
  struct Filled {
    std::vector<double> time_s, displacement_m;
    std::vector<std::pair<double, double>> missing_s;
  };
  explicit MeasuredReader(const SessionOverview& overview) : header_(overview.header), samples_(overview) {}
  Filled filled(double from_s, double to_s) const;

  const schema::SessionHeader& header_;
  SensorSamples samples_;
};

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
