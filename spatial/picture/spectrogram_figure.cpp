// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/picture/spectrogram_figure.hpp"

#include <algorithm>
#include <cmath>

#include "spatial/picture/draw/canvas.hpp"
#include "spatial/picture/spectrogram_panel.hpp"
#include "spatial/spectrogram/spectrogram_summary.hpp"

namespace tacto::spatial {

using schema::ErrorKind;
using schema::Result;

SpectrogramFigure::SpectrogramFigure(std::vector<SpectrogramPanel> panels, SpectrogramPictureOptions options)
    : panels_(std::move(panels)), options_(options) {
  for (const SpectrogramPanel& panel : panels_) {
    headings_.push_back(panel_heading(*panel.texture, *panel.spectrogram));
    heading_heights_.push_back(headings_.back().height());
  }
}

Size SpectrogramFigure::page() const {
  return page_of(heading_heights_);
}

double SpectrogramFigure::highest_per_m() const {
  double highest = 0;
  for (const auto& panel : panels_)
    highest = std::max(highest, panel.spectrogram->frequency_per_m(panel.spectrogram->bins - 1));
  return highest;
}

double SpectrogramFigure::lowest_per_m() const {
  if (options_.min_frequency_per_m) return *options_.min_frequency_per_m;
  double lowest = INFINITY;
  for (const auto& panel : panels_) lowest = std::min(lowest, lowest_of_interest_per_m(*panel.texture));
  return lowest_shown_per_m(lowest, *panels_.front().spectrogram);
}

Result<void> SpectrogramFigure::check() const {
  if (!(std::isfinite(options_.dynamic_range_db) && options_.dynamic_range_db > 0))
    return schema::fail(ErrorKind::usage, "the dynamic range must be above 0 dB", "dynamic range",
                        "60dB is the default");
  for (const auto& panel : panels_)
    if (panel.spectrogram->unit != panels_.front().spectrogram->unit)
      return schema::fail(ErrorKind::unsuitable, "its unit differs from the first texture's",
                          panel.spectrogram->name, "draw only textures of one quantity on a page");
  if (!(lowest_per_m() > 0))
    return schema::fail(ErrorKind::usage, "the minimum frequency must be above 0", "minimum frequency",
                        "the axis is logarithmic");
  if (!(lowest_per_m() * 1.5 < highest_per_m()))
    return schema::fail(ErrorKind::unsuitable, "the frequency axis is too short for a picture",
                        "frequency axis", "raise the maximum frequency or lower the minimum");
  return {};
}

Axis SpectrogramFigure::positions(std::size_t panel) const {
  double low = INFINITY;
  double high = -INFINITY;
  for (const auto& each : panels_) {
    low = std::min(low, 1e3 * each.texture->signal.origin_m);
    high = std::max(high, 1e3 * (each.texture->signal.origin_m + each.texture->signal.length_m()));
  }
  return position_axis(low, high, layout(panel).heat);
}

Axis SpectrogramFigure::frequencies(std::size_t panel) const {
  return frequency_axis(1e-3 * lowest_per_m(), 1e-3 * highest_per_m(), layout(panel).heat);
}

LevelRange SpectrogramFigure::levels() const {
  constexpr double kStep = 5;
  double highest = -INFINITY;
  for (const auto& panel : panels_) {
    const auto peak = strongest_peak(*panel.spectrogram, lowest_per_m());
    highest = std::max(highest, level_db(peak.cell, level_reference(*panel.spectrogram)));
  }
  const double top = std::isfinite(highest) ? kStep * std::ceil(highest / kStep) : 0;
  return {top - options_.dynamic_range_db, top};
}

Result<void> SpectrogramFigure::draw(Canvas& canvas) const {
  if (auto checked = check(); !checked) return checked;
  const LevelRange shared = levels();
  for (std::size_t i = 0; i < panels_.size(); ++i) {
    PanelPainter painter{canvas,
                         *panels_[i].texture,
                         *panels_[i].spectrogram,
                         headings_[i],
                         layout(i),
                         positions(i),
                         frequencies(i),
                         shared,
                         panels_[i].formants};
    if (auto drawn = painter.paint(); !drawn) return drawn;
  }
  return {};
}

}  // namespace tacto::spatial
