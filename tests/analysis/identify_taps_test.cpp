// SPDX-License-Identifier: GPL-3.0-or-later
// Ringing after taps: synthetic ones with known poles, and those of a real sensor.
#include <gtest/gtest.h>

#include <filesystem>
#include <random>

#include "analysis/identify/measure/taps.hpp"
#include "tests/measured.hpp"

namespace tacto::analysis {
namespace {

constexpr double kTapRateHz = 100e3;
constexpr double kTapTurn = 6.283185307179586;

// Two modes from sample 500 on, with noise of 0.1 %.
Tap made_tap(int number, double frequency_hz, double damping, std::mt19937_64& random) {
  std::normal_distribution<double> normal(0, 1e-3);
  Tap tap{std::to_string(number), {}};
  for (int i = 0; i < 5000; ++i) {
    const double t = (i - 500) / kTapRateHz, w = kTapTurn * frequency_hz, v = kTapTurn * 4800;
    double value = 0.01 + normal(random);
    if (t >= 0)
      value += std::exp(-damping * w * t) * std::sin(w * std::sqrt(1 - damping * damping) * t) +
               0.3 * std::exp(-0.03 * v * t) * std::sin(v * t + number);
    tap.value.push_back(value);
  }
  return tap;
}

TEST(IdentifyTaps, PolesThatWereMadeComeBack) {
  std::mt19937_64 random(1);
  Taps taps{kTapRateHz, {}};
  for (int i = 1; i <= 10; ++i) taps.taps.push_back(made_tap(i, 1600 + i, 0.045, random));
  const TapsFit fit = fit_taps(taps).value();
  EXPECT_NEAR(fit.resonance_hz.median, 1605.5, 1);
  EXPECT_NEAR(fit.damping_ratio.median, 0.045, 0.0005);
  for (int i = 1; i <= 10; ++i)
    EXPECT_NEAR(fit.taps[static_cast<std::size_t>(i - 1)].modes.front().frequency_hz, 1600 + i, 1.5);
}

// impacts_100kHz.csv: 20 taps on a lateral force sensor.
TEST(IdentifyTaps, TheFirstTenForetellTheOthers) {
  const std::string path = std::string(TACTO_DATA) + "/impact-taps/impacts_100kHz.csv";
  if (!std::filesystem::exists(path)) {
    not_measured("identify_taps.*", "no real data");
    GTEST_SKIP() << "skipped: no real data";
  }
  const Taps taps = read_taps(path, kTapRateHz).value();
  ASSERT_EQ(taps.taps.size(), 20U);
  const TapsFit fit = fit_taps(taps).value();
  const TapsPrediction predicted = predict_taps(taps, 10).value();
  std::printf(
      "  resonance %.1f Hz +- %.1f (SD %.1f), damping ratio %.4f +- %.4f (SD %.4f, %.4f to %.4f), R^2 %.4f\n",
      fit.resonance_hz.median, fit.resonance_hz.spread, fit.resonance_hz.standard_deviation,
      fit.damping_ratio.median, fit.damping_ratio.spread, fit.damping_ratio.standard_deviation,
      fit.damping_ratio.least, fit.damping_ratio.most, fit.r_squared);
  std::printf(
      "  taps 1-10 predict 11-20: resonance %.2f %%, damping %.1f %%, waveform %.1f %% (worst %.1f %%), "
      "shape %.1f %%\n",
      100 * predicted.resonance_error, 100 * predicted.damping_error, 100 * predicted.waveform_error,
      100 * predicted.worst_waveform_error, 100 * predicted.shape_error);
  tacto::measured("identify_taps.resonance_hz", fit.resonance_hz.median);
  tacto::measured("identify_taps.resonance_spread_hz", fit.resonance_hz.spread);
  tacto::measured("identify_taps.damping_ratio", fit.damping_ratio.median);
  tacto::measured("identify_taps.damping_ratio_spread", fit.damping_ratio.spread);
  tacto::measured("identify_taps.damping_ratio_sd", fit.damping_ratio.standard_deviation);
  tacto::measured("identify_taps.predicted_resonance_error_percent", 100 * predicted.resonance_error);
  tacto::measured("identify_taps.predicted_damping_error_percent", 100 * predicted.damping_error);
  // The largest line of its spectrum lies at 1627 Hz in each tap (SciPy, Hann window of 45 ms, 1 Hz apart).
  EXPECT_NEAR(fit.resonance_hz.median, 1627, 8);
  EXPECT_LT(fit.resonance_hz.spread, 0.01 * 1627);
  // The dampings form two groups, so the median distance underestimates their scatter.
  EXPECT_GT(fit.damping_ratio.standard_deviation, 1.5 * fit.damping_ratio.spread);
  EXPECT_LT(fit.damping_ratio.least, 0.035);
  EXPECT_GT(fit.r_squared, 0.9);
  EXPECT_GT(fit.damping_ratio.median, 0.02);
  EXPECT_LT(fit.damping_ratio.median, 0.06);
  EXPECT_LT(std::abs(predicted.resonance_error), 0.005);
  EXPECT_LT(predicted.waveform_error, 0.3);  // 1: no prediction at all; NumPy's pencil: 0.218
  EXPECT_LT(predicted.shape_error, 0.08);    // NumPy's: 0.053
}

TEST(IdentifyTaps, RefusesOneTapNoiseAndNoNumber) {
  std::mt19937_64 random(3);
  const Tap sound = made_tap(1, 1600, 0.045, random);
  EXPECT_EQ(fit_taps({kTapRateHz, {sound}}).error().kind, schema::ErrorKind::unsuitable);
  Tap noise{"2", {}};
  std::normal_distribution<double> normal;
  for (int i = 0; i < 5000; ++i) noise.value.push_back(normal(random));
  noise.value[600] = 8;
  EXPECT_NE(schema::message(fit_taps({kTapRateHz, {sound, noise}}).error()).find("noise"), std::string::npos);
  Tap broken = sound;
  broken.value[900] = std::nan("");
  EXPECT_NE(schema::message(fit_taps({kTapRateHz, {sound, broken}}).error()).find("sample 901"),
            std::string::npos);
}

}  // namespace
}  // namespace tacto::analysis
