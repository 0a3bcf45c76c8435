// SPDX-License-Identifier: GPL-3.0-or-later
// Plant and model alike: the intervals say the truth as often as they claim.
#include <gtest/gtest.h>

#include <chrono>
#include <map>
#include <random>

#include "analysis/identify/response_fit.hpp"
#include "tests/analysis/identify_plants.hpp"

namespace tacto::analysis {
namespace {

constexpr int kDraws = 1000;

struct Tally {
  std::map<std::string, int> covered;
  int claimed = 0, misfits = 0, not_converged = 0;
};

void count(const std::string& name, double truth, const ResponseFit& fit, Tally& tally) {
  const FittedParameter* p = fit.find(name);
  ASSERT_NE(p, nullptr);
  tally.covered[name] += p->low <= truth && truth <= p->high;
}

Tally drawn(Direction direction) {
  std::mt19937_64 random(2026);
  const schema::Transducer base = schema::read_transducer("wiertlewski2011").value();
  const bool actuator = direction == Direction::actuator;
  Tally tally;
  for (int draw = 0; draw < kDraws; ++draw) {
    const schema::Transducer plant = varied(base, random);
    const BodeData data = measured(plant, direction, octaves(10, 1000, 60), 0.005, random);
    const ResponseFit fit = fit_response(data, {.direction = direction}, base);
    tally.misfits += fit.misfit.found;
    tally.not_converged += !fit.converged;
    if (!fit.claims_intervals()) continue;
    ++tally.claimed;
    count("resonance_hz", schema::resonance_hz(plant), fit, tally);
    count("damping_ratio", schema::damping_ratio(plant), fit, tally);
    count("pole_hz", actuator ? schema::actuator_pole_hz(plant) : schema::sensor_pole_hz(plant), fit, tally);
    if (actuator) count("gain_m_per_v", std::abs(schema::actuator_response(plant, 0)), fit, tally);
  }
  return tally;
}

class IdentifyCoverage : public testing::TestWithParam<Direction> {};

// 92.5 to 97.1 % is 95 % +- 3.5 standard deviations of 1,000 draws (0.69 %), as the upper end is skewed.
TEST_P(IdentifyCoverage, IntervalsCoverInNineteenOfTwenty) {
  const Tally tally = drawn(GetParam());
  EXPECT_EQ(tally.not_converged, 0);
  EXPECT_LE(tally.misfits, 8);  // three tests at 5 in 10,000: 1.5 expected; more than 8 in 2e-4 of runs
  for (const auto& [name, covered] : tally.covered) {
    const double percent = 100.0 * covered / tally.claimed;
    RecordProperty(name, std::to_string(percent));
    std::printf("  %s: covered in %.1f %% of %d\n", name.c_str(), percent, tally.claimed);
    EXPECT_GE(percent, 92.5) << name;
    EXPECT_LE(percent, 97.1) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(Directions, IdentifyCoverage,
                         testing::Values(Direction::actuator, Direction::sensor));

}  // namespace
}  // namespace tacto::analysis
