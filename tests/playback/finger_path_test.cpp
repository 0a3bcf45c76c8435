// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/model/finger_path.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "playback/render/plane_render.hpp"
#include "tests/data-schema/temporary_folder.hpp"

namespace tacto::playback {
namespace {

TEST(FingerPathCsv, TakesItsColumnsByNameWhereverTheyStand) {
  const auto path =
      parse_finger_path("\xEF\xBB\xBFnote,position_m, time_s\r\na,0.001,0\r\nb,+2e-3, 0.5\r\n\r\n", "p.csv");
  ASSERT_TRUE(path) << message(path.error());
  EXPECT_EQ(path->time_s, (std::vector<double>{0, 0.5}));
  EXPECT_EQ(path->position_m, (std::vector<double>{0.001, 0.002}));
}

TEST(FingerPathCsv, DecimalCommasBetweenSemicolonsOrTabs) {
  for (const char* text :
       {"time_s;position_m\n0;-0,5\n0,5;+1,25e-3\n", "time_s\tposition_m\n0\t-0.5\n0,5\t1,25e-3\n"}) {
    const auto path = parse_finger_path(text, "p.csv");
    ASSERT_TRUE(path) << message(path.error());
    EXPECT_EQ(path->time_s, (std::vector<double>{0, 0.5}));
    EXPECT_EQ(path->position_m, (std::vector<double>{-0.5, 1.25e-3}));
  }
}

TEST(FingerPathCsv, AThirdAxisIsFoundHoweverItsColumnIsWritten) {
  const tests::TemporaryFolder folder;
  schema::Device device;
  for (const char* name : {"x", "y", "z"}) device.axes.emplace_back().name = name;
  const std::string file = folder / "hand.csv";
  for (const char* text :
       {"time_s,x_mm,y_mm,z_mm\n0,1,2,3\n1,1,2,3\n", "time_s;x_mm;y_mm;z_mm\n0;1;2;3\n1;1;2;3,0\n",
        "time_s\tx_mm\ty_mm\tz_mm\n0\t1\t2\t3\n1\t1\t2\t3\n",
        "Z (mm), X (mm), Y (mm), Time (s)\n3,1,2,0\n3,1,2,1\n"}) {
    std::ofstream(file) << text;
    const auto paths = read_axis_paths(file, path_axes_of(device, file));
    ASSERT_TRUE(paths) << message(paths.error());
    ASSERT_EQ(paths->size(), 3U) << text;
    EXPECT_EQ((*paths)[2].position_m, (std::vector<double>{3e-3, 3e-3})) << text;
  }
  std::ofstream(file) << "time_s;x_mm;y_mm\n0;1;2\n1;1;2\n";
  EXPECT_EQ(path_axes_of(device, file), (std::vector<std::string>{"x", "y"}));
}

struct Bad {
  const char* text;
  const char* said;
};

class BadFingerPath : public testing::TestWithParam<Bad> {};

TEST_P(BadFingerPath, IsNamedByPlace) {
  const auto path = parse_finger_path(GetParam().text, "p.csv");
  ASSERT_FALSE(path);
  EXPECT_EQ(path.error().kind, schema::ErrorKind::malformed);
  const std::string said = message(path.error());
  EXPECT_NE(said.find(GetParam().said), std::string::npos) << said;
  EXPECT_NE(said.find("p.csv"), std::string::npos) << said;
  EXPECT_EQ(said.find('\n'), std::string::npos) << said;
}

INSTANTIATE_TEST_SUITE_P(
    Each, BadFingerPath,
    testing::Values(
        Bad{"", "empty"}, Bad{"time_s,position_m\n", "at least 2 rows, this one has 0"},
        Bad{"time_s,position_m\n0,0\n", "at least 2 rows, this one has 1"},
        Bad{"time,position_m\n0,0\n1,1\n", "line 1: the column 'time' has no unit of time"},
        Bad{"time_mm,position_m\n0,0\n1,1\n", "line 1: the column 'time_mm' has no unit of time"},
        Bad{"time_s,position_m,position_mm\n0,0,0\n1,1,1\n", "line 1: there are several columns 'position'"},
        Bad{"time_s;position_m\n0;0\n1;1,2,3\n", "'1,2,3' is not a number"},
        Bad{"time_s,position_m\n0;0\n1;1\n", "line 2: the row has 1 fields"},
        Bad{"0,0\n1,1\n", "no column 'time', only 0, 0"},
        Bad{"time_s,position_m\n0,0\n1,abc\n", "line 3, column 2 (position_m): 'abc' is not a number"},
        Bad{"time_s,position_m\n0,0\n1,\n", "line 3, column 2 (position_m): '' is not a number"},
        Bad{"time_s,position_m\n0,0\n1,1mm\n", "'1mm' is not a number"},
        Bad{"time_s,position_m\n0,nan\n1,1\n", "line 2, column 2 (position_m): 'nan' is not finite"},
        Bad{"time_s,position_m\n0,0\ninf,1\n", "line 3, column 1 (time_s): 'inf' is not finite"},
        Bad{"time_s,position_m\n0,0\n1,1\n1,2\n", "line 4, column 1 (time_s): the time does not increase"},
        Bad{"time_s,position_m\n0,0\n1,1,2\n", "line 3: the row has 3 fields, the header 2"},
        Bad{"time_s,position_m\n0,0\n\n1,1\n", "line 3: the row has 1 fields"}));

TEST(FingerPathCsv, TakesTheUnitsOfItsHeader) {
  for (const char* header :
       {"time_ms,position_mm,normal_force_mN", "time (ms),position [mm],normal_force / mN",
        "time_ms,position_mm,normal_force_mn", "Time (ms),Position (mm),Normal force (mN)"}) {
    const auto path = parse_finger_path(std::string(header) + "\n0,2,500\n500,-3.5,250\n", "p.csv");
    ASSERT_TRUE(path) << message(path.error());
    // Two roundings: of the number and of the product with the unit.
    EXPECT_DOUBLE_EQ(path->time_s[1], 0.5) << header;
    EXPECT_DOUBLE_EQ(path->position_m[1], -0.0035) << header;
    ASSERT_EQ(path->normal_force_n.size(), 2U) << header;
    EXPECT_DOUBLE_EQ(path->normal_force_n[0], 0.5) << header;
  }
}

TEST(FingerPath, IsRepeatedFromItsBeginningIfItEndsThere) {
  const FingerPath loop{{1, 1.5, 3}, {0.01, 0.03, 0.01}, {0.1, 0.2, 0.3}};
  const auto thrice = repeated(loop, 3);
  ASSERT_TRUE(thrice);
  EXPECT_EQ(thrice->time_s, (std::vector<double>{1, 1.5, 3, 3.5, 5, 5.5, 7}));
  EXPECT_EQ(thrice->position_m, (std::vector<double>{0.01, 0.03, 0.01, 0.03, 0.01, 0.03, 0.01}));
  EXPECT_EQ(thrice->normal_force_n, (std::vector<double>{0.1, 0.2, 0.3, 0.2, 0.3, 0.2, 0.3}));
}

TEST(FingerPath, IsRepeatedBackAndForthIfItEndsElsewhere) {
  const auto thrice = repeated({{1, 1.5, 3}, {0.01, 0.02, 0.03}, {0.1, 0.2, 0.3}}, 3);
  ASSERT_TRUE(thrice);
  EXPECT_EQ(thrice->time_s, (std::vector<double>{1, 1.5, 3, 4.5, 5, 5.5, 7}));
  EXPECT_EQ(thrice->position_m, (std::vector<double>{0.01, 0.02, 0.03, 0.02, 0.01, 0.02, 0.03}));
  EXPECT_EQ(thrice->normal_force_n, (std::vector<double>{0.1, 0.2, 0.3, 0.2, 0.1, 0.2, 0.3}));
  EXPECT_TRUE(check_finger_path(*thrice));
}

TEST(FingerPath, IsNotRepeatedBeyondTheMemory) {
  const auto many = repeated({{0, 1}, {0, 1}}, std::size_t{1} << 40);
  ASSERT_FALSE(many);
  EXPECT_EQ(many.error().kind, schema::ErrorKind::usage);
}

TEST(FingerPathCsv, AbsentFileIsNotFound) {
  const auto path = read_finger_path("/nowhere/path.csv");
  ASSERT_FALSE(path);
  EXPECT_EQ(path.error().kind, schema::ErrorKind::not_found);
}

TEST(FingerPath, OfASignalHasOneKnotASample) {
  const auto path = finger_path_of({100, 0.5, {1, 2, 4}});
  EXPECT_EQ(path.time_s, (std::vector<double>{0.5, 0.51, 0.52}));
  EXPECT_EQ(path.position_m, (std::vector<double>{1, 2, 4}));
}

TEST(FingerPath, CheckNamesTheKnot) {
  EXPECT_TRUE(check_finger_path({{0, 1}, {0, 1}}));
  EXPECT_FALSE(check_finger_path({{0}, {0}}));
  EXPECT_FALSE(check_finger_path({{0, 1}, {0}}));
  EXPECT_EQ(check_finger_path({{0, 1, 1}, {0, 1, 2}}).error().where, "path, knot 2");
  EXPECT_EQ(check_finger_path({{0, 1}, {0, std::nan("")}}).error().where, "path, knot 1");
}

TEST(FingerPath, AFingerAtRestBetweenKnotsStaysThere) {
  const FingerPath path{{0, 1, 2, 3}, {0, 1, 1, 0}};
  const auto positions = positions_along(path, 100, 301);
  for (std::size_t i = 100; i <= 200; ++i) EXPECT_EQ(positions[i], 1);
  EXPECT_EQ(positions[300], 0);
}

// Against finite differences of the path, 1 us apart: their error is that of the second derivative, below
// 1e-5 of the speed here.
TEST(FingerPath, GreatestSpeedIsTheGreatestSlope) {
  const FingerPath path{{0, 0.1, 0.15, 0.4, 0.6}, {0, 0.01, 0.03, 0.035, -0.02}};
  const auto positions = positions_along(path, 1e6, 600001);
  double greatest = 0;
  for (std::size_t i = 1; i < positions.size(); ++i)
    greatest = std::max(greatest, std::abs(positions[i] - positions[i - 1]) * 1e6);
  EXPECT_NEAR(greatest_speed_mps(path), greatest, 1e-5 * greatest);
}

}  // namespace
}  // namespace tacto::playback
