// SPDX-License-Identifier: GPL-3.0-or-later
// Plants far from any preset, in closed form with noise: no false minimum, and no more misfits than the level
// of the tests.
#include <gtest/gtest.h>

#include <cstdio>

#include "analysis/identify/fit/plausibility.hpp"
#include "analysis/identify/fit/response_fit.hpp"
#include "tests/analysis/identify_plants.hpp"
#include "tests/sanitized.hpp"

namespace tacto::analysis {
namespace {

const int kAnywhereDraws = draws(1000, 50);

// All parameters are set, so that no preset's value is used.
struct AnywherePlant {
  double gain = 20e-6, resonance_hz = 547.7, damping = 0.45, pole_hz = 62;
  Direction direction = Direction::actuator;

  std::complex<double> at(double hz) const {
    const double r = hz / resonance_hz;
    const std::complex<double> pole(1, hz / pole_hz), mode(1 - r * r, 2 * damping * r);
    const std::complex<double> above(0, -hz / pole_hz);
    return (direction == Direction::actuator ? 1.0 : above) * gain / (pole * mode);
  }
};

double drawn(double low, double high, std::mt19937_64& random) {
  return low * std::pow(high / low, std::uniform_real_distribution<double>()(random));
}

AnywherePlant any_plant(Direction direction, std::mt19937_64& random) {
  const double gain = direction == Direction::actuator ? 20e-6 : 25;
  return {gain * drawn(0.5, 2, random), drawn(200, 900, random), drawn(0.001, 2, random),
          drawn(20, 300, random), direction};
}

BodeData table_of(const AnywherePlant& plant, double sigma, bool noise_column, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  BodeData data;
  data.direction = plant.direction;
  data.source = "closed form";
  data.table_in_degrees = true;
  data.frequency_hz = octaves(10, 1000, 60);
  for (const double hz : data.frequency_hz) {
    const double real = sigma * normal(random);
    data.response.push_back(plant.at(hz) + std::complex<double>(real, sigma * normal(random)));
    if (noise_column) data.noise.push_back(sigma);
  }
  return data;
}

template <class Response>
double left_by(const BodeData& data, Response response) {
  double sum = 0;
  for (std::size_t i = 0; i < data.size(); ++i)
    sum += std::norm((data.response[i] - response(i)) / data.noise[i]);
  return sum;
}

struct AnywhereTally {
  int misfits = 0, oscillating = 0;
  int gain = 0, resonance = 0, damping = 0, pole = 0;  // covered
};

bool covers(const ResponseFit& fit, std::size_t parameter, double truth) {
  const FittedParameter& p = fit.parameters[parameter];
  return p.low <= truth && truth <= p.high;
}

// With three real poles no response determines which is which: only the residual is compared.
void count(const AnywherePlant& plant, const ResponseFit& fit, AnywhereTally& tally) {
  tally.misfits += fit.misfit.found;
  if (!fit.claims_intervals() || plant.damping >= 0.9) return;
  ++tally.oscillating;
  tally.gain += covers(fit, kGain, plant.gain);
  tally.resonance += covers(fit, kResonance, plant.resonance_hz);
  tally.damping += covers(fit, kDamping, plant.damping);
  tally.pole += covers(fit, kPole, plant.pole_hz);
}

struct Tables {
  const char* name;
  Direction direction;
  bool noise_column;
  int most_misfits;
};

class IdentifyAnywhere : public testing::TestWithParam<Tables> {};

TEST_P(IdentifyAnywhere, FindsTheLeastMinimumAndCallsNoPlantAMisfit) {
  std::mt19937_64 random(2028);
  const schema::Transducer base = schema::read_transducer("wiertlewski2011").value();
  AnywhereTally tally;
  for (int draw = 0; draw < kAnywhereDraws; ++draw) {
    const AnywherePlant plant = any_plant(GetParam().direction, random);
    const BodeData data =
        table_of(plant, plant.gain * drawn(3e-4, 3e-3, random), GetParam().noise_column, random);
    const ModelChoice choice{.direction = plant.direction};
    ASSERT_TRUE(check_bode(data) && check_units(data, choice, base) && check_phases(data, choice, base));
    const ResponseFit fit = fit_response(data, choice, base);
    EXPECT_TRUE(fit.converged) << fit.ended;
    // A fit with a larger residual than the truth has missed the global minimum.
    EXPECT_LE(left_by(fit.data, [&](auto i) { return fit.modelled[i]; }),
              left_by(fit.data, [&](auto i) { return plant.at(data.frequency_hz[i]); }))
        << plant.resonance_hz << " Hz, " << plant.damping << ", " << plant.pole_hz << " Hz";
    count(plant, fit, tally);
  }
  EXPECT_LE(tally.misfits, GetParam().most_misfits);
  std::printf("  misfits: %d of %d\n", tally.misfits, kAnywhereDraws);
  // 95 % +- 3.5 standard deviations of some 890 draws (0.73 %).
  for (const int covered : {tally.gain, tally.resonance, tally.damping, tally.pole}) {
    const double percent = 100.0 * covered / tally.oscillating;
    std::printf("  covered in %.1f %% of %d\n", percent, tally.oscillating);
    EXPECT_TRUE(sanitized() || (percent >= 92.4 && percent <= 97.1)) << percent;
  }
}

// With known noise, misfit_of() makes three tests at 5 in 10,000 each: 1.5 of 1,000 expected, more than 8 in
// 2e-4 of runs; otherwise two: 1 expected, more than 6 in 8e-5 (binomial).
INSTANTIATE_TEST_SUITE_P(Tables, IdentifyAnywhere,
                         testing::Values(Tables{"ActuatorWithNoise", Direction::actuator, true, 8},
                                         Tables{"ActuatorWithoutNoise", Direction::actuator, false, 6},
                                         Tables{"SensorWithNoise", Direction::sensor, true, 8},
                                         Tables{"SensorWithoutNoise", Direction::sensor, false, 6}),
                         [](const auto& about) { return std::string(about.param.name); });

}  // namespace
}  // namespace tacto::analysis
