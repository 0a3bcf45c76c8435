// SPDX-License-Identifier: GPL-3.0-or-later
// The Fourier band-pass with treated ends for a record of any length, fed in chunks.
#pragma once

#include <complex>
#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "spatial/dsp/filter/band.hpp"

namespace tacto::spatial {

/// A complex gain at a frequency in Hz, for positive frequencies; negative ones have its conjugate.
using SpectralGain = std::function<std::complex<double>(double frequency_hz)>;

/// Half length of its kernel, in periods of the band's lowest frequency.
inline constexpr double kBandKernelPeriods = 200;

/// The result is the convolution of the record, continued beyond its ends (ExtendedRecord), with the ideal
/// band-pass kernel under a window (band_kernel) that ends at 200 periods of the lowest frequency: 13.3 s for
/// 15 Hz, and edges 0.2 Hz wide. (If the highest frequency is over 65 times the lowest, it ends at 32768
/// samples of a rate between 2.5 and 5 times the highest; from 0 Hz, at half of that.) The convolution is
/// computed at that lower rate; half-band filters convert the record to it and back.
///
/// Error against the same convolution summed directly in long double: 5e-7 of the RMS of the output, under a
/// drift 100 times as large (block_fourier_filter_test); on the bare-finger recording 1e-7. The part of a
/// gain's impulse response beyond 1.25 times the kernel is omitted: 2e-5 for a resonance at 200 Hz of quality
/// 10.
///
/// Chunks may have any size, which does not change a single bit. Lag: the kernel and a block, together 39 s
/// for 15 to 500 Hz. Memory, including the output of one call: 10 MB for 15 to 500 Hz at 10 kHz (measured
/// over 3.6 h); at most twice that, and 16 periods of the lowest frequency. Not shared between threads.
class BlockFourierFilter {
 public:
  /// 0 <= band.low_hz < band.high_hz, sample_rate_hz > 0. Precondition: no record has more than `longest`
  /// values; shorter blocks are then sufficient.
  BlockFourierFilter(double sample_rate_hz, Band band, const SpectralGain& gain = {},
                     std::size_t longest = static_cast<std::size_t>(-1));
  BlockFourierFilter(BlockFourierFilter&&) noexcept;
  BlockFourierFilter& operator=(BlockFourierFilter&&) noexcept;
  ~BlockFourierFilter();

  /// Continues the record and appends to `out` the filtered values that are ready, in order.
  void push(std::span<const double> values, std::vector<double>& out);
  /// Ends the record and appends the rest, so that there are as many output as input values. The next record
  /// may begin.
  void finish(std::vector<double>& out);
  /// Discards the current record.
  void reset();
  /// Half the length of its kernel, without a gain.
  double reach_s() const;

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace tacto::spatial
