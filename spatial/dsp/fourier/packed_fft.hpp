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
/// Real is float or double. Error of the whole spectrum (root of the sum of squares), for lengths to 2^16:
/// about 2e-7 of it in single precision, 4e-16 in double.
template <class Real>
class PackedFft {
 public:
  /// `expected` is the number of transforms. A measured plan in the user's cache (fft_wisdom.hpp) is used if
  /// there is one. Otherwise a plan is measured and stored there if that takes no longer than the transforms;
  /// otherwise FFTW estimates one. Plans differ by rounding only. Throws bad_alloc.
  PackedFft(std::size_t length, std::size_t expected);
  PackedFft(PackedFft&&) noexcept;
  PackedFft& operator=(PackedFft&&) noexcept;
  ~PackedFft();

  std::size_t length() const;
  /// Zeros at first; transform() does not change it.
  std::span<std::complex<Real>> input();
  /// Of the last transform().
  std::span<const std::complex<Real>> output() const;
  void transform();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Whether the measurement of a plan saves time for so many transforms: it takes 0.05 s + 16 us per sample on
/// the machine of tests/MEASURED.md, and the transforms must take longer than that.
bool measuring_saves_time(std::size_t length, std::size_t expected);

/// Whether so many transforms take at most about 0.05 s, so that double precision, which takes twice as long,
/// is acceptable.
bool is_short_job(std::size_t length, std::size_t expected);

}  // namespace tacto::spatial
