// SPDX-License-Identifier: GPL-3.0-or-later
// What the tray's sensor measured in a session, at the times of its rows.
#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "playback/session/sensor_samples.hpp"
#include "playback/strokes/judged_rows.hpp"
#include "playback/strokes/measured_row.hpp"

namespace tacto::playback {

/// The measured displacement in a stretch of rows.
class MeasuredStretch {
 public:
  /// None where samples are missing within 0.3 s: so long rings the band's lower edge.
  std::optional<MeasuredRow> at(std::size_t row) const;

 private:
  friend class MeasuredReader;
  std::vector<double> fine_m_;   // in the band, between the frames
  std::vector<double> at_fine_;  // of each row: an index of fine_m_
  std::vector<bool> known_;      // of each row
  double fine_rate_hz_ = 0;
};

/// Reads the samples beside the rows, each once: memory is that of a stretch. The sensor's frames are cut to
/// the session's band as what was wanted is (keep_band); missing ones lie on a line. They are read at the
/// rows' times, both by the ticks' clock, from 32 readings a period of the band's upper edge (by Fourier
/// interpolation) with the cubic of Catmull and Rom, whose error there is (2 pi / 32)^4 / 48: -90 dB.
class MeasuredReader {
 public:
  /// None where the session's header names no sensor. The overview stays where it is.
  static std::optional<MeasuredReader> open(const SessionOverview& overview);

  /// Of consecutive rows, at least one; those of the next call begin no earlier.
  MeasuredStretch in(std::span<const JudgedRow> rows);

 private:
  // Without a hole; between which times frames were missing.
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
