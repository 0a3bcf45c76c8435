// SPDX-License-Identifier: GPL-3.0-or-later
// Where the finger is and when: the path along which a texture is played.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/base/signal.hpp"

namespace tacto::playback {

/// Knots of a path, at least 2, all finite, time strictly increasing; both vectors of one length. Between
/// knots the finger moves by piecewise cubic Hermite interpolation (PCHIP), which never overshoots a knot: a
/// finger that stands still between two knots does.
struct FingerPath {
  std::vector<double> time_s;
  std::vector<double> position_m;
  std::vector<double> normal_force_n = {};  ///< with which it presses, even between knots; empty: not told

  double duration_s() const { return time_s.back() - time_s.front(); }
};

/// Reads a table whose first line names the columns; `time_s` and `position_m` are taken,
/// and `normal_force_n` where there is one; others are left alone. Columns are parted by
/// commas, or by semicolons or tabs: then numbers may have decimal commas. Errors: not_found; malformed, by
/// line and column, for a missing column (with those that exist), a ragged row, text, NaN, infinity, time
/// that does not grow, fewer than 2 rows.
schema::Result<FingerPath> read_finger_path(const std::string& file);

/// The same from a text in memory; `name` stands for the file in errors.
schema::Result<FingerPath> parse_finger_path(std::string_view text, const std::string& name);

/// One knot a sample. Precondition: at least 2 samples, of position in m.
FingerPath finger_path_of(const schema::TimeSignal& position);

/// Errors: unsuitable, by knot, where the path breaks what FingerPath promises.
schema::Result<void> check_finger_path(const FingerPath& path);

/// Positions at first time + i / rate_hz, i = 0 ... samples - 1, by PCHIP. Precondition: a checked path.
std::vector<double> positions_along(const FingerPath& path, double rate_hz, std::size_t samples);

/// The greatest speed of the PCHIP path, exact: in each segment the speed is a parabola. m/s.
double greatest_speed_mps(const FingerPath& path);

}  // namespace tacto::playback
