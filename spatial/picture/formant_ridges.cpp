// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/picture/formant_ridges.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace tacto::spatial {
namespace {

const Pen kOutline{{0.05, 0.05, 0.08, 0.85}, 2.2};
const Pen kRidge{{1, 1, 1}, 1.0};
constexpr Colour kLabelGround{0.05, 0.05, 0.08, 0.62};
const TextStyle kLabel{.size = 8, .colour = {1, 1, 1}, .align_x = 0, .align_y = 0.5};
constexpr double kPadding = 2;

bool overlap(const Box& a, const Box& b) {
  return a.x < b.right() && b.x < a.right() && a.y < b.bottom() && b.y < a.bottom();
}

bool within(const Box& inner, const Box& outer) {
  return inner.x >= outer.x && inner.right() <= outer.right() && inner.y >= outer.y &&
         inner.bottom() <= outer.bottom();
}

// Places each label above its ridge's strongest point, or below it, where it does not overlap another label.
class Labels {
 public:
  Labels(Canvas& canvas, const Box& area) : canvas_(canvas), area_(area) {}

  void add(Point at, const std::string& text) {
    const Size size = canvas_.text_size(text, kLabel);
    const Box box{std::clamp(at.x - size.width / 2 - kPadding, area_.x,
                             std::max(area_.x, area_.right() - size.width - 2 * kPadding)),
                  0, size.width + 2 * kPadding, size.height};
    for (const double y : {at.y - 4 - box.height, at.y + 4}) {
      const Box place{box.x, y, box.width, box.height};
      const bool taken = std::ranges::any_of(taken_, [&](const Box& other) { return overlap(place, other); });
      if (taken || !within(place, area_)) continue;
      canvas_.fill(place, kLabelGround);
      canvas_.text({place.x + kPadding, place.y + place.height / 2}, text, kLabel);
      taken_.push_back(place);
      return;
    }
  }

 private:
  Canvas& canvas_;
  Box area_;
  std::vector<Box> taken_;
};

std::vector<Point> points_of(const schema::Formant& formant, const Axis& position, const Axis& frequency) {
  std::vector<Point> points;
  for (const auto& point : formant.track)
    points.push_back({position.place(1e3 * point.position_m), frequency.place(1e-3 * point.frequency_per_m)});
  return points;
}

}  // namespace

void draw_ridge(Canvas& canvas, std::span<const Point> points) {
  canvas.polyline(points, kOutline);
  canvas.polyline(points, kRidge);
}

void draw_formants(Canvas& canvas, const Box& area, std::span<const schema::Formant> formants,
                   const Axis& position, const Axis& frequency, std::size_t labels) {
  canvas.clip(area);
  for (const schema::Formant& formant : formants) draw_ridge(canvas, points_of(formant, position, frequency));
  canvas.release();
  Labels placed(canvas, area);
  for (const schema::Formant& formant : formants.first(std::min(labels, formants.size())))
    placed.add(
        {position.place(1e3 * formant.peak_position_m), frequency.place(1e-3 * formant.frequency_per_m)},
        fmt::format("{:.3g}/mm", 1e-3 * formant.frequency_per_m));
}

}  // namespace tacto::spatial
