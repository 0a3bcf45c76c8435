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
