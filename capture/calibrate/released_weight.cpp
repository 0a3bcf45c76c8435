// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/calibrate/released_weight.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>

#include "data-schema/transducer/transducer.hpp"

namespace tacto::capture {
namespace {

using schema::ErrorKind;
using schema::Result;

constexpr double kBefore_s = 0.1, kRinging_s = 0.5, kRingStandsOut = 20;
constexpr double kLowestRing_hz = 10, kHighestRing_hz = 60, kRingsApart_hz = 1 / kRinging_s;

struct Window {
  std::vector<double> newtons;  // by the nominal scale of the device, relative to the mean before the release
  double rate_hz;
};

Result<Window> window_of(const Release& release, std::size_t channel) {
  const schema::Channel& properties = release.take.header.channels[channel];
  const std::vector<double>& codes = release.take.codes[channel];
  const double rate_hz = release.take.header.sample_rate_hz;
  const double middle = std::accumulate(codes.begin(), codes.end(), 0.0) / static_cast<double>(codes.size());
  const auto peak = std::ranges::max_element(codes, {}, [&](double code) { return std::abs(code - middle); });
  const auto before = static_cast<std::ptrdiff_t>(kBefore_s * rate_hz);
  const auto length = static_cast<std::ptrdiff_t>(kRinging_s * rate_hz);
  if (peak - codes.begin() < before || codes.end() - (peak - before) < length)
    return schema::fail(
        ErrorKind::unsuitable, "the release is too near the start or the end", properties.name,
        fmt::format("{:g} s before it and {:g} s after it are needed", kBefore_s, kRinging_s - kBefore_s));
  Window window{{peak - before, peak - before + length}, rate_hz};
  const std::ptrdiff_t quiet = before * 9 / 10;
  const double rest = std::accumulate(window.newtons.begin(), window.newtons.begin() + quiet, 0.0) /
                      static_cast<double>(quiet);
  for (double& value : window.newtons) value = (value - rest) * properties.scale;
  const double physical = properties.physical(*peak);
  if ((properties.range_max && physical >= *properties.range_max) ||
      (properties.range_min && physical <= *properties.range_min))
    return schema::fail(ErrorKind::unsuitable, "is clipped", properties.name, "release a smaller weight");
  return window;
}

// Compared with the noise before the release, so that noise is not accepted as a release.
Result<void> check_above_noise(const Window& window, const std::string& channel) {
  const auto before = static_cast<std::ptrdiff_t>(0.9 * kBefore_s * window.rate_hz);
  double noise = 0, peak = 0;
  for (auto at = window.newtons.begin(); at != window.newtons.end(); ++at) {
    if (at - window.newtons.begin() < before) noise += *at * *at / static_cast<double>(before);
    peak = std::max(peak, std::abs(*at));
  }
  if (peak > kRingStandsOut * std::sqrt(noise) && peak > 0) return {};
  return schema::fail(ErrorKind::unsuitable, "no release is large enough to be detected", channel,
                      "wait until the weight hangs still, then cut its thread once");
}

double spectrum_at(const Window& window, double frequency_hz) {
  std::complex<double> sum = 0;
  for (std::size_t i = 0; i < window.newtons.size(); ++i)
    sum += window.newtons[i] *
           std::polar(1.0, -2 * std::numbers::pi * frequency_hz * static_cast<double>(i) / window.rate_hz);
  return std::abs(sum) / window.rate_hz;
}

double expected_at(const schema::Transducer& transducer, double force_n, double frequency_hz) {
  const double shape = std::abs(schema::sensor_response(transducer, frequency_hz) *
                                schema::nominal_newtons_per_volt(transducer));
  return shape * force_n / (2 * std::numbers::pi * frequency_hz);
}

// The ratio of the measured to the expected spectrum.
Uncertain gain_of(const Window& window, const schema::Transducer& transducer, double force_n) {
  double xm = 0, mm = 0, xx = 0, count = 0;
  for (double frequency_hz = kLowestRing_hz; frequency_hz <= kHighestRing_hz;
       frequency_hz += kRingsApart_hz) {
    const double x = spectrum_at(window, frequency_hz), m = expected_at(transducer, force_n, frequency_hz);
    xm += x * m, mm += m * m, xx += x * x, count += 1;
  }
  const double gain = xm / mm, left = std::max(0.0, xx - gain * xm);
  return {gain, std::sqrt(left / (count - 1) / mm), count - 1};
}

Result<Uncertain> gain_of(const Release& release, const std::string& channel) {
  const auto index = schema::find_channel(release.take.header, channel);
  if (!index)
    return schema::fail(ErrorKind::usage, index.error().what, index.error().where, index.error().remedy);
  const auto& transducer = release.take.header.transducer;
  if (!transducer || release.take.header.channels[*index].quantity != "tangential_force")
    return schema::fail(ErrorKind::unsuitable, "is not the transducer's own channel", channel,
                        "load cells are calibrated by weights at rest: --mass 0g --mass 100g");
  if (!(release.force_n > 0)) return schema::fail(ErrorKind::usage, "a release needs a weight", "release");
  const auto window = window_of(release, *index);
  TACTO_TRY(window);
  TACTO_TRY(check_above_noise(*window, channel));
  return gain_of(*window, *transducer, release.force_n);
}

// The mean. For several gains the uncertainty is the larger of the fits' and of the scatter.
Uncertain mean_of_gains(const std::vector<Uncertain>& gains) {
  const auto count = static_cast<double>(gains.size());
  double mean = 0, fits = 0, scatter = 0;
  for (const Uncertain& gain : gains)
    mean += gain.value / count, fits += std::pow(gain.uncertainty / count, 2);
  for (const Uncertain& gain : gains)
    scatter += std::pow(gain.value - mean, 2) / std::max(1.0, count - 1) / count;
  if (count > 1 && scatter > fits) return {mean, std::sqrt(scatter), count - 1};
  return {mean, std::sqrt(fits), gains.front().degrees_of_freedom};
}

}  // namespace

Result<ReleasedScale> scale_by_releases(std::span<const Release> releases, const std::string& channel,
                                        double relative) {
  std::vector<Uncertain> gains;
  for (const Release& release : releases) {
    const auto gain = gain_of(release, channel);
    TACTO_TRY(gain);
    gains.push_back(*gain);
  }
  if (gains.empty())
    return schema::fail(ErrorKind::usage, "a release is needed", "release", "for example --release 100g");
  const Uncertain gain = mean_of_gains(gains);
  const schema::RecordingHeader& header = releases.front().take.header;
  const double own_scale = header.channels[*schema::find_channel(header, channel)].scale;
  const double scale = own_scale / gain.value;
  ReleasedScale found;
  found.scale = {scale, std::abs(scale) * std::hypot(gain.uncertainty / gain.value, relative),
                 gain.degrees_of_freedom};
  found.notes = {
      fmt::format("{} releases, {:g} to {:g} Hz", gains.size(), kLowestRing_hz, kHighestRing_hz),
      fmt::format("uncertainty: {} (type A), and {:.2g} % common to all forces (type B)",
                  gains.size() > 1 ? "scatter of the releases or residuals of their fits, the larger"
                                   : "residuals of the fit; one release has no scatter",
                  100 * relative)};
  return found;
}

}  // namespace tacto::capture
