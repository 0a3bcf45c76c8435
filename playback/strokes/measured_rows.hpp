// SPDX-License-Identifier: GPL-3.0-or-later
// The displacement measured by the tray's sensor, at the times of a session's rows.
#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "playback/session/sensor_samples.hpp"
#include "playback/strokes/judged_rows.hpp"
#include "playback/strokes/shifted_row.hpp"

namespace tacto::playback {

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

}  // namespace tacto::playback
