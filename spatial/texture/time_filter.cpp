// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/texture/time_filter.hpp"

#include <fmt/format.h>

#include <cmath>

#include "spatial/dsp/filter/butterworth.hpp"
#include "spatial/texture/block_time_filter.hpp"

namespace tacto::spatial {
namespace {

using schema::ErrorKind;

}  // namespace

Band TimeFilter::passed(double sample_rate_hz) const {
  return method == FilterMethod::none ? Band{0, sample_rate_hz / 2} : band;
}

Band TimeFilter::kept(double sample_rate_hz) const {
  return method == FilterMethod::butterworth ? zero_phase_band(order, band, sample_rate_hz, kKeptAmplitude)
                                             : passed(sample_rate_hz);
}

std::string_view name_of(FilterMethod method) {
  switch (method) {
    case FilterMethod::fourier:
      return "fourier";
    case FilterMethod::butterworth:
      return "butterworth";
    case FilterMethod::none:
      break;
  }
  return "none";
}

std::string_view name_of(Edges edges) {
  return edges == Edges::treated ? "treated" : "none";
}

schema::Result<void> check(const TimeFilter& filter, double sample_rate_hz) {
  const auto [low_hz, high_hz] = filter.band;
  if (filter.method == FilterMethod::none) return {};
  if (!(low_hz >= 0 && low_hz < high_hz))
    return schema::fail(
        ErrorKind::unsuitable,
        fmt::format("the limits of the band {:g} Hz to {:g} Hz do not increase", low_hz, high_hz));
  if (high_hz > sample_rate_hz / 2)
    return schema::fail(
        ErrorKind::unsuitable,
        fmt::format("the band ends at {:g} Hz, but the recording at {:g} Hz", high_hz, sample_rate_hz / 2),
        {}, "use a band below half the sample rate, or --band off");
  if (filter.method == FilterMethod::fourier) return {};
  const auto sections = butterworth_band_pass(filter.order, filter.band, sample_rate_hz);
  return sections ? schema::Result<void>{} : schema::forward_error(sections);
}

SpectralGain equaliser(const schema::Transducer& transducer) {
  const double newtons_per_volt = schema::nominal_newtons_per_volt(transducer);
  return [transducer, newtons_per_volt](double frequency_hz) -> std::complex<double> {
    const std::complex<double> seen = schema::sensor_response(transducer, frequency_hz) * newtons_per_volt;
    const double size = std::abs(seen);
    if (size == 0) return 0;
    return size * kMostEqualiserGain >= 1 ? 1.0 / seen : std::conj(seen) / size * kMostEqualiserGain;
  };
}

schema::Result<std::vector<double>> filter_in_time(std::span<const double> values, double sample_rate_hz,
                                                   const TimeFilter& filter, const SpectralGain& equaliser) {
  auto fed = BlockTimeFilter::open(sample_rate_hz, filter, equaliser, values.size());
  TACTO_TRY(fed);
  std::vector<double> filtered;
  filtered.reserve(values.size());
  TACTO_TRY(fed->push(values, filtered));
  fed->finish(filtered);
  return filtered;
}

}  // namespace tacto::spatial
