// SPDX-License-Identifier: GPL-3.0-or-later
// Complex spectra against the definition in extended precision. Required for spectrograms: |X - X_exact| /
// max |X_exact| over all cells, all frequencies, at most -120 dB.
#include "spatial/dsp/spectrum/short_time_transform.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <functional>
#include <numbers>

#include "spatial/dsp/spectrum/window.hpp"
#include "spatial/reference/exact_short_time.hpp"
#include "tests/spatial/texture_samples.hpp"

namespace tacto::spatial {
namespace {

constexpr FrameShape kUsual{10000, 100, 16384, 8193};
constexpr std::size_t kBinsTo15PerMm = 246;

using Signal = std::vector<double>;

// Lines in the band, a line above it, noise of all frequencies and a drift, on a baseline.
Signal touch(std::size_t count, double baseline, double drift) {
  Signal x = samples::noise(count).signal.values;
  for (std::size_t i = 0; i < count; ++i) {
    const double turn_mm = 2 * std::numbers::pi * static_cast<double>(i) * 1e-3;
    x[i] = baseline + drift * static_cast<double>(i) / static_cast<double>(count) + 0.005 * x[i] +
           0.05 * std::sin(2 * turn_mm) + 0.02 * std::sin(8.1 * turn_mm) + 0.03 * std::sin(33 * turn_mm);
  }
  return x;
}

struct Error {
  double largest = 0, largest_exact = 0;
  double db() const { return 20 * std::log10(largest / largest_exact); }
};

// For every `each`-th row.
Error transform_error(const Signal& x, const FrameShape& shape, const Decimation& decimation,
                      std::size_t each, bool detrend = true, std::size_t expected = 1) {
  ShortTimeTransform transform(shape, decimation, blackman(shape.window), 1, detrend, expected);
  Error error;
  const auto compare = [&](std::size_t row, std::span<const std::complex<float>> got, int exponent) {
    if (row % each != 0) return;
    const auto exact = reference::exact_short_time_row(x, shape, row, detrend);
    for (std::size_t k = 0; k < exact.size(); ++k) {
      error.largest_exact = std::max(error.largest_exact, static_cast<double>(std::abs(exact[k])));
      if (k >= got.size()) continue;
      const std::complex<long double> scaled(std::ldexp(static_cast<long double>(got[k].real()), exponent),
                                             std::ldexp(static_cast<long double>(got[k].imag()), exponent));
      error.largest = std::max(error.largest, static_cast<double>(std::abs(scaled - exact[k])));
    }
  };
  std::vector<std::complex<float>> a(shape.bins), b(shape.bins);
  std::size_t rows = 0;
  const auto done = transform.transform(x, [&](const PackedRows& packed) -> schema::Result<void> {
    EXPECT_EQ(packed.row, rows);
    packed.spectra(a, b);
    compare(packed.row, a, packed.exponent);
    if (packed.two) compare(packed.row + 1, b, packed.exponent);
    rows += packed.two ? 2 : 1;
    return {};
  });
  EXPECT_TRUE(done);
  EXPECT_EQ(rows, transform.rows_of(x.size()));
  return error;
}

struct TransformCase {
  const char* name;
  Signal signal;
};

std::vector<TransformCase> cases() {
  std::vector<TransformCase> all;
  all.push_back({"touch", touch(40000, 0.3, 0.1)});
  all.push_back({"noise", samples::noise(40000).signal.values});
  all.push_back({"strong baseline", touch(40000, 1e4, 0)});
  all.push_back({"strong drift", touch(40000, 0, 1e3)});
  all.push_back({"long drift", touch(400000, 0, 1e3)});
  for (const double size : {1e-30, 1e30}) {
    all.push_back({size < 1 ? "tiny" : "huge", touch(40000, 0.3, 0.1)});
    for (double& value : all.back().signal) value *= size;
  }
  all.push_back({"one spike", Signal(40000, 1.0)});
  all.back().signal[20000] = 1e6;
  all.push_back({"a step", Signal(40000, -5.0)});
  std::fill(all.back().signal.begin() + 20000, all.back().signal.end(), 5.0);
  return all;
}

// Enough rows for single precision, and too few for measuring a plan.
constexpr std::size_t kManyRows = 6000;

TEST(ShortTimeTransform, IsExactTo120DbAtWholeResolution) {
  ASSERT_FALSE(is_short_job(kUsual.padded, kManyRows / 2));
  ASSERT_FALSE(measuring_saves_time(kUsual.padded, kManyRows / 2));
  for (const auto& [name, signal] : cases()) {
    EXPECT_LT(transform_error(signal, kUsual, {}, 61, true, kManyRows).db(), -120) << name;
    EXPECT_LT(transform_error(signal, kUsual, {}, 61).db(), -120) << name;
  }
}

TEST(ShortTimeTransform, IsExactTo120DbOnACoarserGrid) {
  FrameShape shape = kUsual;
  shape.bins = kBinsTo15PerMm;
  const Decimation decimation = decimation_for(shape);
  EXPECT_EQ(decimation.factor, 16U);
  EXPECT_EQ(decimation.grid, 4U);
  for (const auto& [name, signal] : cases()) {
    EXPECT_LT(transform_error(signal, shape, decimation, 61).db(), -120) << name;
  }
}

// Hops and paddings with and without common factors, even and odd, short windows and long hops.
TEST(ShortTimeTransform, KeepsItsBinsForAnyHop) {
  const Signal signal = touch(60000, 0.3, 0.1);
  for (const std::size_t hop : {1600U, 160U, 101U, 102U, 6000U, 25000U})
    for (const std::size_t padded : {16384U, 10000U, 12000U}) {
      const FrameShape shape{10000, hop, padded, padded * 15 / 1000 + 1};
      const Decimation decimation = decimation_for(shape);
      EXPECT_LT(transform_error(signal, shape, decimation, 1 + 12000 / hop).db(), -120)
          << hop << " " << padded;
    }
  for (const std::size_t window : {1000U, 1037U, 3001U}) {
    const FrameShape shape{window, 50, 4096, 62};
    EXPECT_LT(transform_error(signal, shape, decimation_for(shape), 97).db(), -120) << window;
  }
}

TEST(ShortTimeTransform, KeepsTheMeanWhereAsked) {
  EXPECT_LT(transform_error(touch(40000, 100, 0), kUsual, {}, 43, false, kManyRows).db(), -120);
  FrameShape shape = kUsual;
  shape.bins = kBinsTo15PerMm;
  EXPECT_LT(transform_error(touch(40000, 100, 0), shape, decimation_for(shape), 43, false).db(), -120);
}

TEST(ShortTimeTransform, SaysWhyItKeepsTheWholeResolution) {
  FrameShape shape{3001, 250, 4099, 62};  // a prime
  EXPECT_EQ(decimation_for(shape).factor, 1U);
  EXPECT_EQ(decimation_for(shape).whole_because, "no number from 2 to 10 divides the 4099 padded samples");
  EXPECT_TRUE(decimation_for(kUsual).whole_because.empty());
}

TEST(ShortTimeTransform, StopsWhereItsSinkFails) {
  ShortTimeTransform transform(kUsual, {}, blackman(kUsual.window), 1, true, 1);
  int calls = 0;
  const auto done = transform.transform(touch(20000, 0, 0), [&](const PackedRows&) -> schema::Result<void> {
    return ++calls < 3 ? schema::Result<void>{} : schema::fail(schema::ErrorKind::cannot_write, "full");
  });
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().what, "full");
  EXPECT_EQ(calls, 3);
}

}  // namespace
}  // namespace tacto::spatial
