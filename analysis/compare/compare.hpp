// SPDX-License-Identifier: GPL-3.0-or-later
// Compares two textures: by band, by coherence, by formants; the verdict is one word.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "analysis/compare/cross_spectrum.hpp"
#include "analysis/compare/simulated_sides.hpp"
#include "analysis/compare/verdict.hpp"
#include "data-schema/base/error.hpp"
#include "data-schema/texture/formants.hpp"
#include "data-schema/texture/texture.hpp"
#include "spatial/features/formants.hpp"
#include "spatial/spectrogram/spectrogram_options.hpp"

namespace tacto::analysis {

/// How the places of one texture are found in the other. position: by their places on the bench, or from both
/// starts if less than half of the shorter one is shared there. correlation: position, then the shift with
/// the largest correlation. none: no pairing, only spectra are compared.
enum class PairAlign { position, correlation, none };

struct PairOptions {
  PairAlign align = PairAlign::position;
  double max_shift_m = 2e-3;  ///< for `correlation`
};

struct TexturePair {
  double pitch_m = 0;        ///< the coarser of the two
  std::vector<double> a, b;  ///< of equal length if `paired`: sample i of both is at one place
  bool paired = true;
  std::string aligned;                ///< "place", "start", "correlation", "none": the method that was used
  double shift_m = 0;                 ///< added to B's positions by `correlation`
  std::optional<double> correlation;  ///< correlation of the two after the shift
  double a_from_m = 0, b_from_m = 0;  ///< positions of their first samples in A and in B
  double low_per_m = 0;               ///< the band that is valid in both throughout ...
  double high_per_m = 0;  ///< ... at most half the grid's frequency and the pass band of the resampling
  std::string quantity, unit;
  std::vector<std::string> notes;

  double length_m() const { return static_cast<double>(a.size()) * pitch_m; }
};

struct CompareOptions {
  PairOptions pair;
  /// Length of Welch's windows; by default an eighth of the shorter texture (15 segments), and at most 8
  /// wavelengths of the lowest common frequency.
  std::optional<double> window_m;
  double tolerance_db = 2;  ///< larger differences matter; 2 dB change the amplitude by 26 %
  bool formants = true;
  spatial::SpectrogramOptions spectrogram;  ///< for the search for formants
  spatial::FormantOptions formant;
};

/// One one-third-octave band (IEC 61260-1). Powers are integrals of Welch's densities over the part of the
/// band that is valid in both textures.
struct BandComparison {
  double centre_per_m = 0, low_per_m = 0, high_per_m = 0;
  bool partial = false;
  double a_rms = 0, b_rms = 0;
  double level_db = 0;                ///< power of B over that of A
  double scatter_db = 0;              ///< standard error of level_db, from the scatter of the segments
  std::optional<double> error_db;     ///< power of B - A over that of A; only if paired
  std::optional<double> residual_db;  ///< power of B - gain A over that of B
  std::optional<double> coherence;    ///< magnitude-squared, weighted by A's power
};

struct FormantMatch {
  std::vector<std::pair<std::size_t, std::size_t>> matched;  ///< indices in A and in B
  std::vector<std::size_t> missed;                           ///< in A, not in B
  std::vector<std::size_t> extra;                            ///< in B, not in A
};

struct Comparison {
  TexturePair pair;
  double window_m = 0;
  double low_per_m = 0,
         high_per_m = 0;  ///< the compared band: valid in both, and above 1.5 / window
  double tolerance_db = 0;
  std::vector<BandComparison> bands;
  double a_rms = 0, b_rms = 0;
  double power_level_db = 0;  ///< power of B over that of A, in all bands together
  double spectral_distance_db =
      0;  ///< RMS over the bands of level_db, unweighted (Gray and Markel 1976, d_2)
  Evidence evidence;
  Verdict verdict;
  /// Only if paired, for all bands together.
  std::optional<double> gain;         ///< least-squares gain from A to B; negative: inverted
  std::optional<double> error_db;     ///< power of B - A over that of A
  std::optional<double> residual_db;  ///< power of B - gain A over that of B; 0: nothing in common
  std::optional<double> coherence;    ///< weighted by A's power
  double chance_coherence = 1;  ///< coherence of a bin that independent textures exceed once in 20 times
  bool point_by_point = false;  ///< coherence above chance: the same place, not only the same kind
  CrossSpectrum spectra;
  std::vector<schema::Formant> a_formants, b_formants;  ///< positions from the pair's first sample
  FormantMatch formants;
  double formant_resolution_per_m = 0;
  SimulatedSides simulated;
  std::vector<std::string> notes;
};

/// Compares in the band that is valid in both and that the window resolves. `progress` receives fractions of
/// the spectrograms for the formants. Errors: those of pair_textures; usage: a window that is longer than a
/// texture or shorter than 16 samples, a tolerance that is not above 0; unsuitable: a texture without power
/// in the band, fewer than 2 segments.
schema::Result<Comparison> compare(const schema::Texture& a, const schema::Texture& b,
                                   const CompareOptions& options = {},
                                   const std::function<void(double)>& progress = {});

}  // namespace tacto::analysis
