// SPDX-License-Identifier: GPL-3.0-or-later
// The parts of the fit against closed forms, and its refusals.
#include <gtest/gtest.h>

#include <cstdio>
#include <numbers>

#include "analysis/identify/fit/least_squares.hpp"
#include "analysis/identify/fit/plausibility.hpp"
#include "analysis/identify/fit/response_fit.hpp"
#include "analysis/identify/measure/hold.hpp"
#include "analysis/identify/report/identification.hpp"
#include "firmware-host/sim/bench/actuated_tray.hpp"
#include "tests/analysis/identify_plants.hpp"
#include "tests/sanitized.hpp"

namespace tacto::analysis {
namespace {

schema::Transducer preset() {
  return schema::read_transducer("wiertlewski2011").value();
}

BodeData exact(const schema::Transducer& t, Direction direction = Direction::actuator) {
  std::mt19937_64 random(1);
  BodeData data = measured(t, direction, octaves(10, 1000, 60), 1e-12, random);
  data.noise.clear();
  return data;
}

TEST(IdentifyFit, ClosedFormComesBack) {
  std::mt19937_64 random(4);
  for (int draw = 0; draw < 20; ++draw) {
    const schema::Transducer truth = varied(preset(), random);
    const ResponseFit fit = fit_response(exact(truth), {}, preset());
    ASSERT_TRUE(fit.converged) << fit.ended;
    // Noise of 1e-12, times the condition number (below 20).
    EXPECT_NEAR(fit.transducer.mass_kg / truth.mass_kg, 1, 1e-8);
    EXPECT_NEAR(fit.transducer.damping_n_s_per_m / truth.damping_n_s_per_m, 1, 1e-8);
    EXPECT_NEAR(fit.transducer.amplifier_resistance_ohm / truth.amplifier_resistance_ohm, 1, 1e-8);
    EXPECT_NEAR(fit.transducer.actuator_scale / truth.actuator_scale, 1, 1e-8);
    EXPECT_LT(fit.condition, 50);
  }
}

const ModelChoice kOpen{.open = true};

BodeData delayed(BodeData data, double delay_s) {
  for (std::size_t i = 0; i < data.size(); ++i)
    data.response[i] *= std::polar(1.0, -2 * std::numbers::pi * data.frequency_hz[i] * delay_s);
  return data;
}

std::string said_of(const ResponseFit& fit) {
  return fit.choice_words + "; " + fit.ended + "; " + fit.misfit.words;
}

TEST(IdentifyFit, ADelayIsChosen) {
  for (const double delay_s : {50e-6, 1e-3, -0.2e-3}) {
    std::mt19937_64 random(5);
    const BodeData data = measured(preset(), Direction::actuator, octaves(10, 1000, 60), 0.005, random);
    const ResponseFit fit = fit_response(delayed(data, delay_s), kOpen, preset());
    ASSERT_EQ(name_of(fit.choice), "delay") << said_of(fit);
    EXPECT_TRUE(fit.claims_intervals()) << said_of(fit);
    // 0.5 % of noise at 60 frequencies up to 1 kHz: about 0.2 us.
    EXPECT_NEAR(1e-3 * fit.find("delay_ms")->value, delay_s, 2e-6);
    EXPECT_NEAR(fit.find("resonance_hz")->value / schema::resonance_hz(preset()), 1, 0.005);
  }
}

// The paper's filter, and one beyond the band, against the closed form.
TEST(IdentifyFit, AReconstructionFilterIsChosenAndStored) {
  for (const double cutoff_hz : {600.0, 250.0, 1500.0}) {
    std::mt19937_64 random(6);
    schema::Transducer plant = preset();
    plant.reconstruction_cutoff_hz = cutoff_hz;
    const BodeData data = measured(plant, Direction::actuator, octaves(10, 1000, 60), 0.002, random);
    const ResponseFit fit = fit_response(data, kOpen, preset());
    ASSERT_EQ(name_of(fit.choice), "filter") << said_of(fit);
    EXPECT_TRUE(fit.claims_intervals()) << said_of(fit);
    ASSERT_TRUE(fit.transducer.reconstruction_cutoff_hz);
    EXPECT_NEAR(*fit.transducer.reconstruction_cutoff_hz / cutoff_hz, 1, 0.01);
    EXPECT_NEAR(schema::resonance_hz(fit.transducer) / schema::resonance_hz(plant), 1, 0.005);
  }
}

// A second mode and a delay, drawn at random.
struct ModeAndDelay {
  double mode_hz = 0, delay_s = 0;
};

BodeData with_mode_and_delay(ModeAndDelay& drawn, bool noise_column, std::mt19937_64& random) {
  std::uniform_real_distribution<double> even;
  schema::Transducer plant = varied(preset(), random);
  drawn = {700 + 250 * even(random), (even(random) < 0.5 ? 50e-6 : 300e-6) * (0.7 + 0.6 * even(random))};
  const double apart = even(random) < 0.5 ? 0.9 : 1.1;
  plant.second_mode = schema::ModeAbove{drawn.mode_hz, 0.02, apart * drawn.mode_hz, 0.02};
  BodeData data = measured(plant, Direction::actuator, octaves(10, 1000, 60), 0.005, random);
  if (!noise_column) data.noise.clear();
  return delayed(std::move(data), drawn.delay_s);
}

// A fit of one of them is distorted by the other: a delay alone was wrong by 40 us, a mode alone left a tenth
// of the squares, or the residuals were accepted as uneven noise.
TEST(IdentifyFit, ADelayAndASecondModeAreChosenTogether) {
  for (const bool noise_column : {true, false}) {
    std::mt19937_64 random(5);
    for (int draw = 0; draw < draws(10, 1); ++draw) {
      ModeAndDelay drawn;
      const BodeData data = with_mode_and_delay(drawn, noise_column, random);
      const ResponseFit fit = fit_response(data, kOpen, preset());
      ASSERT_EQ(name_of(fit.choice), "second mode, delay") << draw << ": " << said_of(fit);
      // With 0.5 % of noise the error of the delay is 0.5 us beside one mode, about 2 us beside two.
      EXPECT_NEAR(1e3 * fit.find("delay_ms")->value, 1e6 * drawn.delay_s, 8) << draw;
      const double first = fit.find("resonance_hz")->value, second = fit.find("second_mode_hz")->value;
      EXPECT_NEAR(std::max(first, second) / drawn.mode_hz, 1, 0.02) << draw;
    }
  }
}

// Noise adds no parameters: the rate is printed. Two standard errors are exceeded in 1e-5 of cases for one
// linear parameter; for a mode of any frequency in more.
TEST(IdentifyFit, OneModeStaysOneMode) {
  for (const bool noise_column : {true, false}) {
    std::mt19937_64 random(7);
    const int count = draws(8, 2);
    int larger = 0, misfits = 0;
    for (int draw = 0; draw < count; ++draw) {
      BodeData data =
          measured(varied(preset(), random), Direction::actuator, octaves(10, 1000, 60), 0.005, random);
      if (!noise_column) data.noise.clear();
      const ResponseFit fit = fit_response(data, kOpen, preset());
      larger += name_of(fit.choice) != name_of({});
      misfits += fit.misfit.found;
      EXPECT_EQ(fit.tried.size(), 9U);
    }
    std::printf("  %s column of noise: a larger model in %d of %d, a misfit in %d\n",
                noise_column ? "with" : "no", larger, count, misfits);
    EXPECT_EQ(larger, 0);
    EXPECT_EQ(misfits, 0);
  }
}

// Uneven noise stays noise, although a mode or a delay can reduce its residuals.
TEST(IdentifyFit, UnevenNoiseIsNoModeAndNoDelay) {
  std::mt19937_64 random(6);
  std::normal_distribution<double> normal;
  for (int draw = 0; draw < draws(10, 2); ++draw) {
    BodeData data =
        measured(varied(preset(), random), Direction::actuator, octaves(10, 1000, 60), 0.003, random);
    for (std::size_t i = 30; i < 50; ++i)
      data.response[i] *= 1.0 + 0.02 * std::complex<double>(normal(random), normal(random));
    data.noise.clear();
    const ResponseFit fit = fit_response(data, kOpen, preset());
    EXPECT_TRUE(fit.evenness.uneven) << draw;
    EXPECT_EQ(name_of(fit.choice), "one mode") << draw << ": " << said_of(fit);
  }
}

TEST(IdentifyFit, ASensorComesBack) {
  std::mt19937_64 random(6);
  const schema::Transducer truth = varied(preset(), random);
  const ResponseFit fit =
      fit_response(exact(truth, Direction::sensor), {.direction = Direction::sensor}, preset());
  EXPECT_NEAR(fit.transducer.sensor_scale / truth.sensor_scale, 1, 1e-8);
  EXPECT_NEAR(fit.transducer.sensor_resistance_ohm / truth.sensor_resistance_ohm, 1, 1e-8);
  EXPECT_NEAR(fit.transducer.mass_kg / truth.mass_kg, 1, 1e-8);
  EXPECT_EQ(fit.transducer.actuator_scale, preset().actuator_scale);
}

TEST(IdentifyFit, WhatTheBandDoesNotShowIsHeldAndSaid) {
  schema::Transducer fast = preset();
  fast.amplifier_resistance_ohm = 0.01;  // a pole at 10 MHz has no effect up to 1 kHz
  std::mt19937_64 random(8);
  const BodeData data = measured(fast, Direction::actuator, octaves(10, 1000, 60), 0.005, random);
  const ResponseFit fit = fit_response(data, {}, fast);
  ASSERT_TRUE(fit.find("pole_hz")->held);
  EXPECT_NEAR(fit.find("resonance_hz")->value / schema::resonance_hz(fast), 1, 0.005);
  ASSERT_FALSE(fit.notes.empty());
  EXPECT_NE(fit.notes.front().find("pole_hz"), std::string::npos);
}

// The sum over images against the integrated tray with a held drive.
TEST(IdentifyFit, TheHoldIsWhatTheIntegratedTrayShows) {
  const schema::Transducer t = preset();
  const double rate_hz = 4e3, hz = 800;
  firmware_host::ActuatedTray tray(t, rate_hz);
  std::complex<double> drive = 0, answer = 0;
  for (int i = 0; i < 8000; ++i) {
    const double v = 0.5 * std::sin(2 * 3.14159265358979323846 * hz * i / rate_hz);
    const double x = tray.tick(v);
    if (i < 4000) continue;
    const auto turn = std::polar(1.0, -2 * 3.14159265358979323846 * hz * i / rate_hz);
    drive += v * turn, answer += x * turn;
  }
  const auto held = schema::actuator_response(t, hz) *
                    hold_factor([&](double f) { return schema::actuator_response(t, f); }, hz, rate_hz);
  // The integration is exact to 1e-6; images beyond the third are (3 fs / f)^-4 = 2e-5 of the fundamental.
  EXPECT_LT(std::abs(answer / drive / held - 1.0), 5e-5);
}

TEST(IdentifyFit, NonNegativeLeastSquaresKeepsToItsSide) {
  // Columns e1, e1 + e2, e3 free: for b = (1, -1, -2) least squares give x2 = -1, which is not allowed; then
  // x1 = 1 alone.
  const std::vector<std::vector<double>> columns = {{1, 0, 0}, {1, 1, 0}, {0, 0, 1}};
  const std::vector<double> b = {1, -1, -2};
  const auto x = non_negative_least_squares(columns, b, 1);
  EXPECT_NEAR(x[0], 1, 1e-12);
  EXPECT_NEAR(x[1], 0, 1e-12);
  EXPECT_NEAR(x[2], -2, 1e-12);
}

std::string refusal(const schema::Result<void>& result) {
  return result ? "" : schema::message(result.error());
}

TEST(IdentifyFit, RefusesTooFewAllNoiseAndNoNumber) {
  BodeData few = exact(preset());
  few.frequency_hz.resize(5), few.response.resize(5);
  EXPECT_NE(refusal(check_bode(few)).find("5 frequencies"), std::string::npos);

  std::mt19937_64 random(9);
  std::normal_distribution<double> normal;
  BodeData noise = exact(preset());
  for (auto& value : noise.response) value = {normal(random), normal(random)};
  EXPECT_NE(refusal(check_bode(noise)).find("noise"), std::string::npos);
  BodeData loud = exact(preset());
  for (const auto& value : loud.response) loud.noise.push_back(std::abs(value));
  EXPECT_NE(refusal(check_bode(loud)).find("noise"), std::string::npos);

  EXPECT_NE(refusal(check_bode(loud)).find("the tray"), std::string::npos);
  loud.direction = Direction::sensor;  // a sensor's data, so the message does not mention the tray
  EXPECT_EQ(refusal(check_bode(loud)).find("the tray"), std::string::npos);
  EXPECT_NE(refusal(check_bode(loud)).find("reference cell"), std::string::npos);

  BodeData broken = exact(preset());
  broken.response[17] = {std::nan(""), 0};
  EXPECT_NE(refusal(check_bode(broken)).find("frequency 18"), std::string::npos);
  BodeData unsorted = exact(preset());
  std::swap(unsorted.frequency_hz[3], unsorted.frequency_hz[4]);
  EXPECT_EQ(check_bode(unsorted).error().kind, schema::ErrorKind::unsuitable);
  EXPECT_EQ(refusal(check_bode(exact(preset()))), "");
}

TEST(IdentifyFit, NoticesPhasesThatCannotBe) {
  const BodeData sound = exact(preset());
  EXPECT_EQ(refusal(check_phases(sound, {}, preset())), "");
  BodeData other = sound, upside = sound, half = sound;
  for (auto& value : other.response) value = std::conj(value);
  for (auto& value : upside.response) value = -value;
  for (std::size_t i = 25; i < half.size(); ++i) half.response[i] = -half.response[i];
  EXPECT_EQ(check_phases(other, {}, preset()).error().remedy, "give --phase-sign -1");
  EXPECT_NE(refusal(check_phases(upside, {}, preset())).find("inverted sign"), std::string::npos);
  EXPECT_EQ(check_phases(half, {}, preset()).error().kind, schema::ErrorKind::unsuitable);
}

TEST(IdentifyFit, NoticesAUnitThatIsAThousandOff) {
  for (const double times : {1e3, 1e-3, 1e6}) {
    BodeData data = exact(preset());
    for (auto& value : data.response) value *= times;
    const ResponseFit fit = fit_response(data, {}, preset());
    EXPECT_NEAR(fit.find("resonance_hz")->value / schema::resonance_hz(preset()), 1, 1e-6);
    EXPECT_NE(refusal(check_size(fit, preset())).find("unit"), std::string::npos) << times;
  }
  EXPECT_EQ(refusal(check_size(fit_response(exact(preset()), {}, preset()), preset())), "");
}

TEST(IdentifyFit, NamesTheOneValueThatIsOff) {
  for (const double times : {1e3, 1e-3, 10.0, -1.0})
    for (const std::size_t at : {0U, 17U, 44U, 59U}) {
      std::mt19937_64 random(at);
      BodeData data = measured(preset(), Direction::actuator, octaves(10, 1000, 60), 0.005, random);
      data.noise.clear();
      data.response[at] *= times;
      const ResponseFit fit = fit_response(data, kOpen, preset());
      EXPECT_FALSE(fit.claims_intervals());
      const std::string named = "frequency " + std::to_string(at + 1) + " (";
      EXPECT_NE(fit.misfit.words.find(named), std::string::npos)
          << times << " at " << at << ": " << fit.misfit.words;
      EXPECT_EQ(fit.find("resonance_hz")->low, fit.find("resonance_hz")->high);
    }
}

TEST(IdentifyFit, SeveralValuesThatAreOffAreAMisfit) {
  std::mt19937_64 random(3);
  BodeData data = measured(preset(), Direction::actuator, octaves(10, 1000, 60), 0.005, random);
  data.noise.clear();
  for (const std::size_t at : {12U, 30U, 41U}) data.response[at] *= 1000;
  for (const ModelChoice& choice : {ModelChoice{}, kOpen})
    EXPECT_TRUE(fit_response(data, choice, preset()).misfit.found);
}

// With a noise column that is ten times too large, every residual looks like noise.
TEST(IdentifyFit, OverstatedNoiseIsLeftOut) {
  std::mt19937_64 random(11);
  BodeData data = measured(preset(), Direction::actuator, octaves(10, 1000, 60), 0.005, random);
  const ResponseFit right = fit_response(data, {}, preset());
  EXPECT_EQ(right.noise_overstated, 0);
  for (double& sigma : data.noise) sigma *= 10;
  const ResponseFit fit = fit_response(data, {}, preset());
  EXPECT_NEAR(fit.noise_overstated, 10,
              4);  // the median of 60 squares to 19 %: three times that, of its root
  ASSERT_TRUE(fit.claims_intervals()) << fit.misfit.words;
  const auto width = [](const ResponseFit& of) {
    return of.find("resonance_hz")->high - of.find("resonance_hz")->low;
  };
  EXPECT_NEAR(width(fit) / width(right), 1, 0.3);  // 116 values: 7 %; the rest is for the noise's shape
  const auto words = identified(fit, preset(), "x").identification->words;
  EXPECT_NE(words.find("too large"), std::string::npos) << words;
}

// It would also hide a mode, whose residual is many times the rest but within the column.
TEST(IdentifyFit, OverstatedNoiseHidesNoMode) {
  std::mt19937_64 random(12);
  BodeData data = measured(preset(), Direction::actuator, octaves(10, 1000, 60), 0.002, random);
  for (std::size_t i = 0; i < data.size(); ++i) {
    const auto pair = [&](double hz) {
      const std::complex<double> s(0, data.frequency_hz[i] / hz);
      return 1.0 + 0.06 * s + s * s;
    };
    data.response[i] *= pair(780) / pair(810);
    data.noise[i] = 0.15 * std::abs(data.response[i]);
  }
  const ResponseFit fit = fit_response(data, kOpen, preset());
  EXPECT_GT(fit.noise_overstated, 3);
  EXPECT_EQ(name_of(fit.choice), "second mode") << said_of(fit);
}

}  // namespace
}  // namespace tacto::analysis
