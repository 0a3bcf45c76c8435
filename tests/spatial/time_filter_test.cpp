// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/texture/time_filter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "spatial/dsp/filter/butterworth.hpp"
#include "spatial/texture/block_time_filter.hpp"
#include "tests/bench/workload.hpp"

namespace tacto::spatial {
namespace {

std::complex<double> twice(double) {
  return 2;
}

std::vector<double> fed_in_chunks(BlockTimeFilter& filter, std::span<const double> values, std::size_t size) {
  std::vector<double> out;
  for (; !values.empty(); values = values.subspan(std::min(size, values.size())))
    EXPECT_TRUE(filter.push(values.first(std::min(size, values.size())), out));
  filter.finish(out);
  return out;
}

TEST(BlockTimeFilter, GivesByEveryMethodWhatTheWholeStretchGives) {
  const auto force = bench::workload(4).force_n;
  for (const auto method : {FilterMethod::fourier, FilterMethod::butterworth, FilterMethod::none})
    for (const auto edges : {Edges::treated, Edges::none})
      for (const bool equalised : {false, true}) {
        const TimeFilter how{method, {15, 500}, edges, 3};
        const SpectralGain gain = equalised ? twice : SpectralGain{};
        const auto whole = filter_in_time(force, 10000, how, gain);
        auto fed = BlockTimeFilter::open(10000, how, gain);
        ASSERT_TRUE(whole && fed);
        ASSERT_EQ(whole->size(), force.size());
        for (int again = 0; again < 2; ++again) {
          const auto chunked = fed_in_chunks(*fed, force, 777);
          ASSERT_EQ(chunked.size(), force.size());
          for (std::size_t i = 0; i < force.size(); ++i)
            ASSERT_NEAR(chunked[i], (*whole)[i], 1e-12) << name_of(method) << name_of(edges) << i;
        }
      }
}

TEST(BlockTimeFilter, EqualisesAfterAButterworthFilter) {
  const auto force = bench::workload(4).force_n;
  const TimeFilter how{FilterMethod::butterworth, {15, 500}, Edges::treated, 4};
  const auto plain = filter_in_time(force, 10000, how), doubled = filter_in_time(force, 10000, how, twice);
  ASSERT_TRUE(plain && doubled);
  for (std::size_t i = 0; i < force.size(); ++i) ASSERT_NEAR((*doubled)[i], 2 * (*plain)[i], 1e-9);
}

TEST(FilterInTime, NamesTheValueThatIsNoNumber) {
  auto force = bench::workload(1).force_n;
  force[1234] = std::numeric_limits<double>::quiet_NaN();
  for (const auto method : {FilterMethod::fourier, FilterMethod::butterworth, FilterMethod::none}) {
    const auto filtered = filter_in_time(force, 10000, {method, {15, 500}, Edges::treated, 4});
    ASSERT_FALSE(filtered);
    EXPECT_EQ(filtered.error().kind, schema::ErrorKind::unsuitable);
    EXPECT_NE(filtered.error().what.find("1234"), std::string::npos);
  }
  force[1234] = std::numeric_limits<double>::infinity();
  auto fed = BlockTimeFilter::open(10000, {});
  std::vector<double> out;
  EXPECT_TRUE(fed->push(std::span(force).first(1000), out));
  const auto refused = fed->push(std::span(force).subspan(1000), out);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().what.find("1234"), std::string::npos);
}

}  // namespace
}  // namespace tacto::spatial
