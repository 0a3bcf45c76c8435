// SPDX-License-Identifier: GPL-3.0-or-later
// The picture of a force scene: its relief against closed forms and the kernel, what covers what, and the
// path of a hand.
#include "analysis/scene/scene_figure.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "firmware-host/core/scene/scene_kernel.hpp"
#include "playback/prepare/scene/scene_device.hpp"
#include "spatial/picture/draw/style.hpp"
#include "tests/playback/unlimited_device.hpp"
#include "tests/spatial/decoded_png.hpp"

namespace tacto::analysis {
namespace {

using schema::Patch;
using spatial::Point;
using spatial::samples::decode_png;
using spatial::samples::DecodedPng;

constexpr double kFigureRateHz = 1000;
constexpr double kFineStep_m = 1e-7;  // of the encoder, far below a pixel

schema::ForceLayer grooved(schema::GrooveProfile profile, double period_m, double depth_m, double kappa_n,
                           double direction_deg, double filter_m) {
  return schema::GroovesLayer{
      profile, {period_m}, {depth_m}, {kappa_n}, {direction_deg}, schema::LayerNumber{filter_m}, {1.5}, ""};
}

Patch square_patch(const std::string& name, double x_m, double y_m, double side_m,
                   std::vector<schema::ForceLayer> layers) {
  Patch patch;
  patch.name = name;
  patch.x_m = x_m, patch.y_m = y_m;
  patch.width_m = patch.height_m = side_m;
  patch.layers = std::move(layers);
  return patch;
}

ScenePicture picture_of(std::vector<Patch> patches) {
  ScenePicture picture;
  picture.name = "bench";
  picture.scene.patches = std::move(patches);
  picture.rate_hz = kFigureRateHz;
  auto prepared = playback::prepare_scene(picture.scene, "bench.scene.json",
                                          playback::unlimited_device(kFineStep_m), kFigureRateHz);
  EXPECT_TRUE(prepared) << message(prepared.error());
  picture.prepared = std::move(*prepared);
  return picture;
}

SceneFigure figure_of(std::vector<Patch> patches) {
  return *SceneFigure::make(picture_of(std::move(patches)));
}

// The pixel of the whole PNG at a place in the plane.
std::uint32_t pixel_at(const DecodedPng& png, const SceneMap& map, Point place_m) {
  const Point at = map.place(place_m);
  return png.at(static_cast<int>(at.x * spatial::kPixelsPerPoint),
                static_cast<int>(at.y * spatial::kPixelsPerPoint));
}

int grey_of(std::uint32_t rgb) {
  EXPECT_EQ(rgb >> 16 & 0xFF, rgb & 0xFF);
  return static_cast<int>(rgb & 0xFF);
}

// h = depth/2 cos(2 pi v / period): the force along v is kappa depth pi / period sin(2 pi v / period), and
// the shade is Lambert's with the normal (0, force / full, 1).
TEST(SceneFigure, ShadesASineByItsClosedForm) {
  constexpr double kPeriod = 0.01, kDepth = 2e-4, kKappa = 3;
  const SceneFigure figure = figure_of({square_patch(
      "sine", 0.003, -0.002, 0.06, {grooved(schema::GrooveProfile::sine, kPeriod, kDepth, kKappa, 90, 0)})});
  const double amplitude_n = kKappa * kDepth * std::numbers::pi / kPeriod;
  // A tenth of the pixels exceed it: those with |sin| > sin(0.9 pi / 2).
  EXPECT_NEAR(figure.raster().full_n, amplitude_n * std::sin(0.9 * std::numbers::pi / 2), 2e-3 * amplitude_n);
  const DecodedPng png = decode_png(*to_png(figure));
  const PixelGrid& grid = figure.map().grid;
  for (int row = grid.rows / 4; row < 3 * grid.rows / 4; ++row) {
    const Point place_m = grid.centre_m(grid.columns / 2, row);
    const double force_n = amplitude_n * std::sin(2 * std::numbers::pi * (place_m.y + 0.002) / kPeriod);
    const double y = force_n / figure.raster().full_n, light_y = std::sin(112.5 * std::numbers::pi / 180);
    const double lambert = std::sqrt(0.5) * (light_y * y + 1) / std::sqrt(1 + y * y);
    // 63 greys, and the rounding to 1/255.
    EXPECT_NEAR(grey_of(pixel_at(png, figure.map(), place_m)), 255 * (0.26 + 0.74 * std::max(0.0, lambert)),
                0.5 * 0.74 * 255 / 62 + 0.51)
        << row;
  }
}

// Independent of the reference in double precision: the kernel of the device, at rest at the same places.
TEST(ReliefRaster, HasTheForcesOfTheKernel) {
  Patch bench = square_patch("bench", 0, 0, 0.02,
                             {grooved(schema::GrooveProfile::square, 0.002, 1e-4, 2, 30, 1e-4),
                              schema::NoiseLayer{{0.003}, {3}, {0.5}, {9}, {1e-4}, {1}, ""}});
  bench.angle_deg = 20;
  Patch plain = square_patch("plain", 0.004, 0.003, 0.006, {schema::DamperLayer{{1}, ""}});
  plain.order = 1;
  Patch more = square_patch("more", -0.004, 0, 0.008,
                            {grooved(schema::GrooveProfile::triangle, 0.001, 5e-5, 1, 90, 1e-4)});
  more.combine = schema::PatchCombine::add;
  const ScenePicture picture = picture_of({bench, plain, more});
  constexpr double kPixel = 2e-5;  // the harmonics of the grooves are below 3/8 of a cycle in a pixel
  const PixelGrid grid{-0.0151, 0.0149, kPixel, 1500, 1500};
  const ReliefRaster raster = relief_raster(picture.prepared, kFigureRateHz, grid);

  const schema::Device device = playback::unlimited_device(kFineStep_m);
  const auto setup = playback::force_setup_of(device, kFigureRateHz);
  const core::SceneView view = picture.prepared.view();
  std::vector<float> live(view.live_words());
  double worst_n = 0, largest_n = 0;
  for (int row = 3; row < grid.rows; row += 29)
    for (int column = 5; column < grid.columns; column += 31) {
      const Point place_m = grid.centre_m(column, row);
      const std::int32_t counts[2] = {static_cast<std::int32_t>(std::lround(place_m.x / 1e-7)),
                                      static_cast<std::int32_t>(std::lround(place_m.y / 1e-7))};
      core::SceneKernel kernel;
      kernel.set(view, *setup, live.data());
      const core::ForceOutput output = kernel.tick(counts, true);
      const std::size_t at = raster.at(column, row);
      worst_n = std::max({worst_n, std::abs(double{output.unlimited_n[0]} - double{raster.force_x_n[at]}),
                          std::abs(double{output.unlimited_n[1]} - double{raster.force_y_n[at]})});
      largest_n =
          std::max(largest_n, std::hypot(double{output.unlimited_n[0]}, double{output.unlimited_n[1]}));
    }
  EXPECT_GT(largest_n, 0.3);
  EXPECT_LT(worst_n,
            2e-6 * largest_n);  // the rounding of single precision, as the kernel states it for noise
}

// What pixels cannot show is left out, and does not become a false pattern.
TEST(ReliefRaster, LeavesOutGroovesThatAreFinerThanItsPixels) {
  for (const double direction_deg : {0.0, 45.0, 90.0, 135.0}) {
    const ScenePicture picture = picture_of({square_patch(
        "fine", 0, 0, 0.02, {grooved(schema::GrooveProfile::sine, 0.0019, 1e-4, 2, direction_deg, 0)})});
    const ReliefRaster raster = relief_raster(picture.prepared, kFigureRateHz, {-0.01, 0.01, 0.001, 20, 20});
    for (std::size_t at = 0; at < raster.acts.size(); ++at)
      EXPECT_TRUE(raster.acts[at] == kActsRelief && raster.force_x_n[at] == 0 && raster.force_y_n[at] == 0);
  }
}

TEST(SceneFigure, TheTopmostPatchCoversAndAnAddedOneDoesNot) {
  const schema::ForceLayer grooves = grooved(schema::GrooveProfile::sine, 0.004, 2e-4, 2, 0, 0);
  Patch bench = square_patch("bench", 0, 0, 0.1, {grooves});
  bench.order = 1;
  Patch hidden = square_patch("hidden", -0.03, 0, 0.02, {schema::DamperLayer{{1}, ""}});
  Patch over = square_patch("over", 0.03, 0, 0.02, {schema::SpringLayer{{50}, {0}, {0}, ""}});
  over.order = 2;
  Patch added = square_patch("added", 0, 0.03, 0.02, {schema::DamperLayer{{1}, ""}});
  added.combine = schema::PatchCombine::add;
  const SceneFigure figure = figure_of({bench, hidden, over, added});
  const ReliefRaster& raster = figure.raster();
  const auto acts = [&](double x_m, double y_m) {
    const PixelGrid& grid = raster.grid;
    return int{raster.acts[raster.at(static_cast<int>((x_m - grid.left_m) / grid.pixel_m),
                                     static_cast<int>((grid.top_m - y_m) / grid.pixel_m))]};
  };
  EXPECT_EQ(acts(0, 0), kActsRelief);
  EXPECT_EQ(acts(-0.03, 0), kActsRelief);
  EXPECT_EQ(acts(0.03, 0.005), kActsSpring);
  EXPECT_EQ(acts(0, 0.03), kActsRelief | kActsDamper);
  EXPECT_EQ(acts(0, 0.0515), 0);
  const DecodedPng png = decode_png(*to_png(figure));
  EXPECT_EQ(pixel_at(png, figure.map(), {0, 0.0515}), 0xFFFFFFU);
  EXPECT_EQ(pixel_at(png, figure.map(), {0.0345, -0.0055}), acting_colour(kActsSpring, 1));
  // The outline of a patch is drawn where it is not covered.
  const auto dark_at = [&](double x_m, double y_m) {
    return (pixel_at(png, figure.map(), {x_m, y_m}) >> 8 & 0xFF) < 60;
  };
  EXPECT_TRUE(dark_at(0.02, -0.005));
  EXPECT_FALSE(dark_at(-0.02, -0.005));
}

TEST(SceneFigure, SvgHasItsWords) {
  Patch patch = square_patch("soup", 0, 0, 0.05,
                             {schema::DamperLayer{{5, schema::SliderRange{1, 9}}, ""},
                              grooved(schema::GrooveProfile::sine, 0.01, 2e-4, 2, 30, 0)});
  const auto svg = to_svg(figure_of({patch}));
  ASSERT_TRUE(svg);
  for (const char* words : {">soup<", ">x (mm)<", ">y (mm)<", ">slider damping 5 N s/m<", ">1 N s/m<",
                            ">9 N s/m<", ">damper: damping 5 N s/m<", ">5 mm<"})
    EXPECT_NE(svg->find(words), std::string::npos) << words;
}

// To and fro on a circle for a million ticks.
TEST(HandPath, DrawsEachPlaceOnceAndKeepsForces) {
  PlaneRange range;
  range.add({-0.1, -0.1});
  range.add({0.1, 0.1});
  const SceneMap map = scene_map(range, {60, 50}, {400, 400});
  HandPath path(map);
  constexpr int kTicks = 1'000'000, kTurns = 20;
  const auto place = [&](int tick) {
    const double angle = 2 * std::numbers::pi * kTurns * tick / kTicks;
    return Point{0.08 * std::cos(angle), 0.08 * std::sin(angle)};
  };
  for (int tick = 0; tick <= kTicks; ++tick) {
    const Point at = place(tick);
    path.add(at, 10 * at.x, -20 * at.y);
  }
  EXPECT_NEAR(path.length_m(), kTurns * 2 * std::numbers::pi * 0.08, 1e-6 * kTurns);
  std::size_t points = 0;
  std::vector<Point> drawn;
  for (const auto& line : path.lines())
    for (const Point at : line) {
      drawn.push_back(at);
      EXPECT_NEAR(std::hypot(1e-3 * map.x.value(at.x), 1e-3 * map.y.value(at.y)), 0.08, 1e-9);
    }
  points = drawn.size();
  const double round = 2 * std::numbers::pi * 0.08 * map.points_per_m();
  EXPECT_LT(static_cast<double>(points),
            6 * round);  // a circle meets about 2.5 cells of half a point in a point
  for (int tick = 0; tick <= kTicks; tick += 997) {
    const Point at = map.place(place(tick));
    const bool near = std::ranges::any_of(
        drawn, [&](Point point) { return std::hypot(point.x - at.x, point.y - at.y) < 0.71; });
    EXPECT_TRUE(near) << tick;
  }
  EXPECT_GT(path.arrows().size(), 30U);
  EXPECT_LE(path.arrows().size(), HandPath::kMostArrows);
  for (const ForceArrow& arrow : path.arrows()) {
    EXPECT_NEAR(arrow.x_n, 10 * 1e-3 * map.x.value(arrow.from.x), 1e-9);
    EXPECT_NEAR(arrow.y_n, -20 * 1e-3 * map.y.value(arrow.from.y), 1e-9);
  }
}

}  // namespace
}  // namespace tacto::analysis
