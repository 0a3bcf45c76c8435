// SPDX-License-Identifier: GPL-3.0-or-later
// Identification of an emulated tray (integrated equations of motion) that differs from the model: an
// operator of hysteresis, a second mass, a finger. Responses are measured by stepped sine, as `identify`
// does.
#include <gtest/gtest.h>

#include "analysis/identify/fit/response_fit.hpp"
#include "analysis/identify/measure/excitation.hpp"
#include "analysis/identify/measure/response_estimate.hpp"
#include "firmware-host/sim/bench/actuated_tray.hpp"
#include "tests/analysis/identify_plants.hpp"
#include "tests/measured.hpp"
#include "tests/sanitized.hpp"

namespace tacto::analysis {
namespace {

constexpr double kNoiseM = 20e-9;  // the emulated vibrometer's
const int kPlants = draws(8, 3), kNoises = draws(15, 3);

schema::Transducer base() {
  return schema::read_transducer("wiertlewski2011").value();
}

// The response of a tray without noise; `noise` is the effect of 20 nm per sample.
BodeData without_noise(const schema::Transducer& plant, const firmware_host::TrayPhysics& physics,
                       double amplitude_v) {
  const SteppedSine stepped = stepped_sine({.amplitude_v = amplitude_v, .low_hz = 20, .frequencies = 24});
  firmware_host::ActuatedTray tray(plant, 10e3, physics);
  const std::vector<double> drive(stepped.drive_v.begin(), stepped.drive_v.end());
  BodeData data =
      response_of_steps({10e3, drive, firmware_host::displacement_under(tray, drive), 0}, stepped);
  for (std::size_t i = 0; i < data.size(); ++i) {
    const double samples = static_cast<double>(stepped.steps[i].end - stepped.steps[i].settled);
    data.noise[i] = kNoiseM * std::sqrt(2 / samples) / amplitude_v;
  }
  return data;
}

BodeData with_noise(BodeData data, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  for (std::size_t i = 0; i < data.size(); ++i)
    data.response[i] += data.noise[i] * std::complex<double>(normal(random), normal(random));
  return data;
}

struct Drawn {
  schema::Transducer truth;
  BodeData clean;
};

// Plants like the paper's: within a factor of 1.6, as in the coverage test; driven with 0.3 to 2 V.
std::vector<Drawn> plants(const firmware_host::TrayPhysics& physics, std::mt19937_64& random) {
  std::uniform_real_distribution<double> amplitude(0.3, 2);
  std::vector<Drawn> list;
  while (std::ssize(list) < kPlants) {
    const schema::Transducer truth = varied(base(), physics, random);
    list.push_back({truth, without_noise(truth, physics, amplitude(random))});
  }
  return list;
}

const std::vector<Drawn>& with_hysteresis() {
  static std::mt19937_64 random(7);
  static const std::vector<Drawn> list =
      plants({.second_mode = {}, .finger_load = {}, .hysteresis = 0.16}, random);
  return list;
}

TEST(IdentifyDevice, FindsThePapersTrayAsItIs) {
  std::mt19937_64 random(3);
  const ResponseFit fit = fit_response(with_noise(without_noise(base(), {}, 0.5), random), {}, base());
  EXPECT_FALSE(fit.misfit.found) << fit.misfit.words;
  // Five standard errors of 24 frequencies at 20 nm: below 1e-3.
  EXPECT_NEAR(fit.find("resonance_hz")->value / schema::resonance_hz(base()), 1, 1e-3);
  EXPECT_NEAR(fit.find("damping_ratio")->value / schema::damping_ratio(base()), 1, 5e-3);
  EXPECT_NEAR(fit.find("pole_hz")->value / schema::actuator_pole_hz(base()), 1, 5e-3);
  EXPECT_NEAR(fit.find("gain_m_per_v")->value / 20e-6, 1, 1e-3);
}

TEST(IdentifyDevice, FlagsAHysteresisThatNobodyModelled) {
  std::mt19937_64 random(11);
  int flagged = 0, draws = 0, modes = 0, lag = 0;
  double least_r_squared = 1;
  for (const Drawn& drawn : with_hysteresis())
    for (int noise = 0; noise < kNoises; ++noise, ++draws) {
      const ResponseFit fit = fit_response(with_noise(drawn.clean, random), {.open = true}, base());
      flagged += !fit.claims_intervals();
      modes += fit.choice.second_mode;
      lag += fit.choice.lag;
      least_r_squared = std::min(least_r_squared, fit.r_squared);
    }
  std::printf("  flagged %d of %d, R^2 at least %.4f; a lag chosen in %d, a second mode in %d\n", flagged,
              draws, least_r_squared, lag, modes);
  tacto::measured("identify_device.hysteresis_flagged", flagged);
  tacto::measured("identify_device.hysteresis_draws", draws);
  tacto::measured("identify_device.hysteresis_least_r_squared", least_r_squared);
  EXPECT_EQ(modes, 0);  // a second resonance equal to the first does not count
  EXPECT_GE(flagged, 0.95 * draws);
  EXPECT_GT(least_r_squared, 0.98);  // R^2 alone would not detect the misfit
}

TEST(IdentifyDevice, WithALagTheResonanceStays) {
  std::mt19937_64 random(12);
  std::printf("  bias with the lag:  resonance   damping      pole      gain  lag (deg)\n");
  for (const Drawn& drawn : with_hysteresis()) {
    const ResponseFit fit = fit_response(with_noise(drawn.clean, random), {.lag = true}, base());
    const auto bias = [&](const char* name, double value) {
      return 100 * (fit.find(name)->value / value - 1);
    };
    const double resonance = bias("resonance_hz", schema::resonance_hz(drawn.truth));
    std::printf("  %15.3f %% %8.2f %% %8.2f %% %8.2f %%  %8.2f\n", resonance,
                bias("damping_ratio", schema::damping_ratio(drawn.truth)),
                bias("pole_hz", schema::actuator_pole_hz(drawn.truth)),
                bias("gain_m_per_v", std::abs(schema::actuator_response(drawn.truth, 0))),
                57.29578 * fit.find("lag_rad")->value);
    EXPECT_LT(std::abs(resonance), 0.5);  // per cent; the requirement of the issue
  }
}

TEST(IdentifyDevice, ChoosesASecondModeThatIsThere) {
  std::mt19937_64 random(13);
  int chosen = 0, draws = 0;
  for (const Drawn& drawn : plants({.second_mode = firmware_host::SecondMode{.frequency_hz = 850},
                            .finger_load = {},
                            .hysteresis = 0},
                                   random)) {
    for (int noise = 0; noise < kNoises / 3; ++noise, ++draws) {
      const ResponseFit fit = fit_response(with_noise(drawn.clean, random), {.open = true}, base());
      chosen += name_of(fit.choice) == "second mode" && fit.claims_intervals();
    }
    const ResponseFit two = fit_response(with_noise(drawn.clean, random), {.second_mode = true}, base());
    EXPECT_FALSE(two.misfit.found) << two.misfit.words;
    EXPECT_NEAR(two.find("second_mode_hz")->value / 850, 1, 0.02);  // the damping shifts it by less
  }
  std::printf("  chosen %d of %d\n", chosen, draws);
  EXPECT_EQ(chosen, draws);
}

TEST(IdentifyDevice, FindsWhatAFingerAdds) {
  std::mt19937_64 random(5);
  const firmware_host::FingerLoad load;
  const BodeData data = with_noise(
      without_noise(base(), {.second_mode = {}, .finger_load = load, .hysteresis = 0}, 0.5), random);
  const ResponseFit fit = fit_response(data, {.finger = true}, base());
  EXPECT_TRUE(fit.claims_intervals()) << fit.ended << fit.misfit.words;
  // 1 mm/N; damping = stiffness / (2 pi 90 Hz); 1.5 % of the tray's mass. Tolerances: five standard errors.
  EXPECT_NEAR(fit.find("added_stiffness_n_per_m")->value / 1e3, 1, 0.1);
  EXPECT_NEAR(fit.find("added_damping_n_s_per_m")->value / (1e3 / (2 * 3.14159265 * 90)), 1, 0.02);
  EXPECT_NEAR(fit.find("added_mass_kg")->value / (0.015 * 6.8e-3), 1, 0.1);
}

}  // namespace
}  // namespace tacto::analysis
