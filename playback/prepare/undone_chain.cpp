// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/prepare/undone_chain.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "playback/prepare/pyramid.hpp"

namespace tacto::playback {
namespace {

using Complex = std::complex<double>;

// During the fade between two levels, each half an octave apart, content up to twice the band's edge is
// present.
constexpr double kStopOverBand = 2 * kStopOverPass;

Complex response_at(const std::vector<float>& taps, double radians_per_tick) {
  const Complex turn = std::polar(1.0, -radians_per_tick);
  Complex sum = 0;
  for (auto tap = taps.rbegin(); tap != taps.rend(); ++tap) sum = sum * turn + double{*tap};
  return sum;
}

}  // namespace

bool undoes_hysteresis(const schema::Transducer& transducer, const PrepareOptions& options) {
  return options.undo_hysteresis && transducer.hysteresis;
}

UndoneChain undone_chain(const schema::Transducer& transducer, const PrepareOptions& o) {
  UndoneChain undone{{transducer, o.reconstruction, o.reconstruction_cutoff_hz, o.hold, o.rate_hz}, {}, 0};
  if (undoes_hysteresis(transducer, o))
    undone.chain.compensated_pole_hz = schema::actuator_pole_hz(transducer);
  const double passes_to_hz = std::min(o.band.high_hz, o.rate_hz / (1 + kStopOverBand));
  undone.band = {std::min(o.band.low_hz, 0.5 * passes_to_hz), passes_to_hz};
  undone.stops_at_hz = kStopOverBand * passes_to_hz;
  return undone;
}

InverseFilter inverse_of(const UndoneChain& undone, const PrepareOptions& o) {
  const InverseDesign design{o.delay_s, 20, undone.stops_at_hz, o.inverse_taps};
  return inverse_filter(undone.chain, o.inverse, undone.band, design);
}

double largest_inverse_error(const UndoneChain& undone, const InverseFilter& filter) {
  double largest = 0;
  for (double f = undone.band.low_hz; f <= undone.band.high_hz; f += 1) {
    const double w = 2 * std::numbers::pi * f;
    const Complex moved =
        response_at(filter.taps, w / undone.chain.sample_rate_hz) * chain_response(undone.chain, f);
    largest = std::max(largest, std::abs(moved - std::polar(1.0, -w * filter.delay_s)));
  }
  return largest;
}

}  // namespace tacto::playback
