// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/calibrate/travel.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>

#include "capture/record/watch_counts.hpp"
#include "firmware-host/open_device.hpp"
#include "tests/capture/sim_take.hpp"

namespace tacto::capture {
namespace {

using schema::ErrorKind;

TEST(Travel, GoesOnWhereTheCounterWraps) {
  EXPECT_EQ(travelled_counts(2147483000, -2147483000), 1296);
  EXPECT_EQ(travelled_counts(-2147483000, 2147483000), -1296);
  EXPECT_EQ(travelled_counts(-5, 7), 12);
}

// Each end has an error of up to one count: over many travels at random positions the stated interval
// contains the truth.
TEST(Travel, CountsAtTheEndsAreCovered) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> somewhere(0, 1);
  Coverage one, many;
  for (int run = 0; run < 500; ++run) {
    std::vector<double> differences;
    for (int i = 0; i < 10; ++i) {
      const double from = somewhere(random);
      differences.push_back(std::floor(from + 1234.3) - std::floor(from));
    }
    const double truth = 1 / 1234.3;
    one.add(scale_by_travel(std::span(differences).first(1), 1, 0)->scale, truth);
    many.add(scale_by_travel(differences, 1, 0)->scale, truth);
  }
  EXPECT_GT(one.inside(), 0.9);
  EXPECT_GT(many.inside(), 0.93);
  EXPECT_LT(many.rms(), 1.1);
}

// A user who misses the marks by 20 um.
TEST(Travel, ScatterOfTheHandsIsCovered) {
  std::mt19937_64 random(4);
  std::normal_distribution<double> miss(0, 20);
  Coverage coverage;
  for (int run = 0; run < 500; ++run) {
    std::vector<double> differences;
    for (int i = 0; i < 6; ++i)
      differences.push_back((i % 2 == 0 ? 1 : -1) * std::round(50000 + miss(random)));
    const auto found = scale_by_travel(differences, 0.05, 0);
    coverage.add(found->scale, 1e-6);
    EXPECT_EQ(found->direction, 1);
    EXPECT_EQ(found->scale.degrees_of_freedom, 5);
  }
  EXPECT_GT(coverage.inside(), 0.92);
  EXPECT_LT(coverage.inside(), 0.98);
  coverage.print("travel.scale");
}

// The emulated finger moves 35 mm, from 2.5 mm to 37.5 mm; the scale has an error of 0.4 %.
TEST(Travel, TheEmulatedEncodersScaleIsFound) {
  for (const double gain : {1.004, 0.99, 1.0}) {
    Take take = sim_take(fmt::format("surface=flat,strokes=1,encoder_gain={}", gain), 1.5);
    const auto differences = count_differences(take, "position");
    ASSERT_TRUE(differences);
    const auto found = scale_by_travel(*differences, 35e-3, 0);
    ASSERT_TRUE(found) << schema::message(found.error());
    EXPECT_NEAR(found->scale.value, 1e-6 / gain,
                coverage_factor_95(found->scale.degrees_of_freedom) * found->scale.uncertainty);
    EXPECT_LT(found->scale.uncertainty / found->scale.value, 2e-5);
    EXPECT_EQ(found->direction, 1);
  }
}

TEST(Travel, MarksAreTheEndsWhereThereAreSome) {
  Take take;
  take.codes = {{0, 10, 1000, 1010, 20}};
  take.header.channels.resize(1);
  take.header.channels[0].name = "position";
  EXPECT_EQ(*count_differences(take, "position"), std::vector<double>{20});
  take.header.marks = {{1, "mark"}, {2, "mark"}, {4, "mark"}};
  EXPECT_EQ(*count_differences(take, "position"), (std::vector<double>{990, -980}));
  take.header.marks.resize(1);
  EXPECT_EQ(count_differences(take, "position").error().kind, ErrorKind::unsuitable);
  EXPECT_EQ(count_differences(take, "speed").error().kind, ErrorKind::usage);
}

TEST(Travel, AreWatchedWhileTheyAreMade) {
  const auto device = firmware_host::open_device("sim:surface=flat,strokes=2,noise=off");
  int blocks = 0;
  // Blocks of 20 ms: at rest before, between and after the two strokes of 0.82 s each.
  const auto watched = watch_counts(**device, "position", 3, [&]() -> schema::Result<bool> {
    ++blocks;
    return blocks == 2 || blocks == 48 || blocks == 110;
  });
  ASSERT_TRUE(watched) << schema::message(watched.error());
  ASSERT_EQ(watched->counts.size(), 3U);
  EXPECT_NEAR(watched->counts[1] - watched->counts[0], 35000, 1);
  EXPECT_NEAR(watched->counts[2] - watched->counts[1], -35000, 1);
  const auto broken = watch_counts(**device, "position", 1, []() -> schema::Result<bool> {
    return schema::fail(ErrorKind::usage, "nobody presses Enter");
  });
  EXPECT_EQ(broken.error().what, "nobody presses Enter");
}

TEST(Travel, WrongInputsAreNamed) {
  const std::vector<double> good = {1000, -1001}, apart = {1000, 500}, none, still = {3};
  EXPECT_EQ(scale_by_travel(good, 0, 0).error().kind, ErrorKind::usage);
  EXPECT_EQ(scale_by_travel(none, 1, 0).error().kind, ErrorKind::unsuitable);
  EXPECT_EQ(scale_by_travel(still, 1, 0).error().kind, ErrorKind::unsuitable);
  const std::vector<double> coarse = {1000 * 65536.0};  // codes of a converter: its step is the rounding
  EXPECT_NEAR(scale_by_travel(coarse, 1, 0, 65536)->scale.uncertainty * 1000 * 65536,
              std::sqrt(2.0 / 12) / 1000, 1e-9);
  EXPECT_EQ(scale_by_travel(coarse, 1, 0, 65536 * 11).error().kind, ErrorKind::unsuitable);
  EXPECT_NE(scale_by_travel(apart, 1, 0).error().what.find("differ"), std::string::npos);
}

}  // namespace
}  // namespace tacto::capture
