// SPDX-License-Identifier: GPL-3.0-or-later
// Detail that is too fine for the finger's speed must not alias: while the speed changes, and in the
// displacement of the emulated tray.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <vector>

#include "playback/render/reference/padded_spectrum.hpp"
#include "tests/measured.hpp"
#include "tests/playback/fidelity.hpp"
#include "tests/playback/made_textures.hpp"

namespace tacto::playback {
namespace {

constexpr double kPlaceM = 1e-9;       // so fine that the count is the exact position
constexpr double kFinestPerM = 140e3;  // 70 kHz at the greatest speed
constexpr double kReadingHz = 160e3;   // at least twice that; a multiple of every tick rate here
constexpr double kUnfoldedHz = 100e3;  // highest rate for prepare(); levels then end at 1250 Hz
constexpr double kJudgedHz = 1e3;      // rate of the error signals
constexpr double kGain = 1e-7;         // m/N, far from the limits
constexpr double kPassHz = 480, kStopHz = 500;

double db_of(double ratio) {
  return 20 * std::log10(ratio);
}

/// Tones of unit amplitude and random phase, in steps of 7 %, periodic in 10 mm.
class Tones {
 public:
  Tones(double least_per_m, double most_per_m) {
    std::mt19937 random(5);
    for (double per_m = 100; per_m < kFinestPerM; per_m = 100 * std::ceil(per_m * 1.07 / 100)) {
      const double phase = std::uniform_real_distribution<>(0, kTwoPi)(random);
      if (per_m >= least_per_m && per_m <= most_per_m) tones_.emplace_back(per_m, phase);
    }
  }
  double operator()(double x) const {
    double sum = 0;
    for (const auto& [per_m, phase] : tones_) sum += std::sin(kTwoPi * per_m * x + phase);
    return sum;
  }
  double rms() const { return std::sqrt(static_cast<double>(tones_.size()) / 2); }
  schema::Texture loop() const {
    auto texture = texture_of(0.01, *this);
    texture.signal.values.pop_back();
    return texture;
  }

 private:
  std::vector<std::pair<double, double>> tones_;
};

/// From rest, linearly faster up to 500 mm/s, then at that speed.
struct Acceleration {
  double mps2 = 0.5;
  static constexpr double kRestS = 0.3, kOnS = 0.35;
  static constexpr double kTopMps = 0.5;

  double rising_s() const { return kTopMps / mps2; }
  double duration_s() const { return kRestS + rising_s() + kOnS; }
  double operator()(double t) const {
    const double u = std::clamp(t - kRestS, 0.0, rising_s());
    return 0.01 + 0.5 * mps2 * u * u + kTopMps * std::max(0.0, t - kRestS - rising_s());
  }
};

/// A low-pass that passes 480 Hz and attenuates everything from 500 Hz on by 80 dB: a Kaiser window (beta 8)
/// on a sinc, of the length for 20 Hz (Kaiser 1974: (A - 8) / (2.285 x 2 pi x 20 Hz)).
class BandFilter {
 public:
  static constexpr double kHalfS = 0.13;
  explicit BandFilter(double rate_hz) : rate_hz_(rate_hz), half_(static_cast<int>(kHalfS * rate_hz)) {
    constexpr double kBeta = 8, kCutHz = 0.5 * (kPassHz + kStopHz);
    for (int i = 0; i <= half_; ++i) {
      const double t = i / rate_hz, u = t / kHalfS;
      const double sinc = i == 0 ? 2 * kCutHz : std::sin(kTwoPi * kCutHz * t) / (std::numbers::pi * t);
      const double window =
          std::cyl_bessel_i(0.0, kBeta * std::sqrt(std::max(0.0, 1 - u * u))) / std::cyl_bessel_i(0.0, kBeta);
      taps_.push_back(sinc * window / rate_hz);
    }
  }
  /// The filtered values at kJudgedHz, from kHalfS after the first value to kHalfS before the last.
  std::vector<double> operator()(const std::vector<double>& values) const {
    const int step = static_cast<int>(std::lround(rate_hz_ / kJudgedHz));
    const int first = static_cast<int>(std::ceil(kHalfS * kJudgedHz)) * step;
    std::vector<double> out;
    for (int at = first; at + half_ < static_cast<int>(values.size()); at += step) {
      const double* centre = values.data() + at;
      double sum = taps_[0] * centre[0];
      for (int i = 1; i <= half_; ++i) sum += taps_[static_cast<std::size_t>(i)] * (centre[i] + centre[-i]);
      out.push_back(sum);
    }
    return out;
  }

 private:
  double rate_hz_;
  int half_;
  std::vector<double> taps_;
};

PrepareOptions looped_at(double rate_hz) {
  PrepareOptions options;
  options.rate_hz = rate_hz;
  options.metres_per_count = kPlaceM;
  options.gain_m_per_n = kGain;
  options.ends = Ends::loop;
  options.seam_m = 0;
  options.inverse = Inverse::gain;
  options.look_ahead = false;
  options.onset_s = 0.01;
  return options;
}

std::int32_t count_of(double place_m) {
  return static_cast<std::int32_t>(std::floor(place_m / kPlaceM));
}

Prepared prepared_at(const Tones& tones, double rate_hz) {
  auto prepared = prepare(tones.loop(), *schema::read_transducer("wiertlewski2011"), looped_at(rate_hz));
  EXPECT_TRUE(prepared) << message(prepared.error());
  return std::move(*prepared);
}

std::vector<double> kernel_along(const Tones& tones, const Acceleration& path, double rate_hz) {
  const Prepared prepared = prepared_at(tones, rate_hz);
  core::TickKernel kernel;
  kernel.set(prepared.setup());
  std::vector<double> values;
  for (int i = 0; i < static_cast<int>(path.duration_s() * rate_hz); ++i)
    values.push_back(kernel.target(count_of(path(i / rate_hz)), 1));
  return BandFilter(rate_hz)(values);
}

/// The target in closed form: all content up to 500 Hz, and none above.
const std::vector<double>& ideal_along(const Tones& tones, const Acceleration& path) {
  static std::map<double, std::vector<double>> known;
  if (const auto at = known.find(path.mps2); at != known.end()) return at->second;
  std::vector<double> ideal;
  for (int i = 0; i < static_cast<int>(path.duration_s() * kReadingHz); ++i)
    ideal.push_back(tones(path(i / kReadingHz)));
  return known.emplace(path.mps2, BandFilter(kReadingHz)(ideal)).first->second;
}

float speed_after(core::FingerTracker& tracker, std::int32_t count) {
  tracker.track(count);
  return tracker.speed();
}

/// The level of detail, in half-octaves, at each tick.
std::vector<float> detail_along(const Prepared& prepared, const Acceleration& path) {
  core::FingerTracker tracker;
  tracker.set(prepared.tracker);
  std::vector<float> detail;
  for (int i = 0; i < static_cast<int>(path.duration_s() * prepared.rate_hz); ++i)
    detail.push_back(core::half_octaves(speed_after(tracker, count_of(path(i / prepared.rate_hz))) /
                                        prepared.full_detail_counts_per_tick));
  return detail;
}

/// The same levels with the same fades, read at such a rate that nothing aliases.
std::vector<double> unfolded_along(const Tones& tones, const Acceleration& path, double rate_hz) {
  const Prepared prepared = prepared_at(tones, rate_hz);
  const core::Profile profile(prepared.samples.data(), prepared.scale);
  const auto detail = detail_along(prepared, path);
  const double per_tick = kUnfoldedHz / rate_hz;
  std::vector<double> values;
  for (int i = 0; i < static_cast<int>(path.duration_s() * kUnfoldedHz); ++i) {
    const double tick = i / per_tick;
    const auto n = std::min(static_cast<std::size_t>(tick), detail.size() - 2);
    const double coarse = std::lerp(double{detail[n]}, double{detail[n + 1]}, tick - static_cast<double>(n));
    const auto coarser = static_cast<std::uint32_t>(coarse);
    values.push_back(
        profile.at(count_of(path(i / kUnfoldedHz)), 0, {coarser, static_cast<float>(coarse - coarser)}));
  }
  return BandFilter(kUnfoldedHz)(values);
}

/// The same without levels: the texture at each tick.
std::vector<double> careless_along(const Tones& tones, const Acceleration& path, double rate_hz) {
  std::vector<double> values;
  for (int i = 0; i < static_cast<int>(path.duration_s() * rate_hz); ++i)
    values.push_back(tones(path(i / rate_hz)));
  return BandFilter(rate_hz)(values);
}

/// The largest level over 15-500 Hz of the difference of two signals, RMS, in windows of 64 ms (Hann) that
/// begin in [from_s, to_s).
double worst_short_time_rms(const std::vector<double>& one, const std::vector<double>& other, double from_s,
                            double to_s) {
  constexpr std::size_t kWindow = 64, kHop = 4;
  double worst = 0;
  const std::size_t values = std::min(one.size(), other.size());
  for (std::size_t at = 0; at + kWindow <= values; at += kHop) {
    const double begins_s = static_cast<double>(at) / kJudgedHz + BandFilter::kHalfS;
    if (begins_s < from_s || begins_s >= to_s) continue;
    std::vector<double> difference(kWindow);
    for (std::size_t i = 0; i < kWindow; ++i)
      difference[i] = (one[at + i] - other[at + i]) *
                      (1 - std::cos(kTwoPi * static_cast<double>(i) / static_cast<double>(kWindow)));
    const auto spectrum = spectrum_of(difference, kJudgedHz, kWindow);
    worst = std::max(worst, std::sqrt(2 * energy_in(spectrum, {15, 500}) / 1.5) / kWindow);
  }
  return worst;
}

class FoldingAtRate : public testing::TestWithParam<double> {};

// From rest to 500 mm/s within 1 s and within 0.2 s, over all fine detail. The aliasing (against the same
// levels with the same fades, read without aliasing) never exceeds -60 dB of the texture, except in windows
// with the first hundredth of a second from rest to 2.5 m/s^2 at 2 kHz: there the texture fades within a few
// ticks, which is too fast for 2 kHz. (A fade by a speed that predicts the acceleration, or by twice the
// speed, leaves -50 and -46 dB of six textures; this leaves -47 dB.)
// Against all content up to 500 Hz it is -60 dB after the finger has moved for 50 ms. Before, tones sweep
// through 500 Hz within milliseconds, and a fade by the speed removes a part of their content below 500 Hz. A
// reading without levels gives -20 dB and much more.
TEST_P(FoldingAtRate, NothingFoldsWhileTheFingerGetsFaster) {
  constexpr double kStart = Acceleration::kRestS, kBegun = kStart + 0.01, kSteady = kStart + 0.05;
  const Tones tones(0, kFinestPerM);
  for (const double mps2 : {0.5, 2.5}) {
    const Acceleration path{mps2};
    const auto& ideal = ideal_along(tones, path);
    const auto unfolded = unfolded_along(tones, path, GetParam());
    const auto kernel = kernel_along(tones, path, GetParam());
    ASSERT_NEAR(static_cast<double>(kernel.size()), static_cast<double>(ideal.size()), 2);
    const auto worst_db = [&](const auto& one, const auto& other, double from_s, double to_s) {
      return db_of(worst_short_time_rms(one, other, from_s, to_s) / tones.rms());
    };
    const double starting_db = worst_db(kernel, unfolded, 0, kBegun);
    const double folded_db = worst_db(kernel, unfolded, kBegun, 1e9);
    const double ideal_db = worst_db(kernel, ideal, kSteady, 1e9);
    const double careless_db = worst_db(careless_along(tones, path, GetParam()), ideal, kSteady, 1e9);
    std::printf(
        "%5g Hz, %g m/s^2: folded %.1f dB, with the start %.1f dB; re the ideal %.1f dB, without care "
        "%.1f dB\n",
        GetParam(), mps2, folded_db, starting_db, ideal_db, careless_db);
    const std::string key = "folding.at_" + std::to_string(std::lround(1e-3 * GetParam())) + "khz_" +
                            std::to_string(std::lround(1e3 * mps2)) + "_mm_per_s2_";
    measured(key + "folded_db", folded_db);
    measured(key + "starting_db", starting_db);
    measured(key + "ideal_db", ideal_db);
    EXPECT_LT(folded_db, -60);
    EXPECT_LT(ideal_db, -60);
    EXPECT_LT(starting_db, mps2 < 1 || GetParam() > 2e3 ? -60 : -45);
    EXPECT_GT(careless_db, -20) << "the texture has nothing that folds";
  }
}

// Slightly below the largest speed, so that aliases do not coincide with the texture's lines.
constexpr double kFastMps = 0.497;

/// The tray for the kernel's drive, at 20 kHz or more.
std::vector<double> tray_along(const Tones& tones, double rate_hz) {
  constexpr double kDurationS = 2.4;
  tests::FidelityCase c;
  c.model = c.real = *schema::read_transducer("wiertlewski2011");
  c.options = looped_at(rate_hz);
  c.options.inverse = Inverse::full;
  c.options.metres_per_count = 4e-9;  // 1.2 m are less than 2^29 of them
  c.path = steady_path(0.02, kFastMps, kDurationS);
  const auto prepared = prepare(tones.loop(), c.model, c.options);
  EXPECT_TRUE(prepared) << message(prepared.error());
  const auto fine = static_cast<std::size_t>(std::ceil(20e3 / rate_hz));
  return tests::displacement_at_finger(c, *prepared, static_cast<std::size_t>(kDurationS * rate_hz), fine);
}

struct Spectrum {
  double lines_m = 0, beside_m = 0;  ///< RMS in the band: within 5 Hz of a line of the texture, and elsewhere
};

// A window of 2 s (Hann squared: 5 Hz beside a line less than -120 dB of it remain).
Spectrum spectrum_in_band(std::vector<double> moved_m, double rate_hz) {
  moved_m.erase(moved_m.begin(), moved_m.begin() + static_cast<std::ptrdiff_t>(0.3 * rate_hz));
  moved_m.resize(static_cast<std::size_t>(2 * rate_hz));
  const auto n = static_cast<double>(moved_m.size());
  for (std::size_t i = 0; i < moved_m.size(); ++i)
    moved_m[i] *= std::pow(1 - std::cos(kTwoPi * static_cast<double>(i) / n), 2);
  const auto spectrum = spectrum_of(moved_m, rate_hz, moved_m.size());
  Spectrum level;
  for (std::size_t k = 0; k < spectrum.bins.size(); ++k) {
    const double f = spectrum.frequency_hz(k), line_hz = 100 * kFastMps;
    if (f < 15 || f > 500) continue;
    const double beside_hz = std::abs(f - line_hz * std::round(f / line_hz));
    (beside_hz <= 5 ? level.lines_m : level.beside_m) += 2 * std::norm(spectrum.bins[k]) / (4.375 * n * n);
  }
  return {std::sqrt(level.lines_m), std::sqrt(level.beside_m)};
}

// Tones are at multiples of 49.7 Hz. Aliases of tones beyond 1250 Hz, and of the images of interpolation, are
// between them. Tones within the band do not change.
TEST_P(FoldingAtRate, TheSpectrumOfTheTrayAtFiveHundredMillimetresASecond) {
  const Tones all(0, kFinestPerM), band(0, 500 / kFastMps);
  const double rate_hz = GetParam() * std::ceil(20e3 / GetParam());
  const Spectrum level = spectrum_in_band(tray_along(all, GetParam()), rate_hz);
  const double folded_db = db_of(level.beside_m / (kGain * all.rms()));
  const double moved_db = db_of(level.lines_m / (kGain * band.rms()));
  std::printf("%5g Hz: beside the lines %.1f dB of the texture, the lines %.3f dB of what is wanted\n",
              GetParam(), folded_db, moved_db);
  const std::string key = "folding.tray_at_" + std::to_string(std::lround(1e-3 * GetParam())) + "khz_";
  measured(key + "beside_db", folded_db);
  measured(key + "lines_db", moved_db);
  EXPECT_LT(folded_db, -60);
  EXPECT_NEAR(moved_db, 0, 0.05);  // tolerance: the inverse -69 dB, the interpolation -50 dB: 0.03 dB
}

INSTANTIATE_TEST_SUITE_P(Rates, FoldingAtRate, testing::Values(2e3, 5e3, 20e3));

}  // namespace
}  // namespace tacto::playback
