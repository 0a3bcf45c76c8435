// SPDX-License-Identifier: GPL-3.0-or-later
// Simulated observers of the experiment `stretch`: which of two has the smaller period? For the tests of
// fits.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "analysis/psychometrics/psychometric_fit.hpp"

namespace tacto::analysis {

/// Draws that are the same on any machine (std's distributions are not).
class ObserverDraws {
 public:
  explicit ObserverDraws(std::uint64_t seed) : random_(seed) {}
  double uniform() { return static_cast<double>(random_() >> 11U) * 0x1p-53; }
  double between(double low, double high) { return low + (high - low) * uniform(); }

 private:
  std::mt19937_64 random_;
};

/// An observer with Weber fraction `weber` (his JND), who at 1 to 3 % of the trials does not attend and
/// guesses, at each of eight stretches as many trials as drawn, 10 to 40.
inline std::vector<LevelCount> observed(double weber, ObserverDraws& draws) {
  const double inattentive = draws.between(0.01, 0.03), trials = std::floor(draws.between(10, 41));
  const PsychometricFunction truth{
      Shape::normal, 0, weber / standard_quantile(Shape::normal, 0.75), inattentive / 2, {}};
  std::vector<LevelCount> levels;
  for (const double stretch : {-0.7, -0.5, -0.3, -0.1, 0.1, 0.3, 0.5, 0.7}) {
    LevelCount& level = levels.emplace_back(LevelCount{stretch, 0, trials});
    for (int i = 0; i < static_cast<int>(trials); ++i) level.yes += draws.uniform() < truth(stretch);
  }
  return levels;
}

/// The number of observers whose 95 % interval of W contains the true W.
inline int covered(int observers, double weber, const PsychometricOptions& options, std::uint64_t seed) {
  ObserverDraws draws(seed);
  const double spread = weber / standard_quantile(Shape::normal, 0.75);
  int inside = 0;
  for (int i = 0; i < observers; ++i) {
    const auto fit = fit_psychometric(observed(weber, draws), options);
    inside += fit && fit->spread.low <= spread && spread <= fit->spread.high;
  }
  return inside;
}

}  // namespace tacto::analysis
