// SPDX-License-Identifier: GPL-3.0-or-later
// The picture of pieces in space: what is solid in a section, against closed forms, and that it is drawn.
#include "analysis/scene/piece_figure.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tacto::analysis {
namespace {

using schema::Piece;
using schema::PieceShape;

Piece shape_of(PieceShape shape, double size_m) {
  Piece piece;
  piece.name = "a", piece.shape = shape;
  if (shape == PieceShape::plane) piece.thickness_m = size_m;
  if (shape == PieceShape::sphere || shape == PieceShape::cylinder) piece.radius_m = size_m;
  if (shape == PieceShape::quadric) piece.coefficients = {1, 1, 1, 0, 0, 0, 0, 0, 0, -size_m * size_m};
  return piece;
}

// 0.1 mm pixels around the origin.
constexpr PixelGrid kAround{-0.03, 0.03, 1e-4, 600, 600};

double area_mm2(const Piece& piece, std::size_t across, std::array<double, 3> through_m) {
  schema::Scene scene;
  scene.pieces = {piece};
  return 0.01 *
         static_cast<double>(std::ranges::count(solid_in_section(scene, kAround, across, through_m), 0));
}

TEST(PieceFigureTest, SectionsHaveTheAreasOfTheirShapes) {
  const double cut = std::numbers::pi * (20.0 * 20 - 12.0 * 12);  // 12 mm from the centre
  for (const PieceShape round : {PieceShape::sphere, PieceShape::quadric})
    for (std::size_t across = 0; across < 3; ++across) {
      std::array<double, 3> through_m = {};
      through_m[across] = 0.012;
      EXPECT_NEAR(area_mm2(shape_of(round, 0.02), across, through_m) / cut, 1, 2e-3) << across;
      through_m[across] = 0.021;
      EXPECT_EQ(area_mm2(shape_of(round, 0.02), across, through_m), 0) << across;
    }
  // Along z: a disc from above, a strip from the front and from the side.
  const Piece pipe = shape_of(PieceShape::cylinder, 0.01);
  EXPECT_NEAR(area_mm2(pipe, 2, {0, 0, 9}) / (std::numbers::pi * 100), 1, 2e-3);
  EXPECT_NEAR(area_mm2(pipe, 1, {0, 0.006, 0}), 60 * 16, 7);
  EXPECT_NEAR(area_mm2(pipe, 0, {0.006, 0, 0}), 60 * 16, 7);
  const Piece plate = shape_of(PieceShape::plane, 0.005);
  EXPECT_NEAR(area_mm2(plate, 1, {}), 60 * 5, 7);
  EXPECT_NEAR(area_mm2(plate, 2, {0, 0, -0.001}), 60 * 60, 1e-6);
  EXPECT_EQ(area_mm2(plate, 2, {0, 0, 0.001}), 0);
}

// Heights of |u| / 10, with the columns of the map along y: beside the half space, 2 x 30 mm x 3 mm / 2.
TEST(PieceFigureTest, ASectionOfARaisedPlaneFollowsItsHeights) {
  Piece raised = shape_of(PieceShape::plane, 0);
  raised.relief.emplace();
  raised.relief->file = "roof", raised.relief->axes = {{{0, 1, 0}, {1, 0, 0}}};
  schema::HeightMap map;
  map.columns = map.rows = 61, map.pitch_m = 1e-3;
  for (int j = 0; j < 61; ++j)
    for (int i = -30; i <= 30; ++i) map.height_m.push_back(static_cast<float>(std::abs(i)) * 1e-4F);
  schema::Scene scene;
  scene.pieces = {raised};
  const auto area = [&](std::size_t across) {
    return 0.01 * static_cast<double>(std::ranges::count(
                      solid_in_section(scene, kAround, across, {}, {}, {{"roof", map}}), 0));
  };
  EXPECT_NEAR(area(0), 60 * 30 + 90, 7);
  EXPECT_NEAR(area(1), 60 * 30, 7);
}

// A double tetrahedron with corners at 20 mm on each axis: |x| + |y| + |z| < 20 mm.
TEST(PieceFigureTest, SectionsOfAMeshHaveTheAreaOfItsSolid) {
  schema::Mesh mesh;
  mesh.vertices_m = {{0.02, 0, 0}, {-0.02, 0, 0}, {0, 0.02, 0}, {0, -0.02, 0}, {0, 0, 0.02}, {0, 0, -0.02}};
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  schema::Scene scene;
  Piece piece = shape_of(PieceShape::mesh, 0);
  piece.mesh = "octahedron", piece.x_m = 0.002;
  scene.pieces = {piece};
  for (std::size_t across = 0; across < 3; ++across) {
    std::array<double, 3> through_m = {0.002, 0, 0};
    through_m[across] += 0.00503;  // a square with half diagonals of 14.97 mm; no pixel is on its border
    const auto solid = solid_in_section(scene, kAround, across, through_m, {{"octahedron", mesh}});
    // In a quadrant a + b <= 148 for pixels with centres at a + 1/2 and b + 1/2.
    EXPECT_EQ(std::ranges::count(solid, 0), 4 * 149 * 150 / 2) << across;
  }
}

TEST(PieceFigureTest, ASceneIsDrawnThroughTheMiddleOfItsBalls) {
  PiecePicture picture;
  picture.name = "room";
  picture.scene.pieces = {shape_of(PieceShape::plane, 0), shape_of(PieceShape::sphere, 0.01),
                          shape_of(PieceShape::cylinder, 0.01)};
  picture.scene.pieces[1].x_m = 0.02, picture.scene.pieces[2].z_m = 0.04;
  const PieceFigure figure(picture);
  EXPECT_EQ(figure.through_m(), (std::array<double, 3>{0.01, 0, 0.02}));
  EXPECT_TRUE(spatial::to_png(figure));
  picture.device = *schema::read_device("arm");
  picture.through_m = {0.02, 0, 0};
  EXPECT_TRUE(spatial::to_svg(PieceFigure(picture)));
  EXPECT_EQ(PieceFigure(picture).through_m(), *picture.through_m);
}

}  // namespace
}  // namespace tacto::analysis
