// SPDX-License-Identifier: GPL-3.0-or-later
// The short-time Fourier transform of a long signal, two rows at a time, in bounded memory.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "data-schema/base/error.hpp"
#include "spatial/dsp/fourier/packed_fft.hpp"
#include "spatial/dsp/resample/decimation.hpp"
#include "spatial/dsp/resample/decimator.hpp"

namespace tacto::spatial {

/// Rows `row` and, unless it is the last of an odd number, `row + 1`. The stored spectra are to be multiplied
/// by 2^exponent, powers by 4^exponent.
class PackedRows {
 public:
  using Spectrum = std::variant<PackedSpectrum<float>, PackedSpectrum<double>>;
  PackedRows(std::size_t row_, bool two_, int exponent_, Spectrum spectrum)
      : row(row_), two(two_), exponent(exponent_), spectrum_(spectrum) {}

  std::size_t row;
  bool two;
  int exponent;

  /// As unpack_powers() and unpack_spectra(); the second row is undefined if there is only one.
  void powers(std::span<float> a, std::span<float> b) const;
  void spectra(std::span<std::complex<float>> a, std::span<std::complex<float>> b) const;

 private:
  Spectrum spectrum_;
};
using PackedRowSink = std::function<schema::Result<void>(const PackedRows&)>;

/// X[p, k] = gain sum_n w_n (x[p hop + n] - mean_p) exp(-2 pi i k n / padded), n < window, k < bins.
/// In single precision. The transforms are in double precision on a coarser grid, where they are short, and
/// if all rows together take only about 0.05 s. The signal is processed in blocks of a few windows. First the
/// level of a block is subtracted (before decimation also its straight trend, which the filter would pass
/// anyway), and a power of two scales its magnitude to about 1. So |X - X_exact| / max |X| over all cells (of
/// all frequencies) is at most -120 dB. Not shared between threads; not safe in the tick.
class ShortTimeTransform {
 public:
  /// `window`: the shape's weights; `detrend`: subtract mean_p, otherwise it is 0. `rows`: the expected
  /// number, for planning (packed_fft.hpp). Throws bad_alloc.
  ShortTimeTransform(const FrameShape& shape, const Decimation& decimation, std::span<const double> window,
                     double gain, bool detrend, std::size_t rows);

  /// Number of whole windows in a signal: 0 if it is shorter than one.
  std::size_t rows_of(std::size_t samples) const;
  /// Computes every row of the signal by increasing position. Errors: the sink's, which end the computation.
  schema::Result<void> transform(std::span<const double> signal, const PackedRowSink& sink);

 private:
  struct Block {
    std::size_t first_row = 0, rows = 0;
    std::size_t start = 0, length = 0;  // samples
    double level = 0, slope = 0;        // of the line that is subtracted: at the start, and per sample
    int exponent = 0;
  };
  Block block_at(std::span<const double> signal, std::size_t first_row, std::size_t rows) const;
  void load(std::span<const double> signal, const Block& block);
  void find_means(std::span<const double> signal, const Block& block);
  Frame frame(const Block& block, std::size_t row) const;
  template <class Real>
  schema::Result<void> transform_block(PackedFft<Real>& fft, const Block& block, const PackedRowSink& sink);

  FrameShape shape_;
  Decimation decimation_;
  bool detrend_;
  std::size_t rows_per_block_;
  std::vector<float> window_;
  std::optional<Decimator> decimator_;
  std::variant<PackedFft<float>, PackedFft<double>> fft_;
  std::vector<float> samples_;  // the block's, with the decimator's reach on both sides
  std::vector<double> means_;   // of the block's rows
};

}  // namespace tacto::spatial
