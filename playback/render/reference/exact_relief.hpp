// SPDX-License-Identifier: GPL-3.0-or-later
// Levels of a map in double precision, from the B-spline itself: the reference for core/scene/relief.hpp.
#pragma once

#include "playback/prepare/relief/relief_levels.hpp"

namespace tacto::playback {

struct SplineValue {
  double value = 0, by_x = 0, by_y = 0;
};

/// A level's surface and its slope along columns and rows, at a place in samples.
SplineValue spline_of(const ReliefLevel& level, double x, double y);

/// The place on a level, in samples, at `from_centre_m` from the centre of the patch; axis 0 or 1.
double place_on_level(const Relief& relief, const ReliefLevel& level, int axis, double from_centre_m);

/// At which level a map is played, in half octaves. The highest frequency of a level reaches half the rate
/// when it is left.
double level_at(const Relief& relief, double passed_mps, double rate_hz);

/// Of a frequency: 1 up to 3/8 of the rate, 0 from half of it on.
double played_share(double cycles_per_tick);

struct SlopeOfMap {
  double along_columns = 0, along_rows = 0;
};

/// Of the levels that are played at this speed, mixed, at a place from the centre of the patch.
SlopeOfMap exact_slope(const Relief& relief, double along_m, double across_m, double passed_mps,
                       double rate_hz);

}  // namespace tacto::playback
