// SPDX-License-Identifier: GPL-3.0-or-later
// Two real frames in one complex transform: z = a + i b gives A_k = (Z_k + conj Z_-k) / 2 and
// B_k = (Z_k - conj Z_-k) / 2i (Press et al., Numerical Recipes, 12.3). Pure arithmetic, no allocation. Real
// is float or double.
#pragma once

#include <complex>
#include <span>

namespace tacto::spatial {

template <class Real>
using PackedSpectrum = std::span<const std::complex<Real>>;

/// One frame: its samples, the level that is taken off them, and a straight line's slope that is put back.
struct Frame {
  const float* samples = nullptr;
  double level = 0;
  double slope = 0;  ///< a sample
};

/// packed_n = w_n (a_n - level_a + slope_a n) + i w_n (b_n - level_b + slope_b n) for every n of the window,
/// in single precision; what of `packed` lies beyond is left as it is.
template <class Real>
void pack_frames(const Frame& a, const Frame& b, std::span<const float> window,
                 std::span<std::complex<Real>> packed);

/// |A_k|^2 and |B_k|^2 for k from 0, as many as the rows take: at most half the transform's length, plus one.
template <class Real>
void unpack_powers(PackedSpectrum<Real> z, std::span<float> a, std::span<float> b);

/// A_k and B_k themselves.
template <class Real>
void unpack_spectra(PackedSpectrum<Real> z, std::span<std::complex<float>> a,
                    std::span<std::complex<float>> b);

}  // namespace tacto::spatial
