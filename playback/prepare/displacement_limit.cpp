// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/prepare/displacement_limit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "data-schema/base/gain.hpp"
#include "data-schema/base/quantity.hpp"
#include "playback/model/chain.hpp"

namespace tacto::playback {
namespace {

constexpr int kPeakGrid = 512;
constexpr double kSinglePrecision = 1 + 1e-6;

double taps_response(const Prepared& prepared, double frequency_hz) {
  std::complex<double> sum = 0;
  const double turn = -2 * std::numbers::pi * frequency_hz / prepared.rate_hz;
  for (std::size_t i = 0; i < prepared.taps.size(); ++i)
    sum += double{prepared.taps[i]} * std::polar(1.0, turn * static_cast<double>(i));
  return std::abs(sum);
}

struct Peak {
  double at_hz = 0, most = 0;
};

// The peak of a sharp resonance is between the points of the grid.
template <class Response>
Peak highest_peak(double highest_hz, const Response& response) {
  constexpr int kRounds = 6, kPlaces = 8;
  double step_hz = highest_hz / kPeakGrid, best_hz = 0, most = response(0);
  const auto try_at = [&](double f) {
    if (const double here = response(std::clamp(f, 0.0, highest_hz)); here > most) most = here, best_hz = f;
  };
  for (int i = 1; i <= kPeakGrid; ++i) try_at(step_hz * i);
  for (int round = 0; round < kRounds; ++round, step_hz /= kPlaces) {
    const double middle_hz = best_hz;
    for (int i = -kPlaces; i <= kPlaces; ++i) try_at(middle_hz + step_hz * i / kPlaces);
  }
  return {std::clamp(best_hz, 0.0, highest_hz), most};
}

Peak tray_response(const Prepared& prepared, const schema::Transducer& transducer,
                   const PrepareOptions& options) {
  Chain chain{transducer, options.reconstruction, options.reconstruction_cutoff_hz, options.hold,
              prepared.rate_hz};
  if (!prepared.sections.empty()) chain.compensated_pole_hz = schema::actuator_pole_hz(transducer);
  const double highest_hz = std::min(prepared.stops_at_hz, prepared.rate_hz / 2);
  return highest_peak(
      highest_hz, [&](double f) { return std::abs(chain_response(chain, f)) * taps_response(prepared, f); });
}

}  // namespace

double tray_peak_m(const Prepared& prepared, const schema::Transducer& transducer,
                   const PrepareOptions& options) {
  float largest = 0;
  for (const float sample : prepared.samples) largest = std::max(largest, std::abs(sample));
  return tray_response(prepared, transducer, options).most * double{largest} * double{prepared.gain_m_per_n};
}

std::string rate_as_cause(const Prepared& prepared, const schema::Transducer& transducer,
                          const PrepareOptions& options) {
  const double at_hz = tray_response(prepared, transducer, options).at_hz;
  if (prepared.passes_to_hz >= options.band.high_hz || at_hz <= prepared.passes_to_hz) return {};
  const double whole_at_hz = options.band.high_hz * prepared.rate_hz / prepared.passes_to_hz;
  return fmt::format(
      "; this would happen at {:.4g} Hz, above the band, which ends at {:.4g} Hz at {:g} ticks per second: "
      "from {:g} on (--rate; rate_hz in the configuration) the band is complete",
      at_hz, prepared.passes_to_hz, prepared.rate_hz, whole_at_hz);
}

schema::Result<void> check_displacement(double peak_m, double factor, double gain_m_per_n,
                                        double default_gain_m_per_n, const schema::Transducer& transducer) {
  const double limit_m = transducer.displacement_limit_m, reached_m = std::abs(factor) * peak_m;
  if (!(reached_m > kSinglePrecision * limit_m)) return {};
  return schema::fail(
      schema::ErrorKind::unsuitable,
      fmt::format("the tray's displacement could reach {}, its limit is {}",
                  schema::for_people(reached_m, schema::Dimension::length),
                  schema::for_people(limit_m, schema::Dimension::length)),
      transducer.name,
      "the largest gain that fits is " +
          schema::gain_in_words(std::abs(gain_m_per_n) * limit_m / peak_m, std::abs(default_gain_m_per_n)));
}

}  // namespace tacto::playback
