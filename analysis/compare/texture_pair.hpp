// SPDX-License-Identifier: GPL-3.0-or-later
// Two textures brought onto one grid, place by place where they have places in common.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/texture/texture.hpp"

namespace tacto::analysis {

/// How places of one texture are found in the other. position: where both lay on the bench, or from both
/// starts where they have less than half of the shorter one in common there. correlation: from there, by the
/// shift that makes them agree best. none: not at all; their spectra alone are compared.
enum class PairAlign { position, correlation, none };

struct PairOptions {
  PairAlign align = PairAlign::position;
  double max_shift_m = 2e-3;  ///< of `correlation`
};

struct TexturePair {
  double pitch_m = 0;        ///< the coarser of the two
  std::vector<double> a, b;  ///< of equal length where `paired`: sample i of both belongs to one place
  bool paired = true;
  std::string aligned;                ///< "place", "start", "correlation", "none": what in truth
  double shift_m = 0;                 ///< added to B's positions, by correlation
  std::optional<double> correlation;  ///< of the two, so shifted
  double a_from_m = 0, b_from_m = 0;  ///< where their first samples lie in A and in B
  double low_per_m = 0;               ///< the band that both know all along ...
  double high_per_m = 0;              ///< ... at most half the grid's frequency; what resampling keeps
  std::string quantity, unit;
  std::vector<std::string> notes;

  double length_m() const { return static_cast<double>(a.size()) * pitch_m; }
};

/// Takes the part at steady speed of each (spatial::steady_part: elsewhere their bands differ from place to
/// place). The finer grid is low-passed to 0.4 cycles a sample of the coarser one (0.35 where their ratio is
/// no whole number) and taken onto it by windowed sinc (error below 1e-5 of a tone); the same interpolation
/// moves B onto A's places. Errors: unsuitable: different quantities or units, no band in common, fewer than
/// 64 samples of either; usage: a shift that is not finite.
schema::Result<TexturePair> pair_textures(const schema::Texture& a, const schema::Texture& b,
                                          const PairOptions& options);

}  // namespace tacto::analysis
