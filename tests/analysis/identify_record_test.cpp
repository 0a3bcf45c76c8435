// SPDX-License-Identifier: GPL-3.0-or-later
// The response of a recording, with any drive: an exact plant (its closed form times the drive's spectrum, in
// a record twice as long, so that the response does not wrap around) with a sensor's noise.
#include <gtest/gtest.h>

#include <functional>

#include "analysis/identify/fit/response_fit.hpp"
#include "analysis/identify/measure/record_response.hpp"
#include "spatial/dsp/fourier/fft.hpp"
#include "tests/analysis/identify_plants.hpp"

namespace tacto::analysis {
namespace {

constexpr double kRecordRateHz = 8e3, kRecordS = 5, kTurns = 6.283185307179586;
constexpr std::size_t kSamples = 40000;
constexpr int kRecordDraws = 6;

using Signal = std::vector<double>;

// 23 um/V, 463 Hz, 0.061, 121 Hz: not the preset's.
schema::Transducer truth() {
  schema::Transducer t = schema::read_transducer("wiertlewski2011").value();
  const double k = t.flexure_stiffness_n_per_m + t.bender_stiffness_n_per_m, w = kTurns * 463;
  t.mass_kg = k / (w * w);
  t.damping_n_s_per_m = 2 * 0.061 * std::sqrt(k * t.mass_kg);
  t.amplifier_resistance_ohm *= schema::actuator_pole_hz(t) / 121;
  t.actuator_scale *= 23e-6 / std::abs(schema::actuator_response(t, 0));
  return t;
}

Signal drive(const std::function<double(double t)>& of) {
  Signal u;
  for (std::size_t i = 0; i < kSamples; ++i) u.push_back(of(static_cast<double>(i) / kRecordRateHz));
  return u;
}

// 5 % of cosine at either end.
double taper(double t, double duration_s) {
  const double edge_s = 0.025 * duration_s, near = std::min({t, duration_s - t, edge_s});
  return 0.5 - 0.5 * std::cos(0.5 * kTurns * std::max(0.0, near) / edge_s);
}

double log_chirp(double t, double duration_s) {
  const double growth = std::log(1200.0 / 5);
  return std::sin(kTurns * 5 * duration_s / growth * (std::exp(growth * t / duration_s) - 1));
}

Signal multisine_of(std::mt19937_64& random) {
  std::uniform_real_distribution<double> phase(0, kTurns);
  Signal u(kSamples, 0.0);
  double before = 0;
  for (const double octave : octaves(10, 1000, 60)) {
    const double hz = std::round(octave), at = phase(random);
    if (hz == before) continue;
    before = hz;
    for (std::size_t i = 0; i < kSamples; ++i)
      u[i] += 0.05 * std::cos(kTurns * hz * static_cast<double>(i) / kRecordRateHz + at);
  }
  return u;
}

// `periodic`: the drive is periodic and the plant in its steady state.
Signal answer(const Signal& u, bool periodic, std::mt19937_64& random) {
  const schema::Transducer t = truth();
  Signal padded = u;
  if (!periodic) padded.resize(2 * u.size());
  spatial::RealFft fft(padded.size());
  std::vector<std::complex<double>> spectrum(fft.bins());
  fft.forward(padded, spectrum);
  for (std::size_t k = 0; k < spectrum.size(); ++k)
    spectrum[k] *= schema::actuator_response(
        t, static_cast<double>(k) * kRecordRateHz / static_cast<double>(padded.size()));
  fft.inverse(spectrum, padded);
  padded.resize(u.size());
  std::normal_distribution<double> normal(0, 10e-9);
  for (double& value : padded) value += normal(random);
  return padded;
}

struct DriveKind {
  const char* name;
  std::function<Signal(std::mt19937_64&)> make;
  bool periodic = false;
  std::size_t cut = 0;  // samples at the start that were not recorded
};

Signal white_record(std::mt19937_64& random) {
  std::normal_distribution<double> normal(0, 0.3);
  return drive([&](double t) { return taper(t, kRecordS) * normal(random); });
}

std::vector<DriveKind> kinds() {
  const auto windowed = [](std::mt19937_64& random) {
    Signal u = multisine_of(random);
    for (std::size_t i = 0; i < u.size(); ++i)
      u[i] *= taper(static_cast<double>(i) / kRecordRateHz, kRecordS);
    return u;
  };
  const auto log = [](auto&) {
    return drive([](double t) { return 0.5 * taper(t, kRecordS) * log_chirp(t, kRecordS); });
  };
  const auto linear = [](auto&) {
    return drive([](double t) {
      return 0.5 * taper(t, kRecordS) * std::sin(kTurns * t * (5 + t * 1195 / (2 * kRecordS)));
    });
  };
  const auto repeated = [](auto&) {
    return drive([](double t) { return 0.5 * taper(std::fmod(t, 1), 1) * log_chirp(std::fmod(t, 1), 1); });
  };
  return {{"noise", white_record},
          {"noise, cut out of more", white_record, false, 7001},
          {"logarithmic chirp", log},
          {"linear chirp", linear},
          {"five chirps", repeated},
          {"multisine that begins", multisine_of},
          {"multisine, periodic", multisine_of, true},
          {"multisine, periodic, no whole periods", multisine_of, true, 3331},
          {"multisine, tapered", windowed}};
}

// The largest of the four errors, in half intervals; adds their squares to `squares`.
double worst_error(const ResponseFit& fit, double& squares) {
  double worst = 0;
  for (const auto& [name, value] : {std::pair("gain_m_per_v", 23e-6), std::pair("resonance_hz", 463.0),
                                    std::pair("damping_ratio", 0.061), std::pair("pole_hz", 121.0)}) {
    const FittedParameter& p = *fit.find(name);
    const double error = std::abs(std::log(p.value / value)) / (0.5 * std::log(p.high / p.low));
    worst = std::max(worst, error);
    squares += error * error;
  }
  return worst;
}

TEST(IdentifyRecord, AnExactPlantFitsWhateverDroveIt) {
  double squares = 0;
  for (const DriveKind& kind : kinds()) {
    int fits = 0, covered = 0;
    double resonance = 0;
    for (int draw = 0; draw < kRecordDraws; ++draw) {
      std::mt19937_64 random(100 + static_cast<unsigned>(draw));
      const Signal u = kind.make(random), x = answer(u, kind.periodic, random);
      const auto data = response_of_record(std::span(u).subspan(kind.cut), std::span(x).subspan(kind.cut),
                                           kRecordRateHz, 10, 1000, kind.name);
      ASSERT_TRUE(data) << kind.name;
      const ResponseFit fit = fit_response(*data, {}, schema::read_transducer("wiertlewski2011").value());
      fits += fit.claims_intervals();
      covered += worst_error(fit, squares) < 2;
      resonance = std::max(resonance, std::abs(fit.find("resonance_hz")->value / 463 - 1));
    }
    std::printf("  %-40s fits %d of %d, resonance within %.3f %%\n", kind.name, fits, kRecordDraws,
                100 * resonance);
    // A sound fit is called a misfit in 15 of 10,000; an error of four standard errors is one in 4,000.
    EXPECT_EQ(fits, kRecordDraws) << kind.name;
    EXPECT_EQ(covered, kRecordDraws) << kind.name;
    EXPECT_LT(resonance, 2e-3) << kind.name;
  }
  // 216 errors in standard errors: their RMS is 1 within 0.05 if they were independent; some share their
  // noise.
  const double rms = 1.959964 * std::sqrt(squares / (4 * kRecordDraws * static_cast<double>(kinds().size())));
  std::printf("  errors are %.2f of what their intervals say\n", rms);
  EXPECT_NEAR(rms, 1, 0.2);
}

TEST(IdentifyRecord, TwoSignalsOfTheirOwnAreRefused) {
  std::mt19937_64 random(5);
  const Signal u = white_record(random), x = white_record(random);
  const auto data = response_of_record(u, x, kRecordRateHz, 10, 1000, "strangers");
  // In one place of twenty, noise looks like a response; check_bode() refuses the result.
  EXPECT_TRUE(!data || !check_bode(*data));
}

}  // namespace
}  // namespace tacto::analysis
