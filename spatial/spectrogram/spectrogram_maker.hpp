// SPDX-License-Identifier: GPL-3.0-or-later
// Spectrograms row by row, for any number of textures on one grid, through one set of buffers.
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

/// Takes some whole rows, by growing position, from row `first` on: cells by the spectrogram's scaling,
/// `bins` a row. The span is valid during the call.
using CellSink = std::function<schema::Result<void>(std::size_t first, std::span<const float> cells)>;

/// Prepared once, then used for texture after texture; its memory does not grow with their length. Not shared
/// between threads; not safe in the tick.
class SpectrogramMaker {
 public:
  /// `rows` of all textures are expected, about: it decides how well FFTW plans. Errors: of frame_shape().
  static schema::Result<SpectrogramMaker> prepare(const SpectrogramOptions& options, double pitch_m,
                                                  std::size_t rows);

  const FrameShape& shape() const { return shape_; }
  /// The grid it works on, and why it is the whole one where that was not asked for.
  const Decimation& decimation() const { return decimation_; }

  /// All that is said of the texture's spectrogram; the caller fills in `name`. Errors: unsuitable (another
  /// grid than prepared for; shorter than the window, saying what would fit; a value that is not finite, by
  /// sample).
  schema::Result<schema::SpectrogramHeader> describe(const schema::Texture& texture) const;

  /// The cells of a texture that describe() accepts. Errors: the sink's; unsuitable, where a density does not
  /// fit single precision.
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
  std::vector<float> cells_;  // as many rows as go to the sink at once
};

}  // namespace tacto::spatial
