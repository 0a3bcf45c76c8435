// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <numbers>

#include "analysis/extremes/extreme.hpp"
#include "capture/calibrate/hann_line.hpp"
#include "capture/calibrate/travel.hpp"
#include "capture/import/derived_position.hpp"
#include "capture/import/uniform_clock.hpp"
#include "capture/record/live_view.hpp"
#include "capture/record/record_header.hpp"
#include "capture/table/csv_number.hpp"
#include "data-schema/recording/clock_fit.hpp"
#include "spatial/strokes/touch_record.hpp"

namespace tacto::analysis {
namespace {

constexpr double kEightHoursS = 8 * 3600.0;
constexpr double kSince1970S = 1.7e9;
constexpr double kFast = 1 + 100e-6;

schema::RecordingHeader encoder_header(double metres_per_count) {
  schema::RecordingHeader header;
  header.sample_rate_hz = 1000;
  schema::Channel position;
  position.name = position.quantity = "position";
  position.unit = "m";
  position.scale = metres_per_count;
  header.channels = {position};
  return header;
}

// Gain of the paper's sensor at 100 Hz, by its formula.
long double newtons_per_volt(const schema::Transducer& t) {
  using Long = long double;
  const std::complex<Long> s(0, 200 * std::numbers::pi_v<Long>);
  const Long beta = Long{t.deflection_m} / (2 * Long{t.max_voltage_v}), kp = t.bender_stiffness_n_per_m;
  const std::complex<Long> electrics =
      Long{1} + 2 * Long{t.sensor_resistance_ohm} * Long{t.capacitance_f} * s;
  const std::complex<Long> mechanics =
      Long{t.mass_kg} * s * s + Long{t.damping_n_s_per_m} * s + Long{t.flexure_stiffness_n_per_m} + kp;
  const std::complex<Long> volts_per_newton = Long{-2} * Long{t.sensor_gain} * Long{t.sensor_resistance_ohm} *
                                              kp * beta * Long{t.sensor_scale} * s / (electrics * mechanics);
  return 1 / volts_per_newton.real();
}

// 16 bits over +-10 V, left-justified in 32.
double conversion_error() {
  constexpr std::int32_t kOneCount = 1 << 16;
  const schema::Transducer transducer = *schema::read_transducer("wiertlewski2011");
  schema::Channel volts;
  volts.name = volts.quantity = "tangential_force";
  volts.unit = "V", volts.scale = std::ldexp(10, -31), volts.range_min = -10, volts.range_max = 10;
  schema::RecordingHeader header = encoder_header(1);
  header.channels = {capture::sensor_in_newtons(volts, transducer)};
  double error = 0;
  for (const std::int32_t code : {INT32_MIN, -kOneCount, kOneCount, INT32_MAX - (kOneCount - 1)}) {
    capture::LiveFigures figures(header);
    figures.add(std::span(&code, 1));
    const long double exact = std::ldexp(10.0L * code, -31) * newtons_per_volt(transducer);
    error = std::max(error, static_cast<double>(std::abs(figures.statistics()[0].max() / exact - 1)));
  }
  return error;
}

// Whole periods: Hann's window then removes the mean, and the sum of a line is a quarter of its samples.
double hann_error() {
  constexpr std::size_t kHannSamples = 2'000'000;
  constexpr double kCycles = 0.005, kOffset = 1.9e9, kAmplitude = 65536;
  std::vector<double> samples(kHannSamples);
  for (std::size_t i = 0; i < kHannSamples; ++i)
    samples[i] = kOffset + kAmplitude * std::cos(2 * std::numbers::pi * static_cast<double>(i % 200) / 200);
  return std::abs(capture::amplitude_of(capture::hann_line(samples, kCycles), kHannSamples) / kAmplitude - 1);
}

// The speeds are whole um/s, so that their sum is exact.
double integrated_error() {
  schema::RecordingHeader header = encoder_header(1);
  schema::Channel speed;
  speed.name = speed.quantity = "speed";
  speed.unit = "m/s", speed.scale = 1e-6;
  auto position = capture::DerivedPosition::integrated(speed);
  const auto frames = static_cast<std::int64_t>(kEightHoursS * header.sample_rate_hz);
  std::int64_t twice = 0, before = 0;
  double off = 0, farthest = 0;
  for (std::int64_t i = 0; i < frames; ++i) {
    const std::int64_t um_per_s = 50'000 + (i * 7919) % 10'007;
    const double position_m = position.next(header, static_cast<double>(um_per_s));
    if (i > 0) twice += before + um_per_s;
    before = um_per_s;
    const double exact_m = static_cast<double>(static_cast<long double>(twice) / 2e9L);
    off = std::max(off, std::abs(position_m - exact_m));
    farthest = std::max(farthest, exact_m);
  }
  return off / farthest;
}

// Passes the times of `rows` ticks to `take` in pieces, tick i at `at(i)`, until it fails.
template <class At, class Take>
schema::Result<void> in_pieces(std::uint64_t rows, At at, Take take) {
  constexpr std::uint64_t kPiece = 1 << 16;
  std::vector<double> times;
  for (std::uint64_t from = 0; from < rows; from += kPiece) {
    times.clear();
    for (std::uint64_t i = from; i < std::min(rows, from + kPiece); ++i) times.push_back(at(i));
    if (const auto taken = take(times); !taken) return taken;
  }
  return {};
}

template <class At>
schema::Result<capture::UniformClock> clock_of(std::uint64_t rows, At at) {
  capture::ClockFinder finder;
  const auto survey = [&](const auto& times) { return finder.survey(times), schema::Result<void>(); };
  const auto place = [](std::uint64_t row) { return std::to_string(row); };
  const auto locate = [&](const auto& times) { return finder.locate(times, place, "times"); };
  (void)in_pieces(rows, at, survey);
  TACTO_TRY(finder.end_survey("times"));
  if (finder.second_pass_needed()) TACTO_TRY(in_pieces(rows, at, locate));
  return finder.clock();
}

double printed_to_us(double time_s) {
  return std::round(1e6 * time_s) / 1e6;
}

double fast_clock_error() {
  constexpr double kRateHz = 1000 * kFast;
  const auto clock = clock_of(static_cast<std::uint64_t>(kEightHoursS * kRateHz), [](std::uint64_t i) {
    return printed_to_us(static_cast<double>(i) / kRateHz);
  });
  return clock ? std::abs(clock->rate_hz / kRateHz - 1) : INFINITY;
}

// A minute of ticks on each side of a gap of seven hours; the error is that of the gap's number of ticks.
double long_gap_error() {
  constexpr double kRateHz = 1000 * kFast;
  constexpr std::uint64_t kBefore = 60'000, kMissing = 25'202'520;
  const auto clock = clock_of(2 * kBefore, [](std::uint64_t i) {
    return printed_to_us(static_cast<double>(i < kBefore ? i : i + kMissing) / kRateHz);
  });
  if (!clock || clock->gaps.size() != 1) return INFINITY;
  return std::abs(static_cast<double>(clock->gaps[0].count) - static_cast<double>(kMissing));
}

double error_since_1970(double rate_hz) {
  const auto clock = clock_of(
      200'000, [rate_hz](std::uint64_t i) { return kSince1970S + static_cast<double>(i) / rate_hz; });
  return clock && clock->gaps.empty() ? std::abs(clock->rate_hz / rate_hz - 1) : INFINITY;
}

// By bisection. A step of double precision at these times is 2^-22 s; the clock tolerates a quarter of a
// period.
double fastest_since_1970_hz() {
  double good_hz = 1e4, bad_hz = 1e8;
  while (bad_hz / good_hz > 1.01) {
    const double middle_hz = std::round(std::sqrt(good_hz * bad_hz));
    (error_since_1970(middle_hz) < 1e-5 ? good_hz : bad_hz) = middle_hz;
  }
  return good_hz;
}

// The device's microseconds exceed 2^32 after 72 min; one pair of times per second.
double drift_error(double host_start_s) {
  std::vector<schema::ClockPair> pairs;
  for (double time_s = 0; time_s <= kEightHoursS; time_s += 1) {
    const auto device_us = static_cast<std::uint64_t>(std::llround(1e6 * kFast * time_s));
    pairs.push_back({0, static_cast<double>(device_us) * 1e-6, host_start_s + time_s});
  }
  const auto fit = schema::fit_clock(pairs);
  return fit ? std::abs(fit->drift_ppm - 100) : INFINITY;
}

std::int32_t wrapped(std::int64_t count) {
  return std::bit_cast<std::int32_t>(static_cast<std::uint32_t>(count));
}

// Three strokes back and forth at 53 mm/s; no step equals a step of 0.1 mm.
constexpr int kStroke = 377, kCountsAFrame = 53;
struct FoundStroke {
  int direction = 0;
  std::size_t frames = 0;
  double length_m = 0, mean_speed_mps = 0;
};

// Positions in stored counts.
class CountSource : public spatial::TouchSource {
 public:
  CountSource(schema::Channel position, std::vector<std::int32_t> codes)
      : position_(std::move(position)), codes_(std::move(codes)) {}
  const schema::Channel* channel(spatial::Track track) const override {
    return track == spatial::Track::position || track == spatial::Track::value ? &position_ : nullptr;
  }
  schema::Result<void> read_stored(spatial::Track, std::size_t first, std::span<double> out) override {
    std::copy_n(codes_.begin() + static_cast<std::ptrdiff_t>(first), out.size(), out.begin());
    return {};
  }

 private:
  schema::Channel position_;
  std::vector<std::int32_t> codes_;
};

std::vector<FoundStroke> strokes_from(std::int64_t first_count) {
  schema::RecordingHeader header = encoder_header(1e-6);
  std::vector<std::int32_t> codes;
  constexpr int kRest = 200;
  std::int64_t count = first_count;
  for (int stroke = 0; stroke < 3; ++stroke)
    for (int frame = 0; frame < kStroke + kRest; ++frame) {
      if (frame < kStroke) count += stroke % 2 == 0 ? kCountsAFrame : -kCountsAFrame;
      codes.push_back(wrapped(count));
    }
  header.frames = codes.size();
  auto source = std::make_unique<CountSource>(header.channels.front(), std::move(codes));
  const auto record = spatial::TouchRecord::open(std::move(source), header, "strokes");
  std::vector<FoundStroke> found;
  if (!record) return found;
  for (const spatial::Stroke& stroke : record->strokes())
    found.push_back(
        {stroke.direction, stroke.frames.size(), record->length_m(stroke), record->mean_speed_mps(stroke)});
  return found;
}

double wrapped_strokes_error() {
  constexpr std::int64_t kHalfAStrokeBefore = (std::int64_t{1} << 31) - 10'001;
  const auto passing = strokes_from(kHalfAStrokeBefore), plain = strokes_from(0);
  if (plain.size() != 3 || passing.size() != plain.size()) return INFINITY;
  double error = 0;
  for (std::size_t i = 0; i < plain.size(); ++i) {
    if (passing[i].direction != plain[i].direction || passing[i].frames != plain[i].frames) return INFINITY;
    error = std::max({error, std::abs(passing[i].length_m / plain[i].length_m - 1),
                      std::abs(passing[i].mean_speed_mps / plain[i].mean_speed_mps - 1)});
  }
  return error;
}

double wrapped_travel_error() {
  constexpr std::int64_t kStart = (std::int64_t{1} << 31) - 12'345, kTravel = 50'000;
  capture::Take take{encoder_header(1e-6), "", {{}}};
  for (const std::int64_t count : {kStart, kStart + kTravel, kStart, kStart + kTravel}) {
    take.header.marks.push_back({take.codes[0].size(), ""});
    take.codes[0].push_back(wrapped(count));
  }
  const auto differences = capture::count_differences(take, "position");
  const auto scale = capture::scale_by_travel(*differences, 50e-3, 0);
  return scale && scale->direction == 1 ? std::abs(scale->scale.value / 1e-6 - 1) : INFINITY;
}

// Any finite double, including denormals and the largest, with enough digits to identify it.
double numbers_not_read_to_the_bit() {
  constexpr int kNumbers = 200'000;
  std::uint64_t state = 12345;
  int wrong = 0;
  for (int i = 0; i < kNumbers; ++i) {
    state = state * 6364136223846793005U + 1442695040888963407U;
    const auto number = std::bit_cast<double>(state ^ (state >> 29));
    if (!std::isfinite(number)) continue;
    const std::string text =
        i % 2 == 0 ? fmt::format("{:.17g}", number) : fmt::format("{:.16f}", std::remainder(number, 1));
    double read = 0;
    char mark = 0;
    const auto fault = capture::read_number(text, mark, read);
    wrong += fault != capture::NumberFault::none ||
             std::bit_cast<std::uint64_t>(read) !=
                 std::bit_cast<std::uint64_t>(std::strtod(text.c_str(), nullptr));
  }
  return wrong;
}

std::vector<Extreme> clock_rows() {
  return {
      {"capture", "times of a clock 100 ppm fast over 8 h, printed to 1 us: its rate",
       "1000.1 Hz, by which they were made", fast_clock_error(), 1e-6 / kEightHoursS,
       "as well as the last digits at both ends determine"},
      {"capture", "times with a gap of 7 h between two minutes: ticks that are missing", "25,202,520",
       long_gap_error(), 0, "a clock of 1000.1 Hz, printed to 1 us"},
      {"capture", "times in seconds since 1970, at 10 kHz: their rate", "10 kHz", error_since_1970(1e4), 1e-7,
       fmt::format("doubles are 0.24 us apart there: above {:.2g} Hz refused as uneven",
                   fastest_since_1970_hz())},
      {"capture",
       "pairs of clocks over 8 h, the device's 100 ppm fast and past 2^32 us: drift",
       "100 ppm; in ppm",
       drift_error(0),
       1e-6,
       {}},
      {"capture", "the same, the host's in seconds since 1970", "100 ppm; in ppm", drift_error(kSince1970S),
       1e-6, "doubles are 0.24 us apart there"}};
}

}  // namespace

std::vector<Extreme> capture_extremes() {
  std::vector<Extreme> rows{
      {"capture",
       "16 bits over +-10 V in newtons, at one count and at either end",
       "the sensor's formula at 100 Hz in long double",
       conversion_error(),
       1e-14,
       {}},
      {"capture",
       "a line of one count of 16 bits on 0.9 of full scale, over 2e6 samples",
       "its amplitude, in closed form",
       hann_error(),
       1e-9,
       {}},
      {"capture", "a position from a speed of 8 h at 1 kHz, 28.8e6 steps", "the sum in whole numbers",
       integrated_error(), 3e-9, "relative to the way; one rounding per step"},
      {"capture", "numbers of a table, arbitrary doubles: those not read to the bit", "strtod",
       numbers_not_read_to_the_bit(), 0, "200,000, denormals among them"},
      {"capture",
       "an encoder that passes 2^31 in the middle of strokes: lengths and speeds",
       "the same strokes about 0",
       wrapped_strokes_error(),
       1e-9,
       {}},
      {"capture",
       "travels from mark to mark through 2^31 counts: the scale",
       "travel over counts",
       wrapped_travel_error(),
       1e-12,
       {}}};
  std::ranges::move(clock_rows(), std::back_inserter(rows));
  return rows;
}

}  // namespace tacto::analysis
