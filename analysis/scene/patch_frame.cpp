// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/scene/patch_frame.hpp"

#include <cmath>
#include <numbers>

namespace tacto::analysis {

using spatial::Point;

PatchFrame::PatchFrame(const schema::Patch& patch)
    : centre_m_{patch.x_m, patch.y_m},
      half_width_m_(patch.width_m / 2),
      half_height_m_(patch.height_m / 2),
      cosine_(std::cos(patch.angle_deg * std::numbers::pi / 180)),
      sine_(std::sin(patch.angle_deg * std::numbers::pi / 180)) {}

Point PatchFrame::in_plane(double u_m, double v_m) const {
  return {centre_m_.x + cosine_ * u_m - sine_ * v_m, centre_m_.y + sine_ * u_m + cosine_ * v_m};
}

bool PatchFrame::holds(Point place_m) const {
  const double x = place_m.x - centre_m_.x, y = place_m.y - centre_m_.y;
  return std::abs(cosine_ * x + sine_ * y) <= half_width_m_ &&
         std::abs(cosine_ * y - sine_ * x) <= half_height_m_;
}

std::array<Point, 4> PatchFrame::corners() const {
  return {in_plane(-half_width_m_, half_height_m_), in_plane(half_width_m_, half_height_m_),
          in_plane(half_width_m_, -half_height_m_), in_plane(-half_width_m_, -half_height_m_)};
}

}  // namespace tacto::analysis
