// SPDX-License-Identifier: GPL-3.0-or-later
// Convolution of an endless signal with a long kernel, in blocks of Fourier transforms (Stockham 1966).
#pragma once

#include <complex>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "spatial/dsp/fourier/fft.hpp"

namespace tacto::spatial {

/// A kernel as the spectrum of its circular form: tap n at index n, tap -n at length - n.
struct KernelSpectrum {
  std::vector<std::complex<double>> bins;  ///< length / 2 + 1
  std::size_t length, reach;               ///< taps -reach ... reach, 2 reach < length
};

/// The spectrum of a symmetric kernel, taps 0 ... reach.
KernelSpectrum kernel_spectrum(std::span<const double> taps, std::size_t length);

class OverlapSave {
 public:
  using Sink = std::function<void(std::span<const double>)>;
  explicit OverlapSave(KernelSpectrum kernel);

  /// Continues the signal, which was 0 before its first value. `sink` receives the values of the convolution
  /// at the signal's own indices, in order and as soon as they are known.
  void push(std::span<const double> values, const Sink& sink);
  /// The signal continues with a constant `level`; outputs values until there are `count` since the start.
  /// Then the object is ready for the next signal.
  void finish(double level, std::size_t count, const Sink& sink);
  void reset();

 private:
  std::size_t hop() const { return kernel_.length - 2 * kernel_.reach; }
  void run_block(std::size_t target, const Sink& sink);

  KernelSpectrum kernel_;
  RealFft fft_;
  std::vector<double> block_, result_;
  std::vector<std::complex<double>> spectrum_;
  std::size_t filled_ = 0, given_ = 0;
};

}  // namespace tacto::spatial
