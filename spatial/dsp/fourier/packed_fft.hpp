// SPDX-License-Identifier: GPL-3.0-or-later
// Complex Fourier transforms of one length, for two real frames at a time. Offline use.
#pragma once

#include <complex>
#include <cstddef>
#include <memory>
#include <span>

namespace tacto::spatial {

/// A planned transform with its buffers; reuse it for many frames. Not shared between threads.
///   Z_k = sum_n z_n exp(-2 pi i k n / length)
/// Real is float or double; error of the whole spectrum (root of the sum of squares) about 2e-7 of it in
/// single precision, 4e-16 in double, for lengths to 2^16.
template <class Real>
class PackedFft {
 public:
  /// `expected` transforms are to come. Where a measured plan is in the user's cache (fft_wisdom.hpp) it is
  /// taken; else one is measured and kept there, if that takes no longer than the transforms to come would;
  /// else FFTW estimates. Plans differ by rounding only. Throws bad_alloc.
  PackedFft(std::size_t length, std::size_t expected);
  PackedFft(PackedFft&&) noexcept;
  PackedFft& operator=(PackedFft&&) noexcept;
  ~PackedFft();

  std::size_t length() const;
  /// Zeros at first; transform() leaves it as it is.
  std::span<std::complex<Real>> input();
  /// Of the last transform().
  std::span<const std::complex<Real>> output() const;
  void transform();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Whether measuring a plan is worth it for so many transforms: it takes 0.05 s + 16 us a sample on the
/// machine of tests/MEASURED.md, and the transforms themselves must take longer than that.
bool measuring_pays(std::size_t length, std::size_t expected);

/// Whether so many transforms take but a moment, about 0.05 s, so that nobody minds that double precision
/// takes twice as long.
bool take_a_moment(std::size_t length, std::size_t expected);

}  // namespace tacto::spatial
