// SPDX-License-Identifier: GPL-3.0-or-later
// Decides whether two surfaces differ, from several strokes over each, by the spread of the strokes.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/compare/label_test.hpp"
#include "analysis/compare/simulated_sides.hpp"
#include "data-schema/base/error.hpp"
#include "data-schema/texture/texture.hpp"

namespace tacto::analysis {

// The spectrum of one stroke as levels in one-sixth-octave bands.

/// Edges of the whole one-sixth-octave bands within [low_per_m, high_per_m], one more than bands: G^(x/6) /
/// mm for integers x, G = 10^0.3 (IEC 61260-1:2014, 5.2 to 5.5, base 10, reference frequency 1 /mm); two
/// adjacent bands are a one-third-octave band. Empty if no band is whole. Precondition: 0 < low_per_m,
/// finite.
std::vector<double> sixth_octave_edges(double low_per_m, double high_per_m);

/// Power of `values` less their mean in each band, in dB re 1 unit^2: the mean of the periodograms with four
/// sine tapers (Riedel and Sidorenko 1995, IEEE Trans. Signal Processing 43(1)), w_k(n) = sqrt(2 / (N + 1))
/// sin(pi k n / (N + 1)), integrated with a constant density within half a bin around each bin. A level is at
/// least the largest less 60 dB. Empty if there is no power in any band. Preconditions: at least 8 values, at
/// least two edges, the last at most half the frequency of the grid.
std::vector<double> stroke_levels_db(std::span<const double> values, double pitch_m,
                                     std::span<const double> edges_per_m);

/// One side of a comparison of surfaces.
struct SurfaceSide {
  std::string name;
  std::vector<std::string> stroke_names;  ///< for messages, as many as strokes
  std::vector<schema::Texture> strokes;
};

enum class SurfaceVerdict { different, no_difference_found, undecided };
std::string_view to_string(SurfaceVerdict verdict);

/// Facts of one side.
struct SideFacts {
  std::string name, simulated;
  std::size_t strokes = 0, recordings = 0;
  std::optional<double> speed_mps, load_n;  ///< geometric means, if known of all strokes
  std::vector<double> level_db;             ///< mean over the strokes, per band
};

struct SurfaceComparison {
  SurfaceVerdict verdict = SurfaceVerdict::undecided;
  std::string because;  ///< one sentence with the decisive numbers
  SideFacts a, b;
  SimulatedSides simulated() const { return {a.simulated, b.simulated}; }
  bool by_recording = false;  ///< the unit of the test is a recording, not a stroke
  std::size_t units_a = 0, units_b = 0;
  double tolerance_db = 0;
  std::string unit;                 ///< of the strokes
  std::vector<double> edges_per_m;  ///< of the bands, one more than bands
  double separable = 0;             ///< separable_part by speed and load
  std::optional<LabelTest> test;    ///< none if `undecided` before the test
  /// A difference that is found in at least 8 of 10 comparisons, wherever it is: over a third of an octave,
  /// and over two octaves or all bands.
  double finest_third_octave_db = 0, finest_level_db = 0;
  std::vector<std::string> notes;

  double low_per_m(const BandWindow& window) const { return edges_per_m[window.first]; }
  double high_per_m(const BandWindow& window) const { return edges_per_m[window.first + window.bands]; }
};

/// Levels (stroke_levels_db) of each stroke's steady part, in the bands that are valid in all of them, go to
/// label_test. Strata: direction; also subject and finger if each one's strokes are on both sides. Covariates
/// from 12 units on: log of mean speed and of mean normal force, if known of all strokes. With 4 recordings a
/// side or more, the unit is the recording: the mean of its strokes' levels, each less the mean of its
/// stratum. Otherwise it is the stroke, and the answer holds for these recordings only. A texture without a
/// recording counts as a recording. Textures of one recording and direction with less than
/// kStrokePause_s between them are pieces of one stroke between gaps, and count as one stroke.
///
/// undecided: fewer than 5 strokes (or 4 recordings) a side; fewer than 40 exchanges of the labels; speed and
/// load explain more than three quarters of the side. different: p is at most 0.05, and the strongest window
/// differs by the tolerance or more. Otherwise no_difference_found.
///
/// Errors: usage: a tolerance that is not above 0, two textures of one section of a recording; unsuitable:
/// different quantities or units, a mean of several strokes, fewer than 64 samples at steady speed, less than
/// an octave in common, a stroke without power, measured and simulated strokes on one side.
schema::Result<SurfaceComparison> compare_surfaces(const SurfaceSide& a, const SurfaceSide& b,
                                                   double tolerance_db);

}  // namespace tacto::analysis
