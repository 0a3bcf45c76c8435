// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/picture/heatmap.hpp"

#include <algorithm>
#include <cmath>

#include "spatial/picture/draw/axes.hpp"
#include "spatial/picture/draw/axis.hpp"
#include "spatial/picture/draw/engine.hpp"

namespace tacto::spatial {

void draw_level_bar(Canvas& canvas, const Box& bar, const LevelRange& levels, const std::string& caption) {
  constexpr int kShades = 256;
  const Axis level{AxisScale::linear, levels.low_db, levels.high_db, bar.bottom(), bar.y};
  Pixels shades{1, kShades, {}};
  for (int i = 0; i < kShades; ++i) {
    const double part = 1 - (i + 0.5) / kShades;
    shades.rgb.push_back(level_pixel(std::lerp(levels.low_db, levels.high_db, part), levels));
  }
  canvas.image(bar, shades);
  canvas.frame(bar, {});
  draw_axis(canvas, bar, Side::right, level, ticks_of(level, 6));
  draw_caption(canvas, bar, Side::right, caption, 42);
}

std::uint32_t level_pixel(double level_db, const LevelRange& levels) {
  const auto& engine = drawing_engine();
  const double part = (level_db - levels.low_db) / (levels.high_db - levels.low_db);
  return engine ? (*engine)->shade(std::clamp(part, 0.0, 1.0)) : 0;
}

Colour level_colour(double level_db, const LevelRange& levels) {
  const std::uint32_t rgb = level_pixel(level_db, levels);
  return {(rgb >> 16 & 0xFF) / 255.0, (rgb >> 8 & 0xFF) / 255.0, (rgb & 0xFF) / 255.0};
}

schema::Result<Pixels> heatmap(const schema::Spectrogram& spectrogram, double low_per_m, double high_per_m,
                               const LevelRange& levels, int width, int height) {
  const auto& engine = drawing_engine();
  TACTO_TRY(engine);
  const auto last = static_cast<double>(spectrogram.bins - 1);
  // The level of a cell is decade_db log10(factor cell).
  const LevelReference reference = level_reference(spectrogram);
  HeatmapJob job;
  job.cells = spectrogram.cells;
  job.rows = static_cast<int>(spectrogram.position_m.size());
  job.bins = static_cast<int>(spectrogram.bins);
  job.low_bin = std::min(last, low_per_m / spectrogram.frequency_step_per_m);
  job.high_bin = std::min(last, high_per_m / spectrogram.frequency_step_per_m);
  job.factor = reference.factor;
  job.decade_db = reference.decade_db;
  job.low_db = levels.low_db;
  job.high_db = levels.high_db;
  job.width = width;
  job.height = height;
  return (*engine)->heatmap(job);
}

}  // namespace tacto::spatial
