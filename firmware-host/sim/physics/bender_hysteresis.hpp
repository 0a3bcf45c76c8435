// SPDX-License-Identifier: GPL-3.0-or-later
// The piezo bender's hysteresis: what it does lags what it was told, by how far and not by how long.
#pragma once

#include <array>
#include <cstddef>

namespace tacto::firmware_host {

/// Prandtl-Ishlinskii operator (Kuhnen 2003, "Modeling, identification and compensation of complex hysteretic
/// nonlinearities"): y = p_0 u + p sum_i E_i[u], where each play E_i follows u at a distance of at most r_i.
/// 32 plays of equal weight, evenly spread over the amplitude: Rayleigh's law, whose loops are made of
/// parabolas and open in proportion to the swing, as piezoceramics' do at moderate fields (Wiertlewski 2011,
/// section III-C: non-saturating, and "the minor loops are very small"). Causal, independent of rate, minor
/// loops closed and wiped out, as Madelung's rules have it. Between +-amplitude the loop's ends are u's own,
/// and its opening at u = 0 is `opening` of its height; a small swing sees the gain p_0, 1 - 2 x opening to
/// 1/32.
class BenderHysteresis {
 public:
  static constexpr std::size_t kPlays = 32;

  /// An opening of 0 to 0.3 (0: y = u, to the bit); amplitude in u's unit, above 0.
  BenderHysteresis(double opening, double amplitude);

  /// y, were u to go straight from where it settled to here. Changes nothing: for a step's inner stages.
  double at(double u) const;
  /// u went straight to here.
  void settle(double u);

 private:
  double threshold(std::size_t i) const { return (static_cast<double>(i) + 0.5) * spacing_; }

  bool on_;
  double spacing_, straight_ = 1, weight_ = 0;
  std::array<double, kPlays> plays_{};
};

}  // namespace tacto::firmware_host
