// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "analysis/extremes/extreme.hpp"
#include "playback/prepare/prepare.hpp"
#include "playback/render/reference/exact_kernel.hpp"
#include "spatial/dsp/filter/butterworth.hpp"

namespace tacto::analysis {
namespace {

using playback::Prepared;

constexpr const char* kExactTicks = "the kernel again in double precision; re the drive's RMS";
constexpr double kStatedKernelError = 5.6e-6;  // -105 dB: TickKernel
constexpr double kKernelPi = std::numbers::pi;

// At 100 kHz the filter has too few taps to invert the transducer (refused), so only its gain is inverted. If
// the finger moves about a count per tick, rounding may select another position within the count (a row of
// its own).
Prepared prepared_for(double rate_hz, std::int32_t origin_count = 0) {
  schema::Texture texture;
  texture.signal.pitch_m = 10e-6;
  for (int i = 0; i < 4000; ++i) {
    const double x = i * 10e-6;
    texture.signal.values.push_back(
        0.02 * (std::sin(2 * kKernelPi * 500 * x) + 0.6 * std::sin(2 * kKernelPi * 2300 * x)));
  }
  playback::PrepareOptions options;
  options.rate_hz = rate_hz;
  options.ends = playback::Ends::loop;
  options.origin_count = origin_count;
  if (rate_hz > 50e3) options.inverse = playback::Inverse::gain;
  if (rate_hz > 20e3) options.between_counts = options.look_ahead = false;
  return *playback::prepare(texture, *schema::read_transducer("wiertlewski2011"), options);
}

struct ErrorSum {
  double error = 0, size = 0;
  void add(double value, double exact) {
    error += (value - exact) * (value - exact);
    size += exact * exact;
  }
  double ratio() const { return size > 0 ? std::sqrt(error / size) : 1; }
};

// Compares the kernel with the exact one: the finger is at place_m(t), the gain is gain(t) times the
// texture's.
template <class Place, class Gain>
double kernel_error(const Prepared& prepared, double seconds, Place place_m, Gain gain) {
  core::TickKernel kernel;
  kernel.set(prepared.setup());
  playback::ExactKernel exact(prepared);
  ErrorSum sum;
  const auto ticks = static_cast<int>(seconds * prepared.rate_hz);
  for (int i = 0; i < ticks; ++i) {
    const double t = i / prepared.rate_hz;
    const auto count = static_cast<std::int32_t>(std::floor(place_m(t) / 1e-6));
    const auto by = static_cast<float>(prepared.gain_m_per_n * gain(t));
    sum.add(kernel.tick({count, by, true, core::kNoForce}).drive_v,
            exact.tick({count, by, true, core::kNoForce}));
  }
  return sum.ratio();
}

double wandering(double t) {
  return 0.02 + 0.015 * std::sin(2 * kKernelPi * 0.7 * t) + 2e-3 * std::sin(2 * kKernelPi * 3.1 * t);
}
double always_one(double) {
  return 1;
}

void add_rates(std::vector<Extreme>& rows) {
  for (const double rate_hz : {100.0, 2e3, 20e3, 50e3, 100e3}) {
    const bool fastest = rate_hz == 100e3;
    rows.push_back(
        {"playback", fmt::format("ticks at {:g} Hz{}", rate_hz, fastest ? ", gain alone" : ""), kExactTicks,
         kernel_error(prepared_for(rate_hz), 2, wandering, always_one), kStatedKernelError,
         fastest
             ? "128 taps are 1.3 ms here: the full inverse is refused; below 100 Hz and above 100 kHz all are"
             : ""});
  }
}

// Error of the tracker's position, RMS, in counts. A uniform error within the count has 0.29.
double place_error(double counts_per_tick) {
  core::FingerTracker tracker;
  tracker.set({true, 0, 100});
  double sum = 0;
  constexpr int kTicks = 200000, kFirst = 2000;
  for (int i = 0; i < kTicks; ++i) {
    const double place = 0.123 + counts_per_tick * i;
    const auto seen = tracker.track(static_cast<std::int32_t>(std::floor(place)));
    if (i >= kFirst) sum += std::pow(seen.count + double{seen.offset} - place, 2);
  }
  return std::sqrt(sum / (kTicks - kFirst));
}

// The same path twice: around 0, and across the counter's overflow from 2^31 - 1 to -2^31.
double wrap_difference() {
  constexpr std::int32_t kFar = std::numeric_limits<std::int32_t>::max() - 30000;
  const Prepared near = prepared_for(2e3), far = prepared_for(2e3, kFar);
  core::TickKernel a, b;
  a.set(near.setup());
  b.set(far.setup());
  double worst = 0, most = 0;
  for (int i = 0; i < 4000; ++i) {
    const auto count = static_cast<std::int32_t>(std::floor(wandering(i / 2e3) / 1e-6)) * 2;
    const auto over = static_cast<std::int32_t>(static_cast<std::uint32_t>(count) + std::uint32_t{kFar});
    const double one = a.tick({count, 1e-3F, true, core::kNoForce}).drive_v;
    const double other = b.tick({over, 1e-3F, true, core::kNoForce}).drive_v;
    worst = std::max(worst, std::abs(one - other));
    most = std::max(most, std::abs(one));
  }
  return most > 0.05 ? worst / most : 1;
}

/// The final state of a chain of sections under a constant input.
struct SettledChain {
  double largest = 0;       ///< |y - target| over the final cycle
  std::uint64_t ticks = 0;  ///< before the cycle begins
  std::uint64_t cycle = 0;  ///< its length; 0: none was found
};

// A chain has finitely many states: once its state repeats, all later ticks are known (Brent 1980).
SettledChain settled(core::SectionChain chain, float input, double target) {
  constexpr std::uint64_t kMostTicks = 20'000'000;
  core::SectionChain saved = chain;
  SettledChain end;
  for (std::uint64_t power = 1, since = 0; end.ticks < kMostTicks; ++end.ticks) {
    (void)chain.filter(input);
    ++since;
    if (chain.is_where(saved)) {
      end.cycle = since;
      break;
    }
    if (since == power) saved = chain, power *= 2, since = 0;
  }
  for (std::uint64_t i = 0; i < end.cycle; ++i)
    end.largest = std::max(end.largest, std::abs(double{chain.filter(input)} - target));
  return end;
}

std::vector<wire::Section> single_precision(const std::vector<spatial::Section>& sections) {
  std::vector<wire::Section> rounded;
  for (const spatial::Section& h : sections)
    rounded.push_back({static_cast<float>(h.b0), static_cast<float>(h.b1), static_cast<float>(h.b2),
                       static_cast<float>(h.a1), static_cast<float>(h.a2)});
  return rounded;
}

// 15-500 Hz at 20 kHz, order 4: a typical filter of a laboratory.
void add_silence(std::vector<Extreme>& rows) {
  const auto sections = single_precision(*spatial::butterworth_band_pass(4, {15, 500}, 20e3));
  core::SectionChain chain;
  chain.set(sections.data(), static_cast<std::uint8_t>(sections.size()));
  for (int i = 0; i < 200000; ++i) (void)chain.filter(static_cast<float>(5 * std::sin(0.03 * i)));
  const SettledChain silent = settled(chain, 0, 0);
  const SettledChain loud = settled(chain, 5, 0);
  const auto words = [](const SettledChain& end) {
    return end.cycle > 0 ? fmt::format("after {} ticks its state repeats every {}: so it does after 1e9",
                                       end.ticks, end.cycle)
                         : std::string("no cycle was found in 2e7 ticks");
  };
  rows.push_back({"firmware-host",
                  "band-pass 15-500 Hz at 20 kHz, order 4: silence for ever after full scale", "zero; re 5 V",
                  silent.cycle > 0 ? silent.largest / 5 : 1, 0, words(silent)});
  rows.push_back({"firmware-host", "the same: full scale for ever",
                  "zero, the band-pass's gain at rest; re 5 V", loud.cycle > 0 ? loud.largest / 5 : 1, 1e-3,
                  words(loud)});
}

// Largest difference of the responses over the band, re their largest.
double rounding_of(double rate_hz) {
  const auto exact = *spatial::butterworth_band_pass(4, {15, 500}, rate_hz);
  std::vector<spatial::Section> rounded;
  for (const wire::Section& h : single_precision(exact)) rounded.push_back({h.b0, h.b1, h.b2, h.a1, h.a2});
  double worst = 0;
  for (double f = 15; f <= 500; f *= 1.002)
    worst = std::max(
        worst, std::abs(spatial::response_of(rounded, f, rate_hz) - spatial::response_of(exact, f, rate_hz)));
  return worst;
}

}  // namespace

std::vector<Extreme> kernel_extremes() {
  std::vector<Extreme> rows;
  add_rates(rows);
  rows.push_back({"playback", "a position that passes 2^31 counts", "the same way about 0, to the bit",
                  wrap_difference(), 0, "268 m of a 1 um grid from the origin: silence"});
  const auto creeping = [](double t) { return 0.0201237 + 30e-6 * std::sin(2 * kKernelPi * 0.2 * t); };
  rows.push_back({"playback",
                  "a finger that turns at 40 um/s: speed through zero",
                  kExactTicks,
                  kernel_error(prepared_for(2e3), 10, creeping, always_one),
                  kStatedKernelError,
                  {}});
  for (const double per_tick : {1e-4, 0.99, 1.0})
    rows.push_back({"firmware-host", fmt::format("a finger at {:g} counts a tick", per_tick),
                    "its true place; RMS, in counts", place_error(per_tick), per_tick == 1 ? 0.5 : 0.29,
                    "never off by more than the count"});
  const auto million = [](double t) { return t > 1 && t < 2 ? 1.0 : 1e-6; };
  rows.push_back({"playback", "a gain that goes a million-fold up and down", kExactTicks,
                  kernel_error(prepared_for(2e3), 3, wandering, million), kStatedKernelError,
                  "a gain of 3e38 gives a value that is not finite: a fault, and the drive falls"});
  rows.push_back({"firmware-host",
                  "coefficients in single precision: band-pass 15-500 Hz, order 4, at 20 kHz",
                  "the response with double ones; re its largest", rounding_of(20e3), 1e-2,
                  "sections whose poles leave the unit circle are refused"});
  add_silence(rows);
  return rows;
}

}  // namespace tacto::analysis
