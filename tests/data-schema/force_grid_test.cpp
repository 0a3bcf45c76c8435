// SPDX-License-Identifier: GPL-3.0-or-later
// Forces on a grid from a CSV.
#include "data-schema/scene/force_grid.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>

namespace tacto::schema {
namespace {

Result<ForceGrid> grid_of(const std::string& text) {
  const std::string path = testing::TempDir() + "grid.csv";
  std::ofstream(path) << text;
  return read_force_grid(path);
}

void expect_refused_grid(const std::string& text, const std::string& place, const std::string& word) {
  const auto grid = grid_of(text);
  ASSERT_FALSE(grid) << text;
  EXPECT_EQ(grid.error().kind, ErrorKind::malformed);
  EXPECT_TRUE(grid.error().where.ends_with(place)) << message(grid.error());
  EXPECT_NE(grid.error().what.find(word), std::string::npos) << message(grid.error());
  EXPECT_FALSE(grid.error().remedy.empty());
}

const std::string kNodes =
    "x_m,y_m,fx_n,fy_n\n0,0,1,2\n0.001,0,3,4\n0.002,0,5,6\n0,0.001,7,8\n0.001,0.001,9,10\n";

TEST(ForceGrid, NodesAndColumnsMayBeInAnyOrder) {
  const auto grid = grid_of(
      "\xEF\xBB\xBF# made by "
      "hand\r\nfy_n,x_m,fx_n,y_m\r\n6,0.002,5,0\n\n4,0.001,3,0\n12,0.002,11,0.001\n2,0,1,0\n8,0,7,"
      "0.001\n10,0.001,9,0.001");
  ASSERT_TRUE(grid) << message(grid.error());
  EXPECT_EQ(grid->columns, 3U);
  EXPECT_EQ(grid->rows, 2U);
  EXPECT_DOUBLE_EQ(grid->pitch_m, 0.001);
  EXPECT_EQ(grid->first_x_m, 0);
  EXPECT_EQ(grid->first_y_m, 0);
  EXPECT_EQ(grid->x_n, (std::vector<double>{1, 3, 5, 7, 9, 11}));
  EXPECT_EQ(grid->y_n, (std::vector<double>{2, 4, 6, 8, 10, 12}));
}

TEST(ForceGrid, ALineOfNodesIsAGridOfOneRow) {
  const auto grid = grid_of("x_m,y_m,fx_n,fy_n\n1,5,1,0\n1.5,5,2,0\n2,5,3,0\n");
  ASSERT_TRUE(grid) << message(grid.error());
  EXPECT_EQ(grid->columns, 3U);
  EXPECT_EQ(grid->rows, 1U);
  EXPECT_DOUBLE_EQ(grid->pitch_m, 0.5);
  EXPECT_EQ(grid->first_y_m, 5);
}

// Each gives one error: the file, or its line.
TEST(ForceGrid, BadFilesAreRefusedWithTheirPlace) {
  expect_refused_grid(kNodes, "grid.csv", "it has 5 nodes");
  expect_refused_grid(kNodes + "0,0,1,2\n", "line 7", "twice");
  expect_refused_grid(kNodes + "0.002,0.001,nan,0\n", "line 7", "nan");
  expect_refused_grid(kNodes + "0.002,0.001,1001,0\n", "line 7", "1001");
  expect_refused_grid(kNodes + "0.002,0.001,1\n", "line 7", "cells");
  expect_refused_grid("x_m,y_m,fx_n,fy_n\n0,0,1,1\n0.001,0,1,1\n0.0021,0,1,1\n", "grid.csv", "pitch");
  expect_refused_grid("x_m,y_m,fx_n,fy_n\n0,0,1,1\n0.001,0,1,1\n0,0.002,1,1\n0.001,0.002,1,1\n", "grid.csv",
                      "pitch");
  expect_refused_grid("x_m,y_m,fx_n,fy_n\n0,0,1,1\n", "grid.csv", "one place");
  expect_refused_grid("x_m,y_m,fx_n\n0,0,1\n", "line 1", "fy_n");
  expect_refused_grid("x_mm,y_m,fx_n,fy_n\n0,0,1,1\n", "line 1", "x_mm");
  expect_refused_grid("x_m,y_m,fx_n,fy_n\n", "line 1", "no nodes");
}

TEST(ForceGrid, MoreThanItsMostNodesAreRefused) {
  std::string text = "x_m,y_m,fx_n,fy_n\n";
  for (std::size_t i = 0; i <= kMostForceNodes; ++i) text += fmt::format("{},0,1,1\n", i);
  expect_refused_grid(text, fmt::format("line {}", kMostForceNodes + 2), "more than 1048576");
}

}  // namespace
}  // namespace tacto::schema
