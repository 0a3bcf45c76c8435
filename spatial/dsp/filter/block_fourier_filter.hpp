// SPDX-License-Identifier: GPL-3.0-or-later
// The treated Fourier band-pass of a record of any length, fed in chunks.
#pragma once

#include <complex>
#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "spatial/dsp/filter/band.hpp"

namespace tacto::spatial {

/// A complex gain at a frequency in Hz, for positive frequencies; negative ones take its conjugate.
using SpectralGain = std::function<std::complex<double>(double frequency_hz)>;

/// How far its kernel reaches either way, in periods of the band's lowest frequency.
inline constexpr double kBandKernelPeriods = 200;

/// What it gives is the convolution of the record, gone on beyond its ends (ExtendedRecord), with the ideal
/// band-pass kernel under a window (band_kernel) that ends at 200 periods of the lowest frequency: 13.3 s for
/// 15 Hz, and edges 0.2 Hz wide. (Over 65 times from the lowest to the highest frequency it ends at 32768
/// samples of a rate between 2.5 and 5 times the highest; from 0 Hz, at half of that.) It is computed at that
/// lower rate, to which half-band filters take the record and from which they take it back.
///
/// Error against the same convolution summed directly in long double: 5e-7 of the RMS of what passes, under a
/// drift 100 times as large (block_fourier_filter_test); on the bare-finger recording 1e-7. With a gain, what
/// lies later in its impulse response than the kernel and a quarter is left out: 2e-5 for a resonance at 200
/// Hz of quality 10.
///
/// Chunks may have any size and change nothing, not a bit. Lag: the kernel and a block, for 15 to 500 Hz 39 s
/// together. Memory: 10 MB for 15 to 500 Hz at 10 kHz (measured over 3.6 h), with what it gives at a time;
/// twice that at most, and 16 periods of the lowest frequency. Not shared between threads.
class BlockFourierFilter {
 public:
  /// 0 <= band.low_hz < band.high_hz, sample_rate_hz > 0. `longest` promises that no record has more values:
  /// shorter blocks then do.
  BlockFourierFilter(double sample_rate_hz, Band band, const SpectralGain& gain = {},
                     std::size_t longest = static_cast<std::size_t>(-1));
  BlockFourierFilter(BlockFourierFilter&&) noexcept;
  BlockFourierFilter& operator=(BlockFourierFilter&&) noexcept;
  ~BlockFourierFilter();

  /// The record goes on; appends to `out` the filtered values that are known, in order.
  void push(std::span<const double> values, std::vector<double>& out);
  /// The record ends: appends the rest, so that as many came out as went in. The next record may begin.
  void finish(std::vector<double>& out);
  /// Forgets the record that was begun.
  void reset();
  /// Half the length of its kernel, without a gain.
  double reach_s() const;

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace tacto::spatial
