// SPDX-License-Identifier: GPL-3.0-or-later
// The picture of textures: force against position, below it the spectrogram with a logarithmic axis, and its
// mean beside it. Several textures are below each other, with common axes and colour scale.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "data-schema/spectrogram/spectrogram.hpp"
#include "data-schema/texture/formants.hpp"
#include "data-schema/texture/texture.hpp"
#include "spatial/picture/draw/axis.hpp"
#include "spatial/picture/draw/heading.hpp"
#include "spatial/picture/figure.hpp"
#include "spatial/picture/heatmap.hpp"
#include "spatial/picture/spectrogram_layout.hpp"

namespace tacto::spatial {

/// One texture, its spectrogram, and formants to draw on it, if any; all must outlive the figure. The
/// spectrogram's name is the title.
struct SpectrogramPanel {
  const schema::Texture* texture = nullptr;
  const schema::Spectrogram* spectrogram = nullptr;
  std::span<const schema::Formant> formants = {};
};

struct SpectrogramPictureOptions {
  /// Lower limit of the frequency axis. Default: a little below the lowest valid band, or 0.1/mm without one.
  std::optional<double> min_frequency_per_m;
  /// Difference between the levels of the brightest and the darkest colour.
  double dynamic_range_db = 60;
};

class SpectrogramFigure : public Figure {
 public:
  /// Precondition: at least one panel.
  explicit SpectrogramFigure(std::vector<SpectrogramPanel> panels, SpectrogramPictureOptions options = {});

  Size page() const override;
  /// Errors: usage (dynamic range not above 0, minimum frequency not below the maximum); unsuitable (textures
  /// of different units, hardly any frequency bins).
  schema::Result<void> draw(Canvas& canvas) const override;

  /// The common axes at the place of panel `panel` on the page, in mm and 1/mm, and the common colour scale.
  Axis positions(std::size_t panel) const;
  Axis frequencies(std::size_t panel) const;
  LevelRange levels() const;
  /// Limits of the frequency axis.
  double lowest_per_m() const;
  double highest_per_m() const;
  /// Whether it can be drawn. Errors: as of draw().
  schema::Result<void> check() const;
  PanelLayout layout(std::size_t panel) const { return panel_layout(panel, heading_heights_); }

 private:
  std::vector<SpectrogramPanel> panels_;
  SpectrogramPictureOptions options_;
  std::vector<Heading> headings_;
  std::vector<double> heading_heights_;
};

}  // namespace tacto::spatial
