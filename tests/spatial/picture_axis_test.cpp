// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "spatial/picture/draw/axis.hpp"
#include "spatial/picture/draw/display_unit.hpp"
#include "spatial/picture/trace.hpp"

namespace tacto::spatial {
namespace {

std::vector<std::string> labels_of(const std::vector<Tick>& ticks) {
  std::vector<std::string> labels;
  for (const Tick& tick : ticks)
    if (!tick.label.empty()) labels.push_back(tick.label);
  return labels;
}

TEST(Axis, PlacesEndsAndMiddles) {
  const Axis linear{AxisScale::linear, -2, 2, 100, 0};
  EXPECT_DOUBLE_EQ(linear.place(-2), 100);
  EXPECT_DOUBLE_EQ(linear.place(0), 50);
  const Axis logarithmic{AxisScale::logarithmic, 0.1, 10, 0, 200};
  EXPECT_DOUBLE_EQ(logarithmic.place(1), 100);
  EXPECT_NEAR(logarithmic.value(150), std::sqrt(10.0), 1e-12);
}

TEST(Axis, TicksAreRound) {
  using Labels = std::vector<std::string>;
  EXPECT_EQ(labels_of(ticks_of({AxisScale::linear, 0, 91.4, 0, 1}, 10)),
            (Labels{"0", "10", "20", "30", "40", "50", "60", "70", "80", "90"}));
  EXPECT_EQ(labels_of(ticks_of({AxisScale::linear, -0.05, 0.05, 0, 1}, 5)),
            (Labels{"\u22120.04", "\u22120.02", "0.00", "0.02", "0.04"}));
}

TEST(Axis, LogarithmicTicksCoverEachDecade) {
  const auto ticks = ticks_of({AxisScale::logarithmic, 0.26, 15, 0, 1}, 6);
  EXPECT_EQ(labels_of(ticks), (std::vector<std::string>{"0.5", "1", "2", "5", "10"}));
  EXPECT_EQ(ticks.size(), 17U);  // 0.3 ... 0.9, 1 ... 9, 10
}

TEST(Axis, RoomyAxisHoldsItsData) {
  for (const auto& [low, high] :
       {std::pair{-0.013, 0.021}, {3.0, 3.0}, {0.0, 0.0}, {-1e-9, 2e-9}, {1e6, 1e6 + 1}}) {
    const Axis axis = roomy_axis(low, high);
    EXPECT_LT(axis.low, low);
    EXPECT_GT(axis.high, high);
    EXPECT_LT(axis.low, axis.high);
    const auto ticks = ticks_of(axis, 5);
    EXPECT_GE(ticks.size(), 3U) << low;
    std::set<std::string> different;
    for (const Tick& tick : ticks) different.insert(tick.label);
    EXPECT_EQ(different.size(), ticks.size()) << low;
  }
}

// For a million samples, no column loses its extremes: a single spike is kept.
TEST(Trace, KeepsSpikes) {
  std::vector<double> x(1'000'000);
  std::vector<double> y(x.size(), 0.0);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = static_cast<double>(i);
  y[123457] = 7;
  y[765432] = -7;
  const Axis x_axis{AxisScale::linear, 0, 1e6, 0, 500};
  const Axis y_axis{AxisScale::linear, -10, 10, 100, 0};
  const auto pieces = trace(x, y, x_axis, y_axis);
  ASSERT_EQ(pieces.size(), 1U);
  EXPECT_LE(pieces[0].size(), 4U * 1001U);
  const auto [top, bottom] = std::ranges::minmax(pieces[0], {}, &Point::y);
  EXPECT_DOUBLE_EQ(top.y, y_axis.place(7));
  EXPECT_NEAR(top.x, x_axis.place(123457), 1e-9);
  EXPECT_DOUBLE_EQ(bottom.y, y_axis.place(-7));
  EXPECT_TRUE(std::ranges::is_sorted(pieces[0], {}, &Point::x));
}

TEST(Trace, StopsWhereValuesAreMissing) {
  const std::vector<double> x = {0, 1, 2, 3, 4, 5};
  const std::vector<double> y = {0, 1, NAN, NAN, 2, 3};
  const Axis axis{AxisScale::linear, 0, 10, 0, 100};
  const auto pieces = trace(x, y, axis, axis);
  ASSERT_EQ(pieces.size(), 2U);
  EXPECT_EQ(pieces[0].size(), 2U);
  EXPECT_EQ(pieces[1].size(), 2U);
}

TEST(DisplayUnit, TakesThePrefixThatFits) {
  EXPECT_EQ(display_unit("N", 0.3).text, "mN");
  EXPECT_EQ(display_unit("N", 1.2).text, "N");
  EXPECT_EQ(display_unit("N", 1e-4).text, "\u00b5N");
  EXPECT_DOUBLE_EQ(display_unit("m", 5e-6).factor, 1e6);
  EXPECT_EQ(display_unit("m/s^2", 1e-5).text, "m/s\u00b2");
  EXPECT_EQ(typeset("1 um^2 mm"), "1 \u00b5m\u00b2 mm");
}

}  // namespace
}  // namespace tacto::spatial
