// SPDX-License-Identifier: GPL-3.0-or-later
// The piezo bender's hysteresis: a rate-independent lag of the output behind the input.
#pragma once

#include <array>
#include <cstddef>

namespace tacto::firmware_host {

/// Prandtl-Ishlinskii operator (Kuhnen 2003, "Modeling, identification and compensation of complex hysteretic
/// nonlinearities"): y = p_0 u + p sum_i E_i[u], where each play E_i follows u at a distance of at most r_i.
/// 32 plays of equal weight, evenly spread over the amplitude. This is Rayleigh's law: its loops consist of
/// parabolas and open in proportion to the swing, as those of piezoceramics at moderate fields (Wiertlewski
/// 2011, section III-C: non-saturating, and "the minor loops are very small"). Causal and independent of
/// rate; minor loops are closed and then have no further effect (Madelung's rules). Between +-amplitude the
/// ends of the loop are those of u, and its opening at u = 0 is `opening` of its height. The gain of a small
/// swing is p_0, which is 1 - 2 x opening to 1/32.
class BenderHysteresis {
 public:
  static constexpr std::size_t kPlays = 32;

  /// An opening of 0 to 0.3 (0: y = u exactly); the amplitude in the unit of u, above 0.
  BenderHysteresis(double opening, double amplitude);

  /// y if u moves straight from its settled value to this one. Changes no state: for the inner stages of a
  /// step.
  double at(double u) const;
  /// Moves u straight to this value.
  void settle(double u);

 private:
  double threshold(std::size_t i) const { return (static_cast<double>(i) + 0.5) * spacing_; }

  bool on_;
  double spacing_, straight_ = 1, weight_ = 0;
  std::array<double, kPlays> plays_{};
};

}  // namespace tacto::firmware_host
