// SPDX-License-Identifier: GPL-3.0-or-later
// Real Fourier transforms; the interface to FFTW. Offline use; planning locks a mutex, so it is not safe in
// the tick.
#pragma once

#include <complex>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace tacto::spatial {

// Discrete cosine transforms of a grid. Offline use; planning locks a mutex, so it is not safe in the tick.

/// Rows one after the other.
struct GridSize {
  std::size_t columns = 0, rows = 0;
};

/// In place, X_kl = sum_ij x_ij cos(pi k (i + 1/2) / columns) cos(pi l (j + 1/2) / rows): the spectrum of the
/// grid continued evenly beyond its edges (DCT-II along both axes). The frequency of k is k / (2 columns)
/// cycles per sample.
void to_cosines(std::span<double> values, GridSize size);

/// The inverse: from_cosines(to_cosines(x)) = x. With the first coefficients of another grid, or zeros behind
/// them, times the ratio of the numbers of places, it gives the same continuous surface on this grid.
void from_cosines(std::span<double> values, GridSize size);

/// A planned transform of one length, with its buffers; reuse it for many frames. Not shared between threads.
class RealFft {
 public:
  /// Any length >= 1; products of 2, 3, 5 and 7 are fast.
  explicit RealFft(std::size_t length);
  RealFft(RealFft&&) noexcept;
  RealFft& operator=(RealFft&&) noexcept;
  ~RealFft();

  std::size_t length() const;
  std::size_t bins() const { return length() / 2 + 1; }
  /// X_k = sum_n x_n exp(-2 pi i k n / length); `time` has length(), `spectrum` bins() elements.
  void forward(std::span<const double> time, std::span<std::complex<double>> spectrum);
  /// The inverse, divided by length(): inverse(forward(x)) = x.
  void inverse(std::span<const std::complex<double>> spectrum, std::span<double> time);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The next length >= n that is a product of 2, 3, 5 and 7.
std::size_t fast_length(std::size_t n);

}  // namespace tacto::spatial
