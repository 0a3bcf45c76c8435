// SPDX-License-Identifier: GPL-3.0-or-later
// A permutation test: do two groups of spectra differ, and in which band most.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace tacto::analysis {

/// Exchanges of the labels of A and B, from which the p of a test is computed.
inline constexpr std::size_t kExchanges = 999;

/// Levels in dB of strokes (or means of recordings) of two sides, A and B.
struct LabelledLevels {
  std::size_t bands = 0;
  std::vector<double> level_db;  ///< one stroke after the other, `bands` values each
  std::vector<bool> in_b;        ///< the side of each stroke
  std::vector<int> stratum;      ///< labels are exchanged within a stratum only
  /// Further columns of the null model, one value per stroke each; a column that the strata and the columns
  /// before it determine is left out.
  std::vector<std::vector<double>> covariates;

  std::size_t strokes() const { return in_b.size(); }
};

/// Difference of the sides, B over A, over adjacent bands: the mean of their levels.
struct BandWindow {
  std::size_t first = 0, bands = 0;
  double level_db = 0;
  double error_db = 0;  ///< moderated standard error
};

struct LabelTest {
  double p = 1;  ///< of both statistics together
  double window_statistic = 0, window_p = 1;
  double shape_statistic = 0, shape_p = 1;
  std::vector<BandWindow> windows;  ///< all windows, the single bands first
  std::size_t strongest = 0;        ///< the window with the largest |level_db| / error_db
  /// The simultaneous 95 % interval of every window is level_db -+ reach error_db.
  double reach = 0;
  double spread_db = 0;  ///< standard deviation of strokes within a side in one band: RMS over the bands
};

inline constexpr std::size_t kMostWindowBands = 12;  ///< two octaves
inline constexpr double kTestLevel = 0.05;

/// The number of ways to exchange the labels within the strata.
double exchanges(const LabelledLevels& data);

/// The part of the variance of the side within the strata that the covariates do not explain, 0 to 1: 1 if
/// they are balanced. 0 if no stratum has both sides.
double separable_part(const LabelledLevels& data);

/// The null model has a mean per stratum and the covariates. x is the side, less its projection onto the null
/// model, divided by its length; e_b are the residuals of band b (or of the mean level of a window of up to
/// 12 bands).
///   c_b = x' e_b,   s_b^2 = (e_b' e_b - c_b^2) / f,   f = strokes - rank of the null model - 1
///   moderated: s~_b^2 = (4 m + f s_b^2) / (4 + f), m the mean of s^2 over all windows of that width
///              (Smyth 2004, Stat. Appl. Genet. Mol. Biol. 3(1), with fixed 4 degrees of freedom)
///   window statistic = max over all windows of t_b^2 = c_b^2 / s~_b^2
///   shape statistic = t' (0.7 R + 0.3 I)^-1 t over the single bands, R the correlation of the residuals of
///                     null model and side (Hotelling's T^2, regularised)
/// The p of each is its rank among kExchanges exchanges within the strata (seeded: the same in each
/// call), and p the rank of the smaller of the two. Each exchanged side is projected in the same way.
/// Preconditions: f >= 1, separable_part > 0.
LabelTest label_test(const LabelledLevels& data);

}  // namespace tacto::analysis
