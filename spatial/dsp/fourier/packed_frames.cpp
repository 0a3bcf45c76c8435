// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/dsp/fourier/packed_frames.hpp"

#include <cassert>
#include <cstddef>

#include "spatial/dsp/fourier/simd_clones.hpp"

namespace tacto::spatial {
namespace {

// A complex array as plain numbers, which compilers can vectorise; std::complex has the same layout.
template <class Real>
const Real* numbers(PackedSpectrum<Real> z) {
  return reinterpret_cast<const Real*>(z.data());
}

template <class Real>
TACTO_SIMD_CLONES void pack_level(const Frame& a, const Frame& b, std::span<const float> window,
                                  Real* __restrict out) {
  const float* __restrict w = window.data();
  const float* __restrict x = a.samples;
  const float* __restrict y = b.samples;
  const auto level_x = static_cast<Real>(a.level), level_y = static_cast<Real>(b.level);
  for (std::size_t n = 0; n < window.size(); ++n) {
    const Real weight = w[n];
    out[2 * n] = weight * (x[n] - level_x);
    out[2 * n + 1] = weight * (y[n] - level_y);
  }
}

template <class Real>
TACTO_SIMD_CLONES void pack_sloping(const Frame& a, const Frame& b, std::span<const float> window,
                                    Real* __restrict out) {
  const auto level_a = static_cast<Real>(a.level), level_b = static_cast<Real>(b.level);
  const auto slope_a = static_cast<Real>(a.slope), slope_b = static_cast<Real>(b.slope);
  const auto count = static_cast<int>(window.size());  // converts to a float in one instruction
  for (int n = 0; n < count; ++n) {
    const auto at = static_cast<Real>(n);
    const Real weight = window[n];
    Real* const pair = out + std::ptrdiff_t{2} * n;
    pair[0] = weight * (a.samples[n] - level_a + slope_a * at);
    pair[1] = weight * (b.samples[n] - level_b + slope_b * at);
  }
}

}  // namespace

template <class Real>
void pack_frames(const Frame& a, const Frame& b, std::span<const float> window,
                 std::span<std::complex<Real>> packed) {
  assert(window.size() <= packed.size());
  auto* out = reinterpret_cast<Real*>(packed.data());
  if (a.slope == 0 && b.slope == 0)
    pack_level(a, b, window, out);
  else
    pack_sloping(a, b, window, out);
}

template <class Real>
TACTO_SIMD_CLONES void unpack_powers(PackedSpectrum<Real> z, std::span<float> a, std::span<float> b) {
  assert(a.size() == b.size() && a.size() <= z.size() / 2 + 1);
  if (a.empty()) return;
  const Real* __restrict up = numbers(z);
  const Real* __restrict down = up + 2 * z.size();  // Z_-k = Z_(length - k)
  float* __restrict power_a = a.data();
  float* __restrict power_b = b.data();
  power_a[0] = static_cast<float>(up[0] * up[0]);
  power_b[0] = static_cast<float>(up[1] * up[1]);
  const auto bins = static_cast<std::ptrdiff_t>(a.size());
  for (std::ptrdiff_t k = 1; k < bins; ++k) {
    const Real re = up[2 * k], im = up[2 * k + 1], twin_re = down[-2 * k], twin_im = down[-2 * k + 1];
    const Real a_re = re + twin_re, a_im = im - twin_im, b_re = im + twin_im, b_im = twin_re - re;
    power_a[k] = static_cast<float>(Real{0.25} * (a_re * a_re + a_im * a_im));
    power_b[k] = static_cast<float>(Real{0.25} * (b_re * b_re + b_im * b_im));
  }
}

template <class Real>
void unpack_spectra(PackedSpectrum<Real> z, std::span<std::complex<float>> a,
                    std::span<std::complex<float>> b) {
  assert(a.size() == b.size() && a.size() <= z.size() / 2 + 1);
  for (std::size_t k = 0; k < a.size(); ++k) {
    const std::complex<Real> here = z[k], twin = std::conj(z[k == 0 ? 0 : z.size() - k]);
    a[k] = std::complex<float>(Real{0.5} * (here + twin));
    b[k] = std::complex<float>(std::complex<Real>(0, Real{-0.5}) * (here - twin));
  }
}

template void pack_frames<float>(const Frame&, const Frame&, std::span<const float>,
                                 std::span<std::complex<float>>);
template void pack_frames<double>(const Frame&, const Frame&, std::span<const float>,
                                  std::span<std::complex<double>>);
template void unpack_powers<float>(PackedSpectrum<float>, std::span<float>, std::span<float>);
template void unpack_powers<double>(PackedSpectrum<double>, std::span<float>, std::span<float>);
template void unpack_spectra<float>(PackedSpectrum<float>, std::span<std::complex<float>>,
                                    std::span<std::complex<float>>);
template void unpack_spectra<double>(PackedSpectrum<double>, std::span<std::complex<float>>,
                                     std::span<std::complex<float>>);

}  // namespace tacto::spatial
