// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/spectrogram/spectrogram.hpp"

#include <algorithm>

#include "spatial/spectrogram/spectrogram_maker.hpp"

namespace tacto::spatial {

using schema::Result;
using schema::Spectrogram;

Result<Spectrogram> spatial_spectrogram(const schema::Texture& texture, const SpectrogramOptions& options,
                                        const std::function<void(double)>& progress) {
  const auto shape = frame_shape(options, texture.signal.pitch_m);
  TACTO_TRY(shape);
  auto maker = SpectrogramMaker::prepare(options, texture.signal.pitch_m,
                                         texture.signal.values.size() / shape->hop + 1);
  TACTO_TRY(maker);
  auto header = maker->describe(texture);
  TACTO_TRY(header);
  Spectrogram result{std::move(*header), {}};
  const std::size_t cells = result.position_m.size() * result.bins;
  result.cells.reserve(cells);
  const auto made = maker->make(texture, [&](std::size_t, std::span<const float> rows) -> Result<void> {
    result.cells.insert(result.cells.end(), rows.begin(), rows.end());
    if (progress) progress(static_cast<double>(result.cells.size()) / static_cast<double>(cells));
    return {};
  });
  TACTO_TRY(made);
  return result;
}

}  // namespace tacto::spatial
