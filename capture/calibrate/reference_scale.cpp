// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/calibrate/reference_scale.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>

#include "capture/calibrate/hann_line.hpp"
#include "data-schema/transducer/transducer.hpp"

namespace tacto::capture {
namespace {

using schema::ErrorKind;
using schema::Result;
using Complex = std::complex<double>;

constexpr double kLowest_hz = 15, kHighest_hz = 61, kApart_hz = 2;
constexpr double kWindow_s = 1, kShortestPush_s = 5, kLeastCoherence = 0.5;
constexpr std::size_t kFewestBins = 6;
// Windows that overlap by half are correlated: for Hann windows the coefficient is 1/6.
constexpr double kIndependent = 1 / (1 + 2.0 / 36);

struct Bin {
  double frequency_hz = 0;
  Complex ratio;  // reference / piezo, both in N by the nominal scales of the device
  double coherence = 0;
  double weight = 0;  // 1 / variance of ln |ratio|
};

struct Pair {
  std::span<const double> piezo, reference;
  double rate_hz;

  std::size_t window() const { return static_cast<std::size_t>(kWindow_s * rate_hz); }
  std::size_t windows() const { return (piezo.size() - window()) / (window() / 2) + 1; }
};

Bin bin_at(const Pair& pair, double frequency_hz) {
  double xx = 0, yy = 0;
  Complex xy;
  for (std::size_t k = 0; k < pair.windows(); ++k) {
    const std::size_t from = k * (pair.window() / 2);
    const Complex x = hann_line(pair.piezo.subspan(from, pair.window()), frequency_hz / pair.rate_hz);
    const Complex y = hann_line(pair.reference.subspan(from, pair.window()), frequency_hz / pair.rate_hz);
    xx += std::norm(x), yy += std::norm(y), xy += std::conj(x) * y;
  }
  const double coherence = std::min(std::norm(xy) / (xx * yy), 1 - 1e-9);
  const double n = kIndependent * static_cast<double>(pair.windows());
  return {frequency_hz, xy / xx, coherence, 2 * n * coherence / (1 - coherence)};
}

// The nominal newtons of the piezo are exact at 100 Hz. This is their error, a factor, at another frequency.
Complex shape(const schema::Transducer& transducer, double frequency_hz) {
  return schema::sensor_response(transducer, frequency_hz) * schema::nominal_newtons_per_volt(transducer);
}

std::vector<Bin> bins_of(const Pair& pair, const schema::Transducer& transducer) {
  std::vector<Bin> bins;
  for (double frequency_hz = kLowest_hz; frequency_hz <= kHighest_hz; frequency_hz += kApart_hz) {
    Bin bin = bin_at(pair, frequency_hz);
    bin.ratio *= shape(transducer, frequency_hz);
    if (bin.coherence >= kLeastCoherence) bins.push_back(bin);
  }
  return bins;
}

struct Fit {
  double log_ratio = 0, log_uncertainty = 0, per_hz2 = 0;
  double birge = 1;
};

Fit fitted(const std::vector<Bin>& bins) {
  double w = 0, x = 0, y = 0, xx = 0, xy = 0, left = 0;
  for (const Bin& bin : bins) {
    const double f2 = bin.frequency_hz * bin.frequency_hz, value = std::log(std::abs(bin.ratio));
    w += bin.weight, x += bin.weight * f2, y += bin.weight * value;
    xx += bin.weight * f2 * f2, xy += bin.weight * f2 * value;
  }
  const double spread = xx - x * x / w, slope = (xy - x * y / w) / spread, at_0 = (y - slope * x) / w;
  for (const Bin& bin : bins)
    left += bin.weight *
            std::pow(std::log(std::abs(bin.ratio)) - at_0 - slope * bin.frequency_hz * bin.frequency_hz, 2);
  const double birge = std::max(1.0, std::sqrt(left / (static_cast<double>(bins.size()) - 2)));
  return {at_0, birge * std::sqrt(1 / w + x * x / (w * w * spread)), slope, birge};
}

bool signs_differ(const std::vector<Bin>& bins) {
  double together = 0;
  for (const Bin& bin : bins) together += bin.weight * bin.ratio.real();
  return together < 0;
}

std::vector<double> newtons(const Take& take, std::size_t channel, double scale) {
  std::vector<double> values = take.codes[channel];
  for (double& value : values) value *= scale;
  return values;
}

bool clips(const Take& take, std::size_t channel) {
  const schema::Channel& properties = take.header.channels[channel];
  return std::ranges::any_of(take.codes[channel], [&](double code) {
    const double value = properties.physical(code);
    return (properties.range_max && value >= *properties.range_max) ||
           (properties.range_min && value <= *properties.range_min);
  });
}

Result<void> check(const Take& take, std::size_t channel, std::size_t reference) {
  const schema::Channel& properties = take.header.channels[channel];
  if (!take.header.transducer || properties.quantity != "tangential_force")
    return schema::fail(ErrorKind::unsuitable, "is not the transducer's own channel", properties.name,
                        "load cells are calibrated by weights: --mass 0g --mass 100g");
  if (take.header.channels[reference].unit != "N" || channel == reference)
    return schema::fail(ErrorKind::usage, "is not a force that can be a reference",
                        take.header.channels[reference].name, "for example --reference net_force");
  if (static_cast<double>(take.frames()) < kShortestPush_s * take.header.sample_rate_hz)
    return schema::fail(ErrorKind::unsuitable, fmt::format("needs at least {:g} s", kShortestPush_s),
                        properties.name);
  for (const std::size_t each : {channel, reference})
    if (clips(take, each))
      return schema::fail(ErrorKind::unsuitable, "is clipped", take.header.channels[each].name,
                          "pull with less force");
  return {};
}

std::vector<std::string> notes_on(const std::vector<Bin>& bins, const Fit& fit, const ReferenceScale& found,
                                  const std::string& reference) {
  return {
      fmt::format("against {} in {} bins from {:g} to {:g} Hz, coherence from {:.3f}", reference, bins.size(),
                  bins.front().frequency_hz, bins.back().frequency_hz, found.coherence),
      fmt::format("delay of the reference corrected by a line over f^2: {:.2g} % at the highest frequency",
                  found.extrapolated_percent),
      fmt::format("uncertainty: of that line, from the coherence (type A, factor {:.3g}), and of {}",
                  fit.birge, reference)};
}

}  // namespace

Result<ReferenceScale> scale_by_reference(const Take& take, const std::string& channel,
                                          const std::string& reference, const Uncertain& reference_scale) {
  const auto x = schema::find_channel(take.header, channel), y = schema::find_channel(take.header, reference);
  if (!x) return schema::fail(ErrorKind::usage, x.error().what, x.error().where, x.error().remedy);
  if (!y) return schema::fail(ErrorKind::usage, y.error().what, y.error().where, y.error().remedy);
  TACTO_TRY(check(take, *x, *y));
  const double own_scale = take.header.channels[*x].scale;
  const auto piezo = newtons(take, *x, own_scale), cell = newtons(take, *y, reference_scale.value);
  const auto bins = bins_of({piezo, cell, take.header.sample_rate_hz}, *take.header.transducer);
  if (bins.size() < kFewestBins)
    return schema::fail(ErrorKind::unsuitable,
                        fmt::format("has too little coherence with {} between {:g} and {:g} Hz", reference,
                                    kLowest_hz, kHighest_hz),
                        channel, "slide a finger back and forth on a rough surface for at least 10 s");
  if (signs_differ(bins))
    return schema::fail(ErrorKind::unsuitable, fmt::format("has the opposite sign of {}", reference), channel,
                        "check the direction in which the load cell is mounted, and its cable");
  const Fit fit = fitted(bins);
  ReferenceScale found;
  found.ratio = std::exp(fit.log_ratio);
  const double relative =
      std::hypot(fit.log_uncertainty, reference_scale.uncertainty / reference_scale.value);
  found.scale = {found.ratio * own_scale, std::abs(relative * found.ratio * own_scale),
                 static_cast<double>(bins.size()) - 2};
  found.coherence = std::ranges::min_element(bins, {}, &Bin::coherence)->coherence;
  found.extrapolated_percent = 100 * fit.per_hz2 * std::pow(bins.back().frequency_hz, 2);
  found.notes = notes_on(bins, fit, found, reference);
  return found;
}

}  // namespace tacto::capture
