// SPDX-License-Identifier: GPL-3.0-or-later
// Identification of an emulated tray that differs from the model, by the signals that take seconds: multisine
// and chirp, with noise of its own in every sample of a draw; the noise is estimated from the periods.
#include <gtest/gtest.h>

#include "analysis/identify/fit/response_fit.hpp"
#include "analysis/identify/measure/excitation.hpp"
#include "analysis/identify/measure/response_estimate.hpp"
#include "firmware-host/sim/bench/actuated_tray.hpp"
#include "tests/analysis/identify_plants.hpp"
#include "tests/sanitized.hpp"

namespace tacto::analysis {
namespace {

constexpr double kPeriodicNoiseM = 20e-9;  // the emulated vibrometer's
const int kPeriodicPlants = draws(8, 3), kPeriodicNoises = draws(10, 2);
constexpr double kSecondModeHz = 850;

using PeriodicSignal = PeriodicDrive (*)(const ExcitationPlan&);

schema::Transducer periodic_base() {
  return schema::read_transducer("wiertlewski2011").value();
}

struct PeriodicDraw {
  schema::Transducer truth;
  PeriodicDrive plan;
  DrivenTray tray;  // without noise
};

// Plants like the paper's, driven with 0.3 to 2 V, as in identify_device_test.
std::vector<PeriodicDraw> driven_plants(PeriodicSignal signal, const firmware_host::TrayPhysics& physics,
                                        std::mt19937_64& random) {
  std::uniform_real_distribution<double> amplitude(0.3, 2);
  std::vector<PeriodicDraw> list;
  while (std::ssize(list) < kPeriodicPlants) {
    const schema::Transducer truth = varied(periodic_base(), physics, random);
    const PeriodicDrive plan = signal({.amplitude_v = amplitude(random)});
    firmware_host::ActuatedTray tray(truth, 10e3, physics);
    const std::vector<double> drive(plan.drive_v.begin(), plan.drive_v.end());
    list.push_back({truth, plan, {10e3, drive, firmware_host::displacement_under(tray, drive), 0}});
  }
  return list;
}

BodeData measured_once(const PeriodicDraw& drawn, std::mt19937_64& random) {
  std::normal_distribution<double> normal(0, kPeriodicNoiseM);
  DrivenTray tray = drawn.tray;
  for (double& displacement_m : tray.displacement_m) displacement_m += normal(random);
  return response_of_periods(tray, drawn.plan);
}

struct Told {
  int draws = 0, flagged = 0, modes = 0;
  double least_r_squared = 1;
};

Told told_of(const std::vector<PeriodicDraw>& plants, int noises, std::mt19937_64& random) {
  Told told;
  for (const PeriodicDraw& drawn : plants)
    for (int noise = 0; noise < noises; ++noise, ++told.draws) {
      const ResponseFit fit = fit_response(measured_once(drawn, random), {.open = true}, periodic_base());
      told.flagged += !fit.claims_intervals();
      told.modes += fit.choice.second_mode;
      told.least_r_squared = std::min(told.least_r_squared, fit.r_squared);
    }
  std::printf("  flagged %d of %d, R^2 at least %.4f; a second mode in %d\n", told.flagged, told.draws,
              told.least_r_squared, told.modes);
  return told;
}

class IdentifyPeriodic : public testing::TestWithParam<std::pair<const char*, PeriodicSignal>> {
 protected:
  PeriodicSignal signal() const { return GetParam().second; }
};

TEST_P(IdentifyPeriodic, FindsATrayThatIsTheModel) {
  std::mt19937_64 random(31);
  const Told told = told_of(driven_plants(signal(), {}, random), kPeriodicNoises / 2, random);
  EXPECT_LE(told.flagged, 1);  // three tests, each wrong in 5 of 10,000: 2 of 40 in one run of 600
}

TEST_P(IdentifyPeriodic, FlagsAHysteresisThatNobodyModelled) {
  std::mt19937_64 random(32);
  const auto plants =
      driven_plants(signal(), {.second_mode = {}, .finger_load = {}, .hysteresis = 0.16}, random);
  const Told told = told_of(plants, kPeriodicNoises, random);
  EXPECT_GE(told.flagged, 0.95 * told.draws);
  EXPECT_EQ(told.modes, 0);
  EXPECT_GT(told.least_r_squared, 0.98);  // R^2 alone would not detect the misfit
}

TEST_P(IdentifyPeriodic, ChoosesASecondModeThatIsThere) {
  std::mt19937_64 random(33);
  const auto plants = driven_plants(signal(),
                                    {.second_mode = firmware_host::SecondMode{.frequency_hz = kSecondModeHz},
                                     .finger_load = {},
                                     .hysteresis = 0},
                                    random);
  const Told told = told_of(plants, kPeriodicNoises / 2, random);
  EXPECT_EQ(told.modes, told.draws);
  EXPECT_EQ(told.flagged, 0);
  for (const PeriodicDraw& drawn : plants) {
    const ResponseFit two =
        fit_response(measured_once(drawn, random), {.second_mode = true}, periodic_base());
    EXPECT_FALSE(two.misfit.found) << two.misfit.words;
    EXPECT_NEAR(two.find("second_mode_hz")->value / kSecondModeHz, 1, 0.02);
  }
}

INSTANTIATE_TEST_SUITE_P(Signals, IdentifyPeriodic,
                         testing::Values(std::pair{"multisine", PeriodicSignal(multisine)},
                                         std::pair{"chirp", PeriodicSignal(periodic_chirp)}),
                         [](const auto& tried) { return std::string(tried.param.first); });

}  // namespace
}  // namespace tacto::analysis
