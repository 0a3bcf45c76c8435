// SPDX-License-Identifier: GPL-3.0-or-later
// One step of the classical Runge-Kutta method.
#pragma once

#include <array>
#include <cstddef>

namespace tacto::firmware_host {

template <std::size_t N>
using OdeState = std::array<double, N>;

/// a + h b, element by element.
template <std::size_t N>
OdeState<N> advanced(const OdeState<N>& a, double h, const OdeState<N>& b) {
  OdeState<N> sum;
  for (std::size_t i = 0; i < N; ++i) sum[i] = a[i] + h * b[i];
  return sum;
}

/// The state after one step of `h` seconds; rate(state, fraction) returns d(state)/dt at a fraction (0, 1/2,
/// 1) of the step. For a mode of angular frequency w the relative error is (w h)^4 / 120 per radian: 2e-8 at
/// 600 Hz and h = 12.5 us. Stable while w h < 2.8.
template <std::size_t N, class Rate>
OdeState<N> runge_kutta_step(const OdeState<N>& state, double h, Rate&& rate) {
  const OdeState<N> k1 = rate(state, 0.0);
  const OdeState<N> k2 = rate(advanced(state, h / 2, k1), 0.5);
  const OdeState<N> k3 = rate(advanced(state, h / 2, k2), 0.5);
  const OdeState<N> k4 = rate(advanced(state, h, k3), 1.0);
  OdeState<N> next;
  for (std::size_t i = 0; i < N; ++i) next[i] = state[i] + h / 6 * (k1[i] + 2 * (k2[i] + k3[i]) + k4[i]);
  return next;
}

}  // namespace tacto::firmware_host
