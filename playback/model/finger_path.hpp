// SPDX-License-Identifier: GPL-3.0-or-later
// The position of the finger against time: the path along which a texture is played.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/base/signal.hpp"

namespace tacto::playback {

/// Knots of a path: at least 2, all finite, time strictly increasing; both vectors of the same length.
/// Between knots the finger moves by piecewise cubic Hermite interpolation (PCHIP), which never overshoots a
/// knot: between two equal positions the finger does not move.
struct FingerPath {
  std::vector<double> time_s;
  std::vector<double> position_m;
  std::vector<double> normal_force_n = {};  ///< at each knot, linear between knots; empty: unknown

  double duration_s() const { return time_s.back() - time_s.front(); }
};

/// Reads the columns `time`, `position` and, if there is one, `normal_force` of a table whose first line
/// names the columns with their units (split_unit: `time_s,position_mm`); others are ignored. Columns are
/// separated by commas, or by semicolons or tabs: then numbers may have decimal commas. Errors: not_found;
/// malformed, with line and column, for a missing column (with those that exist), one without a fitting unit,
/// a row of another length, text, NaN, infinity, time that does not increase, fewer than 2 rows.
schema::Result<FingerPath> read_finger_path(const std::string& file);

/// The same for a text in memory; errors give `name` as the file.
schema::Result<FingerPath> parse_finger_path(std::string_view text, const std::string& name);

/// Whether the first line of a table names a column of this quantity, with any unit and separator.
bool has_column(std::string_view text, const std::string& quantity);

/// Reads the path of a hand on a device: the columns `time` and one of each axis's name, one path per axis,
/// all with the same times. Format and errors as above.
schema::Result<std::vector<FingerPath>> read_axis_paths(const std::string& file,
                                                        const std::vector<std::string>& axes);

/// Whether the path can begin again at its end: that meets its beginning within 1 um, which is below the step
/// of encoders.
bool ends_where_it_began(const FingerPath& path);

/// The path `times` times: each time from its beginning if it ends where it began, else back and forth.
/// Errors: usage, for more than 2^24 knots. Precondition: times > 0.
schema::Result<FingerPath> repeated(const FingerPath& path, std::size_t times);

/// One knot per sample. Precondition: at least 2 samples of position in m.
FingerPath finger_path_of(const schema::TimeSignal& position);

/// Errors: unsuitable, with the knot, if the path breaks the rules of FingerPath.
schema::Result<void> check_finger_path(const FingerPath& path);

/// Positions at first time + i / rate_hz, i = 0 ... samples - 1, by PCHIP. Precondition: a checked path.
std::vector<double> positions_along(const FingerPath& path, double rate_hz, std::size_t samples);

/// The greatest speed of the PCHIP path, m/s. Exact: in each segment the speed is a parabola.
double greatest_speed_mps(const FingerPath& path);

}  // namespace tacto::playback
