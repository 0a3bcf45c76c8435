// SPDX-License-Identifier: GPL-3.0-or-later
// Whether two textures are alike, in a word, from how their bands differ and how much their parts scatter.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "analysis/compare/narrow_bands.hpp"
#include "analysis/compare/spectral_lines.hpp"

namespace tacto::analysis {

enum class Likeness { same, louder, quieter, different, undecided };
std::string_view to_string(Likeness likeness);

/// Powers by segment and band, `bands` to a row. Rows of both belong together where `paired`.
struct BandPowers {
  std::size_t bands = 0;
  bool paired = true;
  std::vector<double> a, b;
};

/// What the segments tell. Levels are of B over A, dB.
struct Evidence {
  std::size_t bands = 0, segments = 0;         ///< segments of the shorter
  std::vector<double> band_db, scatter_db;     ///< B over A by band, and its standard error
  double level_db = 0;                         ///< weighted mean over the bands
  double level_low_db = 0, level_high_db = 0;  ///< its 90 % interval: each end is passed once in 20 times
  double shape_db = 0;                         ///< weighted RMS of band_db - level_db
  /// What shape_db exceeds once in 20 times where only the parts' scatter is at work.
  double shape_chance_db = 0;
  /// shape_db without the scatter's mean share: sqrt(shape^2 - mean chance^2), 0 at least.
  double shape_excess_db = 0;
  double finest_shape_db = 0;  ///< the least excess that would be seen over the scatter
  /// What the one-third-octave bands are too wide for: filled in by compare().
  std::optional<NarrowBand> narrow;
  std::optional<SpectralLine> line;
};

/// Bootstrap over segments (Efron 1979; 1,000 draws, the same each time): segments are drawn with
/// replacement, in pairs where they are paired, and give the scatter of each band's difference, of their
/// mean, and, about what was seen, of the shape. Deviations are widened by sqrt(n / (n - 1)) for the
/// bootstrap's bias, and by sqrt(19/18) for the overlap of Hann windows; the interval by Student's t with n -
/// 1 degrees. Bands weigh 1 / (scatter^2 + tolerance^2). A band's power is at least its texture's strongest
/// band less 60 dB. Preconditions: 2 segments, 1 band, some power in both.
Evidence evidence_of(const BandPowers& powers, double tolerance_db);

/// The rule, in this order:
/// - undecided: fewer than 8 segments, or less than an octave (3 bands) in common.
/// - different: shape_db above shape_chance_db, and shape_excess_db above the tolerance; or the strongest
///   narrow band or line has a score above its chance_score and a level beyond the tolerance.
/// - undecided: finest_shape_db above the tolerance: a difference that counts would not show.
/// - louder, quieter: the level beyond the tolerance, and its interval does not hold 0.
/// - same: the level's interval lies within the tolerance: two one-sided tests (Schuirmann 1987, J.
///   Pharmacokinetics and Biopharmaceutics 15).
/// - undecided: else.
struct Verdict {
  Likeness likeness = Likeness::undecided;
  std::string because;  ///< with the numbers that decided
};
Verdict verdict_of(const Evidence& evidence, double tolerance_db);

/// Whether the strongest narrow band, or line, makes the textures different.
bool band_differs(const Evidence& evidence, double tolerance_db);
bool line_differs(const Evidence& evidence, double tolerance_db);

/// The smallest differences that would have been found, in a sentence: in a narrow, a middle and a wide band,
/// and of a line; none is smaller than the tolerance. Empty where neither was looked for.
std::string detectable_words(const Evidence& evidence, double tolerance_db);

inline constexpr std::size_t kFewestSegments = 8, kFewestBands = 3;

}  // namespace tacto::analysis
