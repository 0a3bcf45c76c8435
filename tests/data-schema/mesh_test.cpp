// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes: what is wrong with them, their repair, and their file.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <tuple>
#include <utility>

#include "data-schema/mesh/mesh.hpp"

namespace tacto::schema {
namespace {

Mesh unit_cube() {
  Mesh cube;
  for (const double z : {0.0, 1.0})
    for (const double y : {0.0, 1.0})
      for (const double x : {0.0, 1.0}) cube.vertices_m.push_back({x, y, z});
  cube.triangles = {{4, 5, 7}, {4, 7, 6}, {0, 3, 1}, {0, 2, 3}, {0, 1, 5}, {0, 5, 4},
                    {2, 7, 3}, {2, 6, 7}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return cube;
}

// Each triangle with its own vertices, as in an STL file.
Mesh as_soup(const Mesh& mesh) {
  Mesh soup;
  for (const MeshTriangle& triangle : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(soup.vertices_m.size());
    for (const std::uint32_t vertex : triangle) soup.vertices_m.push_back(mesh.vertices_m[vertex]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}

TEST(MeshTest, FiguresOfACube) {
  const Mesh cube = unit_cube();
  const MeshFigures figures = figures_of(cube);
  EXPECT_DOUBLE_EQ(figures.volume_m3, 1);
  EXPECT_DOUBLE_EQ(figures.longest_edge_m, std::sqrt(2.0));
  EXPECT_EQ(figures.most_m, (MeshVertex{1, 1, 1}));
  EXPECT_TRUE(check_mesh(cube, "m"));
}

TEST(MeshTest, EqualVerticesAreMerged) {
  Mesh soup = as_soup(unit_cube());
  EXPECT_EQ(faults_of(soup).open_edges, 36U);
  merge_equal_vertices(soup);
  EXPECT_EQ(soup.vertices_m.size(), 8U);
  EXPECT_EQ(faults_of(soup).open_edges, 0U);
}

TEST(MeshTest, FaultsAreCountedAndRepaired) {
  Mesh broken = as_soup(unit_cube());
  std::swap(broken.triangles[3][0], broken.triangles[3][1]);
  std::swap(broken.triangles[8][0], broken.triangles[8][1]);
  for (std::size_t i = 0; i < broken.vertices_m.size(); i += 2) broken.vertices_m[i][0] += 1e-8;
  broken.triangles.push_back({0, 0, 1});
  EXPECT_EQ(faults_of(broken).degenerate, 1U);
  EXPECT_FALSE(check_mesh(broken, "m"));
  const MeshRepair done = repair(broken, 1e-6);
  EXPECT_EQ(done.dropped, 1U);
  EXPECT_EQ(done.turned, 2U);
  EXPECT_EQ(broken.vertices_m.size(), 8U);
  const MeshFaults left = faults_of(broken);
  EXPECT_EQ(left.degenerate + left.flipped + left.open_edges, 0U);
  EXPECT_FALSE(left.one_sided || left.inside_out);
  EXPECT_NEAR(figures_of(broken).volume_m3, 1, 1e-6);
}

TEST(MeshTest, FlippedTrianglesInsideOutAndHoles) {
  Mesh flipped = unit_cube();
  std::swap(flipped.triangles[0][0], flipped.triangles[0][1]);
  EXPECT_EQ(faults_of(flipped).flipped, 1U);
  Mesh inside_out = unit_cube();
  for (MeshTriangle& triangle : inside_out.triangles) std::swap(triangle[0], triangle[1]);
  EXPECT_EQ(faults_of(inside_out).flipped, 0U);
  EXPECT_TRUE(faults_of(inside_out).inside_out);
  EXPECT_EQ(repair(inside_out, 0).turned, 12U);
  EXPECT_DOUBLE_EQ(figures_of(inside_out).volume_m3, 1);
  Mesh open = unit_cube();
  open.triangles.pop_back();
  EXPECT_EQ(faults_of(open).open_edges, 3U);
  EXPECT_TRUE(check_mesh(open, "m"));  // holes are a question of the import
}

TEST(MeshTest, TrianglesThatAreThereTwice) {
  for (const bool turned : {false, true}) {  // the same way round, or as the inner side of a double surface
    Mesh twice = unit_cube();
    for (const MeshTriangle& t : unit_cube().triangles)
      twice.triangles.push_back(turned ? MeshTriangle{t[1], t[0], t[2]} : MeshTriangle{t[2], t[0], t[1]});
    const MeshFaults faults = faults_of(twice);
    EXPECT_EQ(faults.doubled, 12U);
    EXPECT_EQ(faults.open_edges + faults.odd_edges + faults.flipped, 0U);
    EXPECT_FALSE(check_mesh(twice, "m"));
    EXPECT_EQ(repair(twice, 0).dropped, 12U);
    Mesh once = unit_cube();
    repair(once, 0);  // its vertices get the same numbers
    EXPECT_EQ(twice.triangles, once.triangles);
    EXPECT_TRUE(check_mesh(twice, "m"));
  }
}

TEST(MeshTest, AnEdgeOfThreeTrianglesIsNoHole) {
  Mesh fin = unit_cube();
  fin.vertices_m.push_back({2, 2, 2});
  fin.triangles.push_back({5, 7, 8});
  EXPECT_EQ(faults_of(fin).odd_edges, 1U);
  EXPECT_EQ(faults_of(fin).open_edges, 2U);
  // Two cubes with a common edge: four triangles, two each way.
  Mesh touching = unit_cube();
  for (const MeshVertex& v : unit_cube().vertices_m)
    touching.vertices_m.push_back({v[0] + 1, v[1] + 1, v[2]});
  for (const MeshTriangle& t : unit_cube().triangles)
    touching.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  merge_equal_vertices(touching);
  EXPECT_EQ(touching.vertices_m.size(), 14U);
  EXPECT_EQ(faults_of(touching).odd_edges + faults_of(touching).open_edges, 0U);
  EXPECT_TRUE(check_mesh(touching, "m"));
}

// A second cube of this size, moved along all axes.
Mesh with_cube(double size, double moved, bool inside_out) {
  Mesh both = unit_cube();
  for (const MeshVertex& v : unit_cube().vertices_m)
    both.vertices_m.push_back({size * v[0] + moved, size * v[1] + moved, size * v[2] + moved});
  for (MeshTriangle t : unit_cube().triangles) {
    if (inside_out) std::swap(t[0], t[1]);
    both.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  }
  return both;
}

TEST(MeshTest, EachBodyAndEachCavityHasItsOuterSide) {
  for (const auto& [size, moved, wrong_if_inside_out, volume] :
       {std::tuple{1.0, 3.0, true, 2.0},
        {0.5, 0.25, false, 0.875},
        {1.0, 0.5, true, 2.0}}) {  // apart, within, overlapping
    EXPECT_EQ(faults_of(with_cube(size, moved, true)).inside_out, wrong_if_inside_out) << moved;
    EXPECT_EQ(faults_of(with_cube(size, moved, false)).inside_out, !wrong_if_inside_out) << moved;
    Mesh wrong = with_cube(size, moved, wrong_if_inside_out);
    EXPECT_EQ(repair(wrong, 0).turned, 12U) << moved;
    EXPECT_FALSE(faults_of(wrong).inside_out) << moved;
    EXPECT_DOUBLE_EQ(figures_of(wrong).volume_m3, volume) << moved;
  }
}

TEST(MeshTest, AMoebiusStripHasNoOuterSide) {
  Mesh strip;
  constexpr std::uint32_t kTurns = 12;
  for (std::uint32_t i = 0; i < kTurns; ++i) {
    const double angle = 6.283185307179586 * i / kTurns, half = angle / 2;
    for (const double side : {-0.3, 0.3}) {
      const double r = 1 + side * std::cos(half);
      strip.vertices_m.push_back({r * std::cos(angle), r * std::sin(angle), side * std::sin(half)});
    }
  }
  for (std::uint32_t i = 0; i < kTurns; ++i) {
    const bool last = i + 1 == kTurns;
    const std::uint32_t a = 2 * i, b = a + 1, c = last ? 1 : a + 2, d = last ? 0 : a + 3;
    strip.triangles.insert(strip.triangles.end(), {{a, c, b}, {b, c, d}});
  }
  EXPECT_TRUE(faults_of(strip).one_sided);
  EXPECT_FALSE(check_mesh(strip, "m"));
}

TEST(MeshTest, AFileIsReadAsItWasWritten) {
  Mesh cube = unit_cube();
  cube.source = "cube.stl", cube.notes = "a note";
  cube.vertices_m[7] = {1.0000001, 1, 1};
  const std::string path = testing::TempDir() + "mesh_test.mesh.nc";
  ASSERT_TRUE(write_mesh(path, cube, Existing::replace));
  const auto read = read_mesh(path);
  ASSERT_TRUE(read) << message(read.error());
  EXPECT_EQ(read->vertices_m, cube.vertices_m);
  EXPECT_EQ(read->triangles, cube.triangles);
  EXPECT_EQ(read->source, "cube.stl");
  EXPECT_EQ(read->notes, "a note");
  EXPECT_TRUE(is_mesh(path));
  EXPECT_EQ(read_mesh(testing::TempDir() + "no_such").error().kind, ErrorKind::not_found);
  cube.vertices_m[0] = {-100, 0, 0};
  EXPECT_EQ(check_mesh(cube, "m").error().kind, ErrorKind::unsuitable);
}

// A file in micrometres that is taken for one in millimetres, and the other way round.
TEST(MeshTest, OneThatIsTooSmallOrTooLargeIsRefused) {
  for (const auto& [size_m, fits] :
       {std::pair{2e-3, true}, {1e-6, true}, {0.9e-6, false}, {10.0, true}, {10.1, false}}) {
    Mesh mesh = unit_cube();
    for (auto& vertex : mesh.vertices_m)
      for (double& place_m : vertex) place_m *= size_m;
    const auto checked = check_mesh(mesh, "m");
    EXPECT_EQ(checked.has_value(), fits) << size_m;
    if (!checked) EXPECT_EQ(checked.error().kind, ErrorKind::unsuitable);
  }
}

}  // namespace
}  // namespace tacto::schema
