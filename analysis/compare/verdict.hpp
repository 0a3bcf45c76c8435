// SPDX-License-Identifier: GPL-3.0-or-later
// Decides whether two textures differ beyond measurement noise, from the differences of their bands and the
// scatter of their segments. It cannot decide whether two surfaces differ: strokes over one surface differ,
// too (surfaces.hpp).
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "analysis/compare/narrow_bands.hpp"

namespace tacto::analysis {

/// How two textures differ beyond measurement noise.
enum class Likeness { none, louder, quieter, different, undecided };
std::string_view to_string(Likeness likeness);
/// For people: "different beyond measurement noise".
std::string verdict_words(Likeness likeness);

/// Powers, one row per segment, `bands` values per row. Rows of A and B correspond if `paired`.
struct BandPowers {
  std::size_t bands = 0;
  bool paired = true;
  std::vector<double> a, b;
};

/// Statistics of the segments. Levels are of B over A, dB.
struct Evidence {
  std::size_t bands = 0, segments = 0;         ///< segments of the shorter
  std::vector<double> band_db, scatter_db;     ///< level of B over A in each band, and its standard error
  double level_db = 0;                         ///< weighted mean over the bands
  double level_low_db = 0, level_high_db = 0;  ///< its 90 % interval: each end is exceeded once in 20 times
  double shape_db = 0;                         ///< weighted RMS of band_db - level_db
  /// shape_db exceeds this once in 20 times if only the scatter of the segments causes it.
  double shape_chance_db = 0;
  /// shape_db without the mean share of the scatter: sqrt(shape^2 - mean chance^2), at least 0.
  double shape_excess_db = 0;
  double finest_shape_db = 0;  ///< the smallest excess that is detectable above the scatter
  /// Differences that are too narrow for one-third-octave bands; compare() sets them.
  std::optional<NarrowBand> narrow;
  std::optional<SpectralLine> line;
};

/// Bootstrap over segments (Efron 1979; 1,000 draws, the same in each call): segments are drawn with
/// replacement, in pairs if they are paired. The draws give the scatter of each band's difference, of their
/// mean and, relative to the measured differences, of the shape. Deviations are multiplied by sqrt(n / (n -
/// 1)) for the bootstrap's bias, and by sqrt(19/18) for the overlap of Hann windows. The interval uses
/// Student's t with n - 1 degrees of freedom. The weight of a band is 1 / (scatter^2 + tolerance^2). The
/// power of a band is at least that of its texture's strongest band less 60 dB. Preconditions: 2 segments, 1
/// band, some power in both.
Evidence evidence_of(const BandPowers& powers, double tolerance_db);

/// The rules, in this order:
/// - undecided: fewer than 8 segments, or less than an octave (3 bands) in common.
/// - different: shape_db above shape_chance_db, and shape_excess_db above the tolerance; or the strongest
///   narrow band or line has a score above its chance_score and a level beyond the tolerance.
/// - undecided: finest_shape_db above the tolerance: a relevant difference would not be detected.
/// - louder, quieter: the level is beyond the tolerance, and its interval excludes 0.
/// - none: the level's interval lies within the tolerance: two one-sided tests (Schuirmann 1987, J.
///   Pharmacokinetics and Biopharmaceutics 15).
/// - undecided: otherwise.
struct Verdict {
  Likeness likeness = Likeness::undecided;
  std::string because;  ///< the reason, with the decisive numbers
};
Verdict verdict_of(const Evidence& evidence, double tolerance_db);

/// Whether the strongest narrow band or line makes the verdict `different`.
bool band_differs(const Evidence& evidence, double tolerance_db);
bool line_differs(const Evidence& evidence, double tolerance_db);

/// A sentence with the smallest detectable differences: in a narrow, a middle and a wide band, and of a line;
/// none is below the tolerance. Empty if neither bands nor lines were examined.
std::string detectable_words(const Evidence& evidence, double tolerance_db);

inline constexpr std::size_t kFewestSegments = 8, kFewestBands = 3;

}  // namespace tacto::analysis
