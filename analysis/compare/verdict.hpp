// SPDX-License-Identifier: GPL-3.0-or-later
// Decides whether two textures differ beyond measurement noise, from the differences of their bands and the
// scatter of their segments. It cannot decide whether two surfaces differ: strokes over one surface differ,
// too (surfaces.hpp).
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/compare/cross_spectrum.hpp"

namespace tacto::analysis {

// Finds the band in which two textures differ most, and the spectral line that only one of them has, over
// their whole length; compares both with chance.

struct SpectralLine {
  double frequency_per_m = 0;
  bool in_b = false;         ///< whether B has the line, otherwise A
  double level_db = 0;       ///< line and noise over noise; densities in a Hann window of `window` samples
  double score = 0;          ///< power of its bin over the mean power of bins nearby: the largest of all
  double chance_score = 0;   ///< exceeded by 0.5 % of the pairs of steady textures of the same kind
  double detectable_db = 0;  ///< level of a line that is found in 8 of 10 pairs of steady textures
};

/// A maximum statistic over all frequencies, at half bins of the whole length of the shorter texture (both
/// from their starts), with a cosine taper of an eighth at each end. The power of A is divided by the larger
/// of two: the smooth density of both (mean of the logarithm over 24 bins to each side, at A's level), and
/// the mean power of B over 4 bins to each side; the power of B likewise. So a peak in both, or a line in
/// both that moved by less than 4 bins, is not a difference. Returns no value for fewer than 30 bins in [low,
/// high]. Preconditions: some power in both, 0 <= low < high.
std::optional<SpectralLine> strongest_line(std::span<const double> a, std::span<const double> b, double pitch,
                                           double low, double high, double window);

/// A difference in level over a band that is found, and exceeds the tolerance, in 8 of 10 pairs of steady
/// textures.
struct DetectableBand {
  double width_per_m = 0;
  double level_db = 0;
};

struct NarrowBand {
  double low_per_m = 0, high_per_m = 0;
  double level_db = 0;  ///< B over A in the band, relative to the mean level over all cells
  double score = 0;  ///< |level_db| over its standard error: the largest of the bands beyond the tolerance,
                     ///< or of all bands if none is beyond it
  double chance_score = 0;  ///< exceeded by 4.5 % of the pairs of steady textures of the same kind
  std::vector<DetectableBand> detectable;  ///< by growing width
};

/// A maximum (scan) statistic over all bands of 1, 2, 3, 4, 6, 8, 12, 16, 24 and 32 cells, up to half of all;
/// a cell is a bin of Welch's spectra, 1 / window wide. The cells are divided by a smooth mean density of
/// both textures, so that they have equal weights. The standard error of a band's level is the larger of two:
/// the exact one of steady Gaussian noise (log of a ratio of gamma variables; Welch 1967 for the overlap),
/// and the jackknife's over segments (Efron 1979), averaged over all bands of that width; the second is
/// larger if the textures are not stationary. Returns no value for fewer than 6 cells in [low, high] or 2
/// segments. Precondition: some power in both.
std::optional<NarrowBand> strongest_band(const SegmentSpectra& spectra, double low, double high,
                                         double tolerance_db);

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
