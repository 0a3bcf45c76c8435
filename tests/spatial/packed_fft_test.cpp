// SPDX-License-Identifier: GPL-3.0-or-later
// The parts of a short-time transform, each against its definition.
#include "spatial/dsp/fourier/packed_fft.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <optional>
#include <string>

#include "spatial/dsp/filter/trend.hpp"
#include "spatial/dsp/resample/decimator.hpp"
#include "spatial/dsp/resample/low_pass.hpp"
#include "spatial/reference/exact_short_time.hpp"
#include "tests/data-schema/temporary_folder.hpp"
#include "tests/spatial/texture_samples.hpp"

namespace tacto::spatial {
namespace {

namespace fs = std::filesystem;

template <class Real>
class PackedFftOf : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(PackedFftOf, Reals);

// Two frames of noise, each with an offset and a slope, against the exact transform of each alone.
TYPED_TEST(PackedFftOf, TwoFramesComeApartAgain) {
  constexpr std::size_t kPadded = 128, kWindow = 100;
  const auto noise = samples::noise(2 * kWindow).signal.values;
  const std::vector<float> x(noise.begin(), noise.end());
  const std::vector<float> window(kWindow, 0.75F);
  PackedFft<TypeParam> fft(kPadded, 1);
  pack_frames<TypeParam>({x.data(), 0.25, 0}, {x.data() + kWindow, -0.5, 0.01}, window, fft.input());
  fft.transform();
  std::vector<std::complex<float>> a(kPadded / 2 + 1), b(kPadded / 2 + 1);
  std::vector<float> power_a(a.size()), power_b(a.size());
  unpack_spectra<TypeParam>(fft.output(), a, b);
  unpack_powers<TypeParam>(fft.output(), power_a, power_b);
  std::vector<long double> exact_a(kPadded, 0), exact_b(kPadded, 0);
  for (std::size_t n = 0; n < kWindow; ++n) {
    exact_a[n] = 0.75L * (x[n] - 0.25L);
    exact_b[n] = 0.75L * (x[kWindow + n] + 0.5L + 0.01L * static_cast<long double>(n));
  }
  const auto spectrum_a = reference::exact_fourier(exact_a), spectrum_b = reference::exact_fourier(exact_b);
  // Single precision: 6e-8 of sums of a hundred numbers about 1.
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_LT(std::abs(std::complex<long double>(a[k]) - spectrum_a[k]), 1e-5L) << k;
    EXPECT_LT(std::abs(std::complex<long double>(b[k]) - spectrum_b[k]), 1e-5L) << k;
    EXPECT_NEAR(power_a[k], std::norm(a[k]), 1e-5F * (1 + power_a[k])) << k;
    EXPECT_NEAR(power_b[k], std::norm(b[k]), 1e-5F * (1 + power_b[k])) << k;
  }
}

TEST(PackedFft, MeasuresOnlyForLongJobs) {
  EXPECT_FALSE(measuring_saves_time(16384, 301));  // one stroke: 17 ms
  EXPECT_TRUE(measuring_saves_time(16384, 100000));
  EXPECT_FALSE(measuring_saves_time(1024, 9030));
}

// FFTW's plain sum against the definition of the exact reference: lengths even, odd, and mixed.
TEST(ExactFourier, EqualsItsDefinition) {
  for (const std::size_t length : {1U, 2U, 7U, 12U, 30U}) {
    const auto noise = samples::noise(length).signal.values;
    const std::vector<long double> x(noise.begin(), noise.end());
    const auto spectrum = reference::exact_fourier(x);
    for (std::size_t k = 0; k < length; ++k) {
      std::complex<long double> sum = 0;
      for (std::size_t n = 0; n < length; ++n)
        sum +=
            x[n] * std::polar(1.0L, -2 * std::numbers::pi_v<long double> * static_cast<long double>(k * n) /
                                        static_cast<long double>(length));
      EXPECT_LT(std::abs(spectrum[k] - sum), 1e-16L) << length << " " << k;
    }
  }
}

double response(const std::vector<double>& taps, double frequency) {
  const auto reach = static_cast<double>(taps.size() / 2);
  double sum = 0;
  for (std::size_t n = 0; n < taps.size(); ++n)
    sum += taps[n] * std::cos(2 * std::numbers::pi * frequency * (static_cast<double>(n) - reach));
  return sum;
}

TEST(LowPass, PassesAndSuppressesTo132Db) {
  for (const auto& [pass, stop] : {std::pair(0.02, 0.0425), std::pair(0.02, 0.2075), std::pair(0.08, 0.17)}) {
    const auto taps = low_pass(pass, stop);
    EXPECT_EQ(taps.size(), 2 * low_pass_reach(pass, stop) + 1);
    for (int i = 0; i <= 200; ++i) {
      EXPECT_NEAR(response(taps, pass * i / 200), 1, 2.5e-7) << pass;
      EXPECT_NEAR(response(taps, stop + (0.5 - stop) * i / 200), 0, 2.5e-7) << stop;
    }
  }
}

TEST(Decimator, SumsShiftedSequences) {
  const auto noise = samples::noise(200).signal.values;
  const std::vector<float> x(noise.begin(), noise.end());
  std::vector<float> out(77);
  const Tap taps[] = {{x.data(), 0.5F}, {x.data() + 3, -2.0F}, {x.data() + 100, 1.0F}};
  weighted_sum(taps, out);
  for (std::size_t i = 0; i < out.size(); ++i)
    EXPECT_NEAR(out[i], 0.5F * x[i] - 2 * x[i + 3] + x[i + 100], 1e-6F) << i;
}

// Every grid point of a block, in whichever phase, is the low-passed signal there.
TEST(Decimator, DealsTheFilteredSignalToItsPhases) {
  for (const std::size_t hop : {100U, 160U, 101U, 102U}) {
    const FrameShape shape{10000, hop, 16384, 246};
    const Decimation decimation = decimation_for(shape);
    Decimator decimator(decimation, 1000);
    const double turn = 2 * std::numbers::pi * 0.0137;  // in the pass band
    std::vector<float> samples;
    for (std::size_t i = 0; i < 1000 + 2 * decimator.reach() + decimation.grid; ++i)
      samples.push_back(static_cast<float>(
          std::cos(turn * (static_cast<double>(i) - static_cast<double>(decimator.reach())))));
    decimator.run(samples, 1000);
    for (std::size_t start = 0; start < 600; start += decimation.grid)
      for (std::size_t j = 0; j < 20; ++j)
        ASSERT_NEAR(decimator.from(start)[j],
                    std::cos(turn * static_cast<double>(start + j * decimation.factor)), 1e-6)
            << hop << " " << start << " " << j;
  }
}

TEST(Trend, FindsTheLineUnderAStrongBaseline) {
  std::vector<double> x;
  for (int i = 0; i < 1003; ++i) x.push_back(1e6 + 0.5 * i + (i % 2 == 0 ? 1 : -1));
  const Trend trend = trend_of(x);
  EXPECT_NEAR(trend.mean, 1e6 + 0.5 * 501 + 1.0 / 1003, 1e-9);
  EXPECT_NEAR(trend.slope, 0.5, 1e-6);
  EXPECT_NEAR(trend.largest, 0.5 * 501 + 1, 0.01);
  EXPECT_NEAR(sum_above(x, 1e6), 0.5 * 501 * 1003 + 1, 1e-6);
  std::vector<float> off(x.size());
  subtract_line(x, 1e6, 0.5, 2, off);
  EXPECT_EQ(off[10], 2.0F);
  EXPECT_EQ(off[11], -2.0F);
}

class Wisdom : public testing::Test {
 protected:
  ~Wisdom() override {
    put("XDG_CACHE_HOME", cache_);
    put("HOME", home_);
  }
  static void put(const char* name, const std::optional<std::string>& value) {
    value ? setenv(name, value->c_str(), 1) : unsetenv(name);
  }

 private:
  static std::optional<std::string> got(const char* name) {
    const char* value = std::getenv(name);
    return value == nullptr ? std::nullopt : std::optional<std::string>(value);
  }
  std::optional<std::string> cache_ = got("XDG_CACHE_HOME"), home_ = got("HOME");
  tests::TemporaryFolder folder_;

 protected:
  std::string path_ = folder_ / "cache/tactograph/fftwf.wisdom";
};

TEST_F(Wisdom, IsKeptAndReadAgain) {
  EXPECT_FALSE(read_wisdom<float>(path_));
  ASSERT_TRUE(write_wisdom<float>(path_));
  EXPECT_TRUE(read_wisdom<float>(path_));
  EXPECT_EQ(std::distance(fs::directory_iterator(fs::path(path_).parent_path()), {}), 1);
}

TEST_F(Wisdom, IsIgnoredWhereItIsDamaged) {
  ASSERT_TRUE(write_wisdom<float>(path_));
  for (const char* text : {"", "no wisdom", "(fftw-3.3.10 fftwf_wisdom #x0 #x0 #x0 #x0\n  (", "\xff\xfe"}) {
    std::ofstream(path_) << text;
    EXPECT_FALSE(read_wisdom<float>(path_)) << text;
  }
  EXPECT_TRUE(write_wisdom<float>(path_));  // and is repaired
  EXPECT_TRUE(read_wisdom<float>(path_));
}

TEST_F(Wisdom, IsNoErrorWhereNothingCanBeKept) {
  EXPECT_FALSE(write_wisdom<float>("/proc/tactograph/fftwf.wisdom"));
  EXPECT_FALSE(write_wisdom<float>(""));
  EXPECT_FALSE(read_wisdom<float>("/proc"));
}

TEST_F(Wisdom, LiesInTheUsersCacheFolder) {
  put("XDG_CACHE_HOME", "/somewhere");
  EXPECT_EQ(wisdom_path<float>(), "/somewhere/tactograph/fftwf.wisdom");
  EXPECT_EQ(wisdom_path<double>(), "/somewhere/tactograph/fftw.wisdom");
  put("XDG_CACHE_HOME", "relative");
  put("HOME", "/home/me");
  EXPECT_EQ(wisdom_path<float>(), "/home/me/.cache/tactograph/fftwf.wisdom");
  put("HOME", std::nullopt);
  EXPECT_EQ(wisdom_path<float>(), "");
}

}  // namespace
}  // namespace tacto::spatial
