// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/model/chain.hpp"

#include <cmath>
#include <numbers>

namespace tacto::playback {
namespace {

std::complex<double> hold_response(const Chain& chain, double frequency_hz) {
  const double half_angle = std::numbers::pi * frequency_hz / chain.sample_rate_hz;
  if (chain.hold == Hold::none || half_angle == 0) return 1;
  return std::polar(std::sin(half_angle) / half_angle, -half_angle);
}

// actuator_response contains the filter of the transducer's file.
std::complex<double> filter_response(const Chain& chain, double frequency_hz) {
  if (chain.reconstruction == Reconstruction::none) return 1;
  const auto named = schema::butterworth3_response(chain.reconstruction_cutoff_hz, frequency_hz);
  const auto& own_hz = chain.transducer.reconstruction_cutoff_hz;
  return own_hz ? named / schema::butterworth3_response(*own_hz, frequency_hz) : named;
}

}  // namespace

double kept_in_a_tick(double pole_hz, double rate_hz) {
  return std::exp(-2 * std::numbers::pi * pole_hz / rate_hz);
}

std::complex<double> lead_response(const Chain& chain, double frequency_hz) {
  if (!(chain.compensated_pole_hz > 0)) return 1;
  const double a = kept_in_a_tick(chain.compensated_pole_hz, chain.sample_rate_hz);
  return (1.0 - std::polar(a, -2 * std::numbers::pi * frequency_hz / chain.sample_rate_hz)) / (1 - a);
}

std::complex<double> chain_response(const Chain& chain, double frequency_hz) {
  return schema::actuator_response(chain.transducer, frequency_hz) * filter_response(chain, frequency_hz) *
         hold_response(chain, frequency_hz) * lead_response(chain, frequency_hz);
}

std::complex<double> inverse_response(const Chain& chain, Inverse inverse, double frequency_hz) {
  if (inverse == Inverse::full) return 1.0 / chain_response(chain, frequency_hz);
  if (inverse == Inverse::magnitude) return 1.0 / std::abs(chain_response(chain, frequency_hz));
  if (inverse == Inverse::none) return chain.transducer.drive_limit_v / chain.transducer.displacement_limit_m;
  return 1.0 / std::abs(chain_response(chain, 0));
}

}  // namespace tacto::playback
