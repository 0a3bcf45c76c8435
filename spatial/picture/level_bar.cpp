// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/picture/level_bar.hpp"

#include <cmath>

#include "spatial/picture/draw/axes.hpp"
#include "spatial/picture/draw/axis.hpp"

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

}  // namespace tacto::spatial
