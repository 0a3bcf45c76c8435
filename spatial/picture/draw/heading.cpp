// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/picture/draw/heading.hpp"

#include <algorithm>

#include "spatial/picture/draw/fitted_text.hpp"

namespace tacto::spatial {
namespace {

const TextStyle kTitle{.size = 15, .bold = true, .align_y = 0};
const TextStyle kSubtitle{.size = 10, .colour = kGreyInk, .align_y = 0};
const TextStyle kBadge{.size = 10.5, .colour = kAlarm, .bold = true, .align_y = 0};
constexpr double kBadgePadding = 3, kBadgeGap = 12;  // a badge beside the title is within its line
constexpr double kTitleLine = 21, kSubtitleLine = 14, kBadgeLine = 14;
constexpr double kBelowSubtitle = kHeadingHeight - kTitleLine - kSubtitleLine;

double widest(Canvas& canvas, const std::vector<std::string>& lines, const TextStyle& style) {
  double width = 0;
  for (const std::string& line : lines) width = std::max(width, canvas.text_size(line, style).width);
  return width;
}

double badge_height(const Heading& heading) {
  return static_cast<double>(heading.badge.size()) * kBadgeLine + 2 * kBadgePadding;
}

double title_top(const Heading& heading) {
  return heading.badge.empty() || heading.badge_beside ? 0 : badge_height(heading) + 4;
}

void draw_badge(Canvas& canvas, Point top_left, const Heading& heading) {
  if (heading.badge.empty()) return;
  const double width = widest(canvas, heading.badge, kBadge) + 2 * kBadgePadding;
  const double x = heading.badge_beside ? top_left.x + heading.width - width : top_left.x;
  canvas.frame({x, top_left.y, width, badge_height(heading)}, {kAlarm, 1});
  for (std::size_t i = 0; i < heading.badge.size(); ++i)
    canvas.text({x + kBadgePadding, top_left.y + kBadgePadding + static_cast<double>(i) * kBadgeLine},
                heading.badge[i], kBadge);
}

}  // namespace

double Heading::height() const {
  const auto lines = [](const std::vector<std::string>& of) {
    return static_cast<double>(std::max<std::size_t>(1, of.size()));
  };
  return title_top(*this) + lines(title) * kTitleLine + lines(subtitle) * kSubtitleLine + kBelowSubtitle;
}

Heading heading_of(const std::string& title, const std::string& subtitle, const std::string& simulated,
                   double width) {
  Canvas ruler(PictureFormat::png, {1, 1});
  Heading heading;
  heading.width = width;
  heading.title = wrapped(ruler, title, kTitle, width);
  heading.subtitle = wrapped(ruler, subtitle, kSubtitle, width);
  if (simulated.empty()) return heading;
  heading.badge = wrapped(ruler, "SIMULATED: " + simulated, kBadge, width - 2 * kBadgePadding);
  heading.badge_beside = heading.badge.size() == 1 && heading.title.size() == 1 &&
                         widest(ruler, heading.title, kTitle) + kBadgeGap +
                                 widest(ruler, heading.badge, kBadge) + 2 * kBadgePadding <=
                             width;
  return heading;
}

void draw_heading(Canvas& canvas, Point top_left, const Heading& heading) {
  draw_badge(canvas, top_left, heading);
  Point at{top_left.x, top_left.y + title_top(heading)};
  for (const std::string& line : heading.title) {
    canvas.text(at, line, kTitle);
    at.y += kTitleLine;
  }
  if (heading.title.empty()) at.y += kTitleLine;
  for (const std::string& line : heading.subtitle) {
    canvas.text(at, line, kSubtitle);
    at.y += kSubtitleLine;
  }
}

}  // namespace tacto::spatial
