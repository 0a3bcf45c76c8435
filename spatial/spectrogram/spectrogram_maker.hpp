// SPDX-License-Identifier: GPL-3.0-or-later
// Spectrograms row by row, for any number of textures with one pitch, with one set of buffers.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/spectrogram/spectrogram.hpp"
#include "data-schema/texture/texture.hpp"
#include "spatial/dsp/spectrum/short_time_transform.hpp"
#include "spatial/spectrogram/spectrogram_options.hpp"

namespace tacto::spatial {

/// Receives some whole rows, by increasing position, from row `first` on: cells in the spectrogram's scaling,
/// `bins` per row. The span is valid during the call.
using CellSink = std::function<schema::Result<void>(std::size_t first, std::span<const float> cells)>;

/// Prepared once, then used for texture after texture; its memory does not depend on their length. Not shared
/// between threads; not safe in the tick.
class SpectrogramMaker {
 public:
  /// `rows` is the approximate number of rows of all textures; the effort of FFTW's planning depends on it.
  /// Errors: of frame_shape().
  static schema::Result<SpectrogramMaker> prepare(const SpectrogramOptions& options, double pitch_m,
                                                  std::size_t rows);

  const FrameShape& shape() const { return shape_; }
  /// The decimation in use, and the reason for full resolution if it was not requested.
  const Decimation& decimation() const { return decimation_; }

  /// The header of the texture's spectrogram; the caller sets `name`. Errors: unsuitable (a pitch other than
  /// that of prepare(); shorter than the window, with the length that would fit; a value that is not finite,
  /// with its sample).
  schema::Result<schema::SpectrogramHeader> describe(const schema::Texture& texture) const;

  /// Makes the cells of a texture that describe() accepts. Errors: the sink's; unsuitable, if a density does
  /// not fit single precision.
  schema::Result<void> make(const schema::Texture& texture, const CellSink& sink);

 private:
  SpectrogramMaker(const SpectrogramOptions& options, const FrameShape& shape, const Decimation& decimation,
                   double pitch_m, std::size_t rows);
  void unpack(const PackedRows& rows, std::span<float> a, std::span<float> b) const;
  void finish(std::span<float> row, int exponent) const;

  SpectrogramOptions options_;
  FrameShape shape_;
  Decimation decimation_;
  double pitch_m_;
  ShortTimeTransform transform_;
  std::vector<float> cells_;  // as many rows as are given to the sink at once
};

}  // namespace tacto::spatial
