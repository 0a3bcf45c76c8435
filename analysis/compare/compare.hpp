// SPDX-License-Identifier: GPL-3.0-or-later
// Two textures compared: by band, by coherence, by formants, and in a word.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "analysis/compare/cross_spectrum.hpp"
#include "analysis/compare/formant_match.hpp"
#include "analysis/compare/texture_pair.hpp"
#include "analysis/compare/verdict.hpp"
#include "data-schema/base/error.hpp"
#include "data-schema/texture/formants.hpp"
#include "data-schema/texture/texture.hpp"
#include "spatial/features/formants.hpp"
#include "spatial/spectrogram/spectrogram_options.hpp"

namespace tacto::analysis {

struct CompareOptions {
  PairOptions pair;
  /// Of Welch's spectra; unless told an eighth of the shorter texture (15 segments), and at most 8
  /// wavelengths of the lowest frequency that both know.
  std::optional<double> window_m;
  double tolerance_db = 2;  ///< what counts as a difference: 2 dB are a quarter of the amplitude
  bool formants = true;
  spatial::SpectrogramOptions spectrogram;  ///< in which formants are looked for
  spatial::FormantOptions formant;
};

/// One one-third-octave band (IEC 61260-1). Powers are integrals of Welch's densities over what of it both
/// know.
struct BandComparison {
  double centre_per_m = 0, low_per_m = 0, high_per_m = 0;
  bool partial = false;
  double a_rms = 0, b_rms = 0;
  double level_db = 0;                ///< B over A
  double scatter_db = 0;              ///< its standard error, by the scatter of the segments
  std::optional<double> error_db;     ///< power of B - A over A's; where paired
  std::optional<double> residual_db;  ///< the same of B - gain A, over B's
  std::optional<double> coherence;    ///< magnitude-squared, weighted by A's power
};

struct Comparison {
  TexturePair pair;
  double window_m = 0;
  double low_per_m = 0,
         high_per_m = 0;  ///< in which they are compared: known to both, and above 1.5 / window
  double tolerance_db = 0;
  std::vector<BandComparison> bands;
  double a_rms = 0, b_rms = 0;
  double power_level_db = 0;  ///< B's power over A's, all bands together
  double spectral_distance_db =
      0;  ///< RMS over the bands of level_db, unweighted (Gray and Markel 1976, d_2)
  Evidence evidence;
  Verdict verdict;
  /// Where paired: of all bands together.
  std::optional<double> gain;         ///< that makes |B - gain A| smallest; negative: upside down
  std::optional<double> error_db;     ///< B - A over A
  std::optional<double> residual_db;  ///< B - gain A over B; 0: nothing in common
  std::optional<double> coherence;    ///< weighted by A's power
  double chance_coherence = 1;  ///< what a bin exceeds once in 20 times where there is nothing in common
  bool point_by_point = false;  ///< coherence above chance: one place, not only one kind
  CrossSpectrum spectra;
  std::vector<schema::Formant> a_formants, b_formants;  ///< positions from the pair's first sample
  FormantMatch formants;
  double formant_resolution_per_m = 0;
  std::string a_simulated, b_simulated;
  std::vector<std::string> notes;
};

/// All of it, in the band that both know and the window sees. Errors: of pair_textures; usage: a window that
/// is longer than a texture or under 16 samples, a tolerance that is not above 0; unsuitable: a texture that
/// is silent there, fewer than 2 segments. `progress` hears fractions: of the spectrograms in which formants
/// are looked for.
schema::Result<Comparison> compare(const schema::Texture& a, const schema::Texture& b,
                                   const CompareOptions& options = {},
                                   const std::function<void(double)>& progress = {});

}  // namespace tacto::analysis
