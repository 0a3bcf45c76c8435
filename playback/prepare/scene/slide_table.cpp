// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/prepare/scene/slide_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "playback/prepare/scene/judged_piece.hpp"

namespace tacto::playback {

using schema::PieceSlide;

double stiffest_slide_n_per_m(const schema::Piece& piece, double tick_s) {
  if (!piece.slide) return INFINITY;
  const double without = 4 * piece.slide->mass_kg / (tick_s * tick_s) - 2 * piece.damping_n_s_per_m / tick_s;
  return std::max(0.0, without - detent_stiffness_n_per_m(*piece.slide));
}

schema::Result<core::SlideTable> slide_table(const schema::Piece& piece, double tick_s,
                                             const std::string& where) {
  for (const schema::Piece& end : slider_ends(piece)) {
    const schema::Piece wall = steepest_wall(end);
    const double stiffest = stiffest_slide_n_per_m(wall, tick_s);
    if (wall.stiffness_n_per_m < stiffest) continue;
    return schema::fail(
        schema::ErrorKind::unsuitable,
        fmt::format("piece '{}' is too light for its wall: with {:g} kg and ticks of {:g} s, {:g} "
                    "N/m and {:g} N s/m make its motion grow; below {:.4g} N/m it does not",
                    piece.name, piece.slide->mass_kg, tick_s, wall.stiffness_n_per_m, wall.damping_n_s_per_m,
                    stiffest),
        where + "/slide/mass_kg", "choose more mass, a softer wall, weaker detents or a higher rate");
  }
  const PieceSlide& slide = *piece.slide;
  const auto& d = slide.direction;
  const double size = std::hypot(d[0], d[1], d[2]), by_force = tick_s / slide.mass_kg;
  core::SlideTable table;
  for (std::size_t i = 0; i < 3; ++i) table.axis[i] = static_cast<float>(d[i] / size);
  table.from_m = static_cast<float>(slide.from_m), table.to_m = static_cast<float>(slide.to_m);
  table.speed_by_force_s_per_kg = static_cast<float>(by_force);
  table.kept = static_cast<float>(1 / (1 + by_force * slide.viscous_n_s_per_m));
  table.friction_n = static_cast<float>(slide.friction_n);
  table.detent_n = static_cast<float>(slide.detent_n);
  table.detents_per_m = slide.detent_m > 0 ? static_cast<float>(1 / slide.detent_m) : 0;
  return table;
}

}  // namespace tacto::playback
