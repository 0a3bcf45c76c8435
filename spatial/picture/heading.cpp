// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/picture/heading.hpp"

#include "spatial/picture/fitted_text.hpp"

namespace tacto::spatial {
namespace {

const TextStyle kTitle{.size = 15, .bold = true, .align_y = 0};
const TextStyle kSubtitle{.size = 10, .colour = kGreyInk, .align_y = 0};
const TextStyle kBadge{.size = 10.5, .colour = kAlarm, .bold = true, .align_x = 1, .align_y = 0};
constexpr double kBadgePadding = 4;

// Gives the width that is left to its left.
double draw_badge(Canvas& canvas, const Box& box, const std::string& simulated) {
  if (simulated.empty()) return box.width;
  const std::string text = fitted(canvas, "SIMULATED: " + simulated, kBadge, 0.5 * box.width);
  const Size size = canvas.text_size(text, kBadge);
  const Box badge{box.right() - size.width - 2 * kBadgePadding, box.y, size.width + 2 * kBadgePadding,
                  size.height + 2 * kBadgePadding};
  canvas.frame(badge, {kAlarm, 1});
  canvas.text({badge.right() - kBadgePadding, badge.y + kBadgePadding}, text, kBadge);
  return badge.x - box.x - 12;
}

}  // namespace

void draw_heading(Canvas& canvas, const Box& box, const std::string& title, const std::string& subtitle,
                  const std::string& simulated) {
  const double left = draw_badge(canvas, box, simulated);
  canvas.text({box.x, box.y}, fitted(canvas, title, kTitle, left), kTitle);
  canvas.text({box.x, box.y + 21}, fitted(canvas, subtitle, kSubtitle, box.width), kSubtitle);
}

}  // namespace tacto::spatial
