// SPDX-License-Identifier: GPL-3.0-or-later
// Resamples two textures to one grid and, if they share places, pairs their samples.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/texture/texture.hpp"

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

/// Uses the part of each at steady speed (spatial::steady_part; elsewhere the valid bands change from place
/// to place). The finer texture is low-passed to 0.4 cycles per sample of the coarser grid (0.35 if the ratio
/// is not an integer) and resampled by windowed sinc (error below 1e-5 of a tone). The same interpolation
/// moves B onto A's places. Errors: unsuitable: different quantities or units, no common band, fewer than 64
/// samples of either; usage: a shift that is not finite.
schema::Result<TexturePair> pair_textures(const schema::Texture& a, const schema::Texture& b,
                                          const PairOptions& options);

}  // namespace tacto::analysis
