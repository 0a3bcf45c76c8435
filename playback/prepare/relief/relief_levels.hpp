// SPDX-License-Identifier: GPL-3.0-or-later
// A height map as levels of B-spline coefficients, which the kernel reads by the speed of the hand.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/base/signal.hpp"
#include "data-schema/height/height_map.hpp"
#include "data-schema/scene/force_grid.hpp"

namespace tacto::playback {

// The B-spline coefficients of a height map, computed before playback.

/// Coefficients of the cubic B-spline surface that goes through all heights, in the heights' order (row by
/// row), with the outermost coefficients continued beyond the edges, as core::relief_at() does. Solves one
/// tridiagonal system per row and column in double precision. Precondition: heights.size() = columns x rows,
/// both at least 1.
std::vector<float> relief_coefficients(std::span<const double> heights, std::size_t columns,
                                       std::size_t rows);

struct ReliefLevel {
  std::size_t columns = 0, rows = 0;
  std::vector<float> coefficients;  ///< row by row
};

/// All levels cover columns x rows pitches of the map: place u (in samples, from its first one) of a level of
/// n columns is (x / pitch + columns / 2) n / columns - 1/2 at x from the centre of the map.
struct Relief {
  std::size_t columns = 0, rows = 0;  ///< of the map
  double pitch_m = 0;
  double highest_per_m = 0;  ///< above this spatial frequency lies less than 1e-6 of the power of the slope
  double samples_per_period = 0;  ///< least, of the levels after the first, to their shortest period; 0: none
  std::vector<ReliefLevel> levels = {};
  double centre_m[2] = {0, 0};  ///< of the map, from the centre of its patch, along columns and rows

  /// The largest eigenvalue, absolute, of the Hessian of the first level in a patch of this size, at the
  /// centre of the map.
  double curvature_per_m(double width_m, double height_m) const;
  /// Of the first level, at the samples and halfway between them.
  double largest_slope() const;
  /// Up to this speed the first level is played, and from this speed on nothing.
  double whole_to_mps(double rate_hz) const;
  double zero_from_mps(double rate_hz) const;
};

/// How a force changes with the place, at most. It draws back as a spring of `attracting_n_per_m` where the
/// least eigenvalue of the symmetric part of its derivatives is lowest, and drives away as one of
/// -`repelling_n_per_m` where the largest one is highest.
struct ForceSlopes {
  double attracting_n_per_m = 0, repelling_n_per_m = 0;
  double curl_n_per_m = 0;  ///< |dFy/dx - dFx/dy|
};

/// Two components of a force, in N: of the same levels.
struct ForceRelief {
  Relief x, y;

  /// Of the first level in a patch of this size, at the nodes and halfway between them; 0 for what is within
  /// the rounding of the coefficients.
  ForceSlopes slopes(double width_m, double height_m) const;
};

/// The first level is the surface through all heights (relief_coefficients()), less their mean. Each further
/// one has frequencies up to half an octave less (highest_per_m 2^(-n/2)), by a discrete cosine transform,
/// falling by a raised cosine from 0.8 of them on, on a grid of 12 samples to its shortest period. If all
/// levels then have more than 2^23 coefficients, the grids finer than the map are coarsened, at most to that
/// of the map. Levels are made until the fastest hand needs no further one. `where`: the map's file. Errors:
/// unsuitable: levels of more than 2 GB.
schema::Result<Relief> relief_levels(const schema::HeightMap& map, double rate_hz, double fastest_mps,
                                     const std::string& where);

/// One level with the heights as they are, for a surface in space.
Relief surface_relief(const schema::HeightMap& map);

/// A texture as a map of one row: the slope of its first level is minus the force (in N, as m/m),
/// interpolated between the samples by a quadratic B-spline. Its middle is that of the texture; beyond the
/// ends the slope is 0. Precondition: at least 2 samples. Errors: as relief_levels.
schema::Result<Relief> texture_levels(const schema::SpaceSignal& force_n, double rate_hz, double fastest_mps,
                                      const std::string& where);

/// Each component through all its nodes, as a height is, but with its mean. Errors: as relief_levels.
schema::Result<ForceRelief> force_levels(const schema::ForceGrid& grid, double rate_hz, double fastest_mps,
                                         const std::string& where);

}  // namespace tacto::playback
