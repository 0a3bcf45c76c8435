// SPDX-License-Identifier: GPL-3.0-or-later
// Two real frames in one complex transform: z = a + i b gives A_k = (Z_k + conj Z_-k) / 2 and B_k = (Z_k -
// conj Z_-k) / 2i (Press et al., Numerical Recipes, 12.3). Only arithmetic, no allocation. Real is float or
// double.
#pragma once

#include <complex>
#include <span>

namespace tacto::spatial {

template <class Real>
using PackedSpectrum = std::span<const std::complex<Real>>;

/// One frame: its samples, the level that is subtracted from them, and the slope of a straight line that is
/// added.
struct Frame {
  const float* samples = nullptr;
  double level = 0;
  double slope = 0;  ///< per sample
};

/// packed_n = w_n (a_n - level_a + slope_a n) + i w_n (b_n - level_b + slope_b n) for every n of the window,
/// in single precision; the rest of `packed` is not changed.
template <class Real>
void pack_frames(const Frame& a, const Frame& b, std::span<const float> window,
                 std::span<std::complex<Real>> packed);

/// |A_k|^2 and |B_k|^2 for k from 0, as many as the rows hold: at most half the transform's length, plus one.
template <class Real>
void unpack_powers(PackedSpectrum<Real> z, std::span<float> a, std::span<float> b);

/// A_k and B_k themselves.
template <class Real>
void unpack_spectra(PackedSpectrum<Real> z, std::span<std::complex<float>> a,
                    std::span<std::complex<float>> b);

}  // namespace tacto::spatial
