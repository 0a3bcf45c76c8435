// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/scene/relief_raster.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "playback/render/reference/exact_scene.hpp"

namespace tacto::analysis {
namespace {

using playback::ExactScene;
using playback::PreparedScene;
using spatial::Colour;
using spatial::Point;

// Okabe and Ito's orange and sky blue, pale.
constexpr Colour kSpringTint{0.98, 0.86, 0.62}, kDamperTint{0.72, 0.87, 0.96};
constexpr double kDarkest = 0.26;  // so that a path and letters can be read on it
constexpr int kGreys = 63;         // four tints of them and four colours without a relief: 256

double direction_rad(const schema::Patch& patch, const schema::ForceLayer& layer) {
  double degrees = patch.angle_deg;
  for (const auto& [name, number, changes, whole] : schema::numbers_of(layer))
    if (name == "direction_deg") degrees += number.value;
  return degrees * std::numbers::pi / 180;
}

// The pixels between the outermost corners of a patch.
struct PixelRange {
  int from_column, to_column, from_row, to_row;

  PixelRange(const PixelGrid& grid, const PatchFrame& frame) {
    const auto corners = frame.corners();
    const auto [left, right] = std::ranges::minmax(corners, {}, &Point::x);
    const auto [low, high] = std::ranges::minmax(corners, {}, &Point::y);
    const auto held = [&](double at_m, int count) {
      return static_cast<int>(std::clamp(at_m / grid.pixel_m, 0.0, static_cast<double>(count)));
    };
    from_column = held(left.x - grid.left_m, grid.columns);
    to_column = held(right.x - grid.left_m + grid.pixel_m, grid.columns);
    from_row = held(grid.top_m - high.y, grid.rows);
    to_row = held(grid.top_m - low.y + grid.pixel_m, grid.rows);
  }
};

// Paints the patches from the lowest to the topmost.
class RasterPainter {
 public:
  RasterPainter(const PreparedScene& scene, double rate_hz, const PixelGrid& grid)
      : scene_(scene), rate_hz_(rate_hz), grid_(grid) {
    const auto pixels = static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows);
    for (ReliefRaster* raster : {&topmost_, &added_}) {
      raster->grid = grid;
      raster->acts.resize(pixels);
      raster->force_x_n.resize(pixels);
      raster->force_y_n.resize(pixels);
    }
  }

  void paint(const schema::Patch& patch) {
    const PatchFrame frame(patch);
    const PixelRange range(grid_, frame);
    const bool adds = patch.combine == schema::PatchCombine::add;
    ReliefRaster& raster = adds ? added_ : topmost_;
    if (!adds) each_pixel(range, frame, [&](std::size_t at, Point) { clear(at); });
    for (const schema::ForceLayer& layer : patch.layers) {
      const std::uint8_t acts = acts_of(layer);
      each_pixel(range, frame, [&](std::size_t at, Point) { raster.acts[at] |= acts; });
      if (acts == kActsRelief) add_relief(raster, patch, layer, range, frame);
    }
  }

  ReliefRaster finished() && {
    for (std::size_t at = 0; at < topmost_.acts.size(); ++at) {
      topmost_.acts[at] |= added_.acts[at];
      topmost_.force_x_n[at] += added_.force_x_n[at];
      topmost_.force_y_n[at] += added_.force_y_n[at];
    }
    return std::move(topmost_);
  }

 private:
  void each_pixel(const PixelRange& range, const PatchFrame& frame, auto&& visit) const {
    for (int row = range.from_row; row < range.to_row; ++row)
      for (int column = range.from_column; column < range.to_column; ++column)
        if (const Point place_m = grid_.centre_m(column, row); frame.holds(place_m))
          visit(topmost_.at(column, row), place_m);
  }

  void clear(std::size_t at) {
    topmost_.acts[at] = 0;
    topmost_.force_x_n[at] = topmost_.force_y_n[at] = 0;
  }

  // One pixel per tick across grooves, and as fast along any other direction.
  void add_relief(ReliefRaster& raster, const schema::Patch& patch, const schema::ForceLayer& layer,
                  const PixelRange& range, const PatchFrame& frame) const {
    schema::Patch alone = patch;
    alone.layers = {layer};
    const PreparedScene scene = scene_.with({alone});
    const schema::Device no_limits;
    const ExactScene exact(scene, no_limits, rate_hz_);
    const double across = direction_rad(patch, layer), speed_mps = grid_.pixel_m * rate_hz_;
    const ExactScene::Vector speed{speed_mps * std::cos(across), speed_mps * std::sin(across)};
    each_pixel(range, frame, [&](std::size_t at, Point place_m) {
      const ExactScene::Vector force = exact.force_at({place_m.x, place_m.y}, speed);
      raster.force_x_n[at] += static_cast<float>(force.x);
      raster.force_y_n[at] += static_cast<float>(force.y);
    });
  }

  const PreparedScene& scene_;
  double rate_hz_;
  PixelGrid grid_;
  ReliefRaster topmost_, added_;
};

double full_force_n(const ReliefRaster& raster) {
  std::vector<float> forces_n;
  for (std::size_t at = 0; at < raster.acts.size(); ++at)
    if ((raster.acts[at] & kActsRelief) != 0)
      forces_n.push_back(std::hypot(raster.force_x_n[at], raster.force_y_n[at]));
  if (forces_n.empty()) return 0;
  const auto exceeded = forces_n.begin() + static_cast<std::ptrdiff_t>(forces_n.size() * 9 / 10);
  std::ranges::nth_element(forces_n, exceeded);
  return std::max(double{*exceeded}, 0.1 * double{*std::max_element(exceeded, forces_n.end())});
}

}  // namespace

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

std::uint8_t acts_of(const schema::ForceLayer& layer) {
  return layer.visit([](const schema::SpringLayer& /*spring*/) { return kActsSpring; },
                     [](const schema::BodyLayer& /*body*/) { return kActsSpring; },
                     [](const schema::LassoLayer& /*lasso*/) { return kActsSpring; },
                     [](const schema::DamperLayer& /*damper*/) { return kActsDamper; },
                     [](const schema::MoverLayer& /*mover*/) { return kActsDamper; },
                     [](const auto& /*relief*/) { return kActsRelief; });
}

ReliefRaster relief_raster(const PreparedScene& scene, double rate_hz, const PixelGrid& grid,
                           const std::function<void(double)>& progress) {
  RasterPainter painter(scene, rate_hz, grid);
  std::size_t painted = 0;
  for (auto patch = scene.patches.rbegin(); patch != scene.patches.rend(); ++patch) {
    painter.paint(*patch);
    if (progress) progress(static_cast<double>(++painted) / static_cast<double>(scene.patches.size()));
  }
  ReliefRaster raster = std::move(painter).finished();
  raster.full_n = full_force_n(raster);
  return raster;
}

double hill_shade(double force_x_n, double force_y_n, double full_n) {
  if (!(full_n > 0)) return kLightZ;
  const double x = force_x_n / full_n, y = force_y_n / full_n;
  return std::max(0.0, (kLightX * x + kLightY * y + kLightZ) / std::sqrt(1 + x * x + y * y));
}

std::uint32_t acting_colour(std::uint8_t acts, double shade) {
  Colour colour{1, 1, 1};
  const auto multiply = [&](const Colour& tint) {
    colour.red *= tint.red, colour.green *= tint.green, colour.blue *= tint.blue;
  };
  if ((acts & kActsRelief) != 0) {
    const double grey = kDarkest + (1 - kDarkest) * std::round(shade * (kGreys - 1)) / (kGreys - 1);
    multiply({grey, grey, grey});
  }
  if ((acts & kActsSpring) != 0) multiply(kSpringTint);
  if ((acts & kActsDamper) != 0) multiply(kDamperTint);
  const auto part = [](double value) { return static_cast<std::uint32_t>(std::lround(255 * value)); };
  return part(colour.red) << 16 | part(colour.green) << 8 | part(colour.blue);
}

spatial::Pixels shaded(const ReliefRaster& raster) {
  spatial::Pixels pixels{raster.grid.columns, raster.grid.rows, {}};
  pixels.rgb.reserve(raster.acts.size());
  for (std::size_t at = 0; at < raster.acts.size(); ++at)
    pixels.rgb.push_back(
        acting_colour(raster.acts[at],
                      hill_shade(double{raster.force_x_n[at]}, double{raster.force_y_n[at]}, raster.full_n)));
  return pixels;
}

}  // namespace tacto::analysis
