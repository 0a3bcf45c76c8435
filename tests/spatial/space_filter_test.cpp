// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/texture/space_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace tacto::spatial {
namespace {

constexpr double kFilterPitch_m = 1e-6;

// Lines at 0.2, 2 and 20 /mm over 100 mm, and a slope.
std::vector<double> lines(bool all) {
  std::vector<double> values(100000);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double turn = 2 * std::numbers::pi * static_cast<double>(i) * kFilterPitch_m * 1e3;
    values[i] = std::sin(2 * turn);
    if (all) values[i] += std::sin(0.2 * turn) + std::sin(20 * turn) + 1e-4 * static_cast<double>(i);
  }
  return values;
}

TEST(FilterInSpace, KeepsTheLineInItsBand) {
  const auto all = lines(true), expected = lines(false);
  // At least 20 periods of the lowest from an end, where the mirrored line at 0.2 /mm still rings a little;
  // the slope does not. Butterworth's gain at the line is about 1 - 1e-4.
  for (const auto& [method, error] :
       {std::pair{FilterMethod::fourier, 5e-3}, {FilterMethod::butterworth, 1e-2}}) {
    const auto filtered = filter_in_space(all, kFilterPitch_m, {method, 1e3, 4e3});
    ASSERT_TRUE(filtered);
    for (std::size_t i = 20000; i < 80000; ++i) ASSERT_NEAR((*filtered)[i], expected[i], error) << i;
  }
}

TEST(FilterInSpace, SaysWhatCannotBeInCyclesPerMillimetre) {
  const auto values = lines(true);
  const auto refused = [&](double low_per_m, double high_per_m, std::size_t count) {
    const auto filtered = filter_in_space(std::span(values).first(count), kFilterPitch_m,
                                          {FilterMethod::fourier, low_per_m, high_per_m});
    return filtered ? std::string() : filtered.error().what;
  };
  EXPECT_NE(refused(4e3, 1e3, 1000).find("4/mm"), std::string::npos);
  EXPECT_NE(refused(1e3, 6e5, 1000).find("600/mm"), std::string::npos);
  EXPECT_NE(refused(1e2, 1e3, 1000).find("1 mm"), std::string::npos);
  EXPECT_EQ(refused(1e3, 5e3, 1000), "");
}

}  // namespace
}  // namespace tacto::spatial
