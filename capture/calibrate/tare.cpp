// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/calibrate/tare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>

#include "capture/calibrate/hann_line.hpp"
#include "data-schema/base/decibels.hpp"
#include "data-schema/base/statistics.hpp"
#include "data-schema/recording/statistics.hpp"

namespace tacto::capture {
namespace {

using schema::Channel;
using schema::ErrorKind;
using schema::Result;

constexpr double kShortestTare_s = 1;
constexpr double kMoved_m = 0.1e-3, kResting_n = 0.1;
constexpr double kMostTareDrift = 0.5, kMostNoise = 20;
constexpr double kLowestNoise_hz = 20, kHighestNoise_hz = 480;
constexpr int kLines = 100;

std::vector<double> physical(const Take& take, std::size_t channel) {
  const Channel& properties = take.header.channels[channel];
  std::vector<double> values = take.codes[channel];
  for (double& value : values) value = properties.physical(value);
  return values;
}

// The power of a line of white noise is exponentially distributed: its median is ln 2 times its mean.
double noise_density(std::span<const double> samples, double rate_hz, double native_rate_hz) {
  const double highest_hz = std::min(kHighestNoise_hz, 0.45 * std::min(rate_hz, native_rate_hz));
  std::vector<double> powers;
  for (int i = 0; i < kLines; ++i) {
    const double frequency_hz = kLowestNoise_hz + (highest_hz - kLowestNoise_hz) * i / (kLines - 1);
    powers.push_back(density_of(hann_line(samples, frequency_hz / rate_hz), samples.size(), rate_hz));
  }
  return std::sqrt(schema::upper_median(std::span(powers)) / std::numbers::ln2);
}

double rms_about_mean(std::span<const double> samples) {
  const schema::Statistics statistics = schema::statistics_of(samples);
  return std::sqrt(std::max(0.0, std::pow(statistics.rms(), 2) - std::pow(statistics.mean(), 2)));
}

constexpr double kLineToFloorPower = 18;  // power relative to the mean of the neighbours
constexpr int kHarmonics = 6, kNearest = 4, kFurthest = 13;

struct Samples {
  std::span<const double> values;
  double rate_hz;

  double bin_hz() const { return rate_hz / static_cast<double>(values.size()); }
  double amplitude_at(double frequency_hz) const {
    return amplitude_of(hann_line(values, frequency_hz / rate_hz), values.size());
  }
};

// The mains frequency deviates by about 0.1 Hz, its harmonics by more.
double highest_near(const Samples& samples, double frequency_hz) {
  double highest = 0;
  for (int half = -4; half <= 4; ++half)
    highest = std::max(highest, samples.amplitude_at(frequency_hz + 0.5 * half * samples.bin_hz()));
  return highest;
}

double mean_power_around(const Samples& samples, double frequency_hz) {
  double sum = 0;
  for (int bin = kNearest; bin <= kFurthest; ++bin)
    for (const int side : {-1, 1})
      sum += std::pow(samples.amplitude_at(frequency_hz + side * bin * samples.bin_hz()), 2);
  return sum / (2 * (kFurthest - kNearest + 1));
}

std::optional<MainsLine> line_at(const Samples& samples, double frequency_hz) {
  const double amplitude = highest_near(samples, frequency_hz);
  const double floor = mean_power_around(samples, frequency_hz), power = amplitude * amplitude;
  if (!(power > kLineToFloorPower * floor) || power == 0) return std::nullopt;
  return MainsLine{frequency_hz, amplitude, schema::power_db(power / std::max(floor, 1e-300))};
}

std::vector<MainsLine> family(const Samples& samples, double base_hz, double highest_hz) {
  std::vector<MainsLine> lines;
  for (int harmonic = 1; harmonic <= kHarmonics && harmonic * base_hz < highest_hz; ++harmonic)
    if (const auto line = line_at(samples, harmonic * base_hz)) lines.push_back(*line);
  return lines;
}

double power_of(const std::vector<MainsLine>& lines) {
  double power = 0;
  for (const MainsLine& line : lines) power += line.amplitude * line.amplitude;
  return power;
}

// See tare_of(). Amplitudes are in the unit of the samples. Lines above 0.45 of the rate, or of
// `native_rate_hz`, are not searched.
std::vector<MainsLine> mains_lines(std::span<const double> samples, double sample_rate_hz,
                                   double native_rate_hz) {
  const Samples all{samples, sample_rate_hz};
  const double highest_hz = 0.45 * std::min(sample_rate_hz, native_rate_hz);
  auto fifty = family(all, 50, highest_hz), sixty = family(all, 60, highest_hz);
  return power_of(fifty) >= power_of(sixty) ? fifty : sixty;
}

ChannelTare tare_of_channel(const Take& take, std::size_t channel) {
  const Channel& properties = take.header.channels[channel];
  const double rate_hz = take.header.sample_rate_hz, native_hz = properties.native_rate_hz.value_or(rate_hz);
  const std::vector<double> values = physical(take, channel);
  ChannelTare tare{channel, mean_of(take.codes[channel]), 0, rms_about_mean(values), 0, {}};
  tare.mean = properties.physical(tare.zero.value);
  tare.noise_density = noise_density(values, rate_hz, native_hz);
  tare.mains = mains_lines(values, rate_hz, native_hz);
  return tare;
}

// Whether this is the channel of the transducer, whose noise is among the transducer's parameters.
bool is_transducers(const Take& take, const Channel& channel) {
  return channel.quantity == "tangential_force" && take.header.transducer.has_value();
}

void judge(const Take& take, const ChannelTare& tare, Tare& all) {
  const Channel& properties = take.header.channels[tare.channel];
  if (drift_ratio(take.codes[tare.channel]) > kMostTareDrift)
    all.motion_signs.push_back(fmt::format("{} drifts", properties.name));
  if (!is_transducers(take, properties) && std::abs(tare.mean) > kResting_n)
    all.warnings.push_back(
        fmt::format("{} is {:.3g} {} at rest: check whether this is the offset of the sensor or a load on it",
                    properties.name, tare.mean, properties.unit));
  if (!is_transducers(take, properties)) return;
  double power = tare.noise_rms * tare.noise_rms;
  for (const MainsLine& line : tare.mains) power -= line.amplitude * line.amplitude / 2;
  const double floor =
      take.header.transducer->noise_n_per_sqrt_hz * std::sqrt(take.header.sample_rate_hz / 2);
  if (floor > 0 && power > std::pow(kMostNoise * floor, 2))
    all.motion_signs.push_back(fmt::format("{} has {:.3g} N of noise, and its noise floor is {:.3g} N",
                                           properties.name, std::sqrt(power), floor));
}

void judge_motion(const Take& take, Tare& all) {
  for (std::size_t i = 0; i < take.codes.size(); ++i) {
    const Channel& properties = take.header.channels[i];
    if (properties.quantity != "position") continue;
    const auto [least, most] = std::ranges::minmax(take.codes[i]);
    const double moved_m = std::abs((most - least) * properties.scale);
    if (moved_m > kMoved_m)
      all.warnings.push_back(fmt::format("{} moved by {:.3g} mm: nothing may touch the device during a tare",
                                         properties.name, moved_m * 1e3));
  }
}

bool is_clipped(const Take& take, std::size_t channel) {
  const Channel& properties = take.header.channels[channel];
  const std::vector<double> values = physical(take, channel);
  const auto [least, most] = std::ranges::minmax(values);
  return (properties.range_max && most >= *properties.range_max) ||
         (properties.range_min && least <= *properties.range_min);
}

std::vector<std::string> notes_on(const ChannelTare& tare, const Channel& properties) {
  std::vector<std::string> notes = {
      "uncertainty: scatter of the means of 20 blocks (type A), and the step of the converter if noise does "
      "not dither it"};
  for (const MainsLine& line : tare.mains)
    notes.push_back(fmt::format("mains at {:g} Hz: {:.3g} {} peak, {:.0f} dB above its neighbours",
                                line.frequency_hz, line.amplitude, properties.unit, line.above_floor_db));
  return notes;
}

}  // namespace

Result<Tare> tare_of(const Take& take) {
  if (static_cast<double>(take.frames()) < kShortestTare_s * take.header.sample_rate_hz)
    return schema::fail(ErrorKind::unsuitable, fmt::format("a tare needs at least {:g} s", kShortestTare_s),
                        "time");
  Tare tare;
  for (std::size_t i = 0; i < take.codes.size(); ++i) {
    const Channel& properties = take.header.channels[i];
    if (properties.unit != "N") continue;
    if (is_clipped(take, i))
      return schema::fail(ErrorKind::unsuitable, "is at the limit of its converter's range", properties.name,
                          "remove the load, or check the wiring");
    tare.channels.push_back(tare_of_channel(take, i));
    judge(take, tare.channels.back(), tare);
  }
  judge_motion(take, tare);
  if (!tare.channels.empty()) return tare;
  return schema::fail(ErrorKind::unsuitable, "has no force channel", take.header.device);
}

std::vector<schema::CalibrationEntry> entries_of(const Tare& tare, const Take& take) {
  std::vector<schema::CalibrationEntry> entries;
  for (const ChannelTare& one : tare.channels) {
    const Channel& properties = take.header.channels[one.channel];
    schema::CalibrationEntry entry{
        properties.name, properties.unit, "tare", {}, properties.scale, {}, {}, {}, {}, 0, {}, {}, {}};
    entry.zero = one.zero.value;
    entry.zero_uncertainty = one.zero.uncertainty;
    entry.degrees_of_freedom = one.zero.degrees_of_freedom;
    entry.noise_rms = one.noise_rms;
    entry.noise_density = one.noise_density;
    entry.notes = notes_on(one, properties);
    entries.push_back(std::move(entry));
  }
  return entries;
}

}  // namespace tacto::capture
