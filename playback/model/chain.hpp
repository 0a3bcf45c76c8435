// SPDX-License-Identifier: GPL-3.0-or-later
// What lies between the drive's samples and the tray, as a frequency response, and how playback undoes it.
#pragma once

#include <complex>

#include "data-schema/transducer/transducer.hpp"

namespace tacto::playback {

/// The analog filter behind the converter.
enum class Reconstruction { none, butterworth3 };
/// How the converter keeps a sample: points of a band-limited signal, or held until the next one.
enum class Hold { none, zero_order };
/// How much of the chain the drive undoes: amplitude and phase, amplitude alone, only the gain at rest, or
/// nothing.
enum class Inverse { full, magnitude, gain, none };

/// From the drive's samples to the tray's displacement.
struct Chain {
  schema::Transducer transducer;
  Reconstruction reconstruction = Reconstruction::none;
  double reconstruction_cutoff_hz = 600;  ///< Wiertlewski 2011
  Hold hold = Hold::none;
  double sample_rate_hz = 10e3;
  /// The pole that a section behind the filter undoes (hysteresis_inverse.hpp), 0: none.
  double led_pole_hz = 0;
};

/// Actuator (equations 5 and 6 of Wiertlewski 2011), times the filter's and the hold's response where there
/// are any, m/V. The hold's is sinc(f / rate) exp(-i pi f / rate); its images above half the rate are not in
/// it.
std::complex<double> chain_response(const Chain& chain, double frequency_hz);
/// What a low-pass with this pole keeps of its charge in a tick: exp(-2 pi pole / rate).
double kept_in_a_tick(double pole_hz, double rate_hz);
/// Of the section that undoes led_pole_hz, 1; it is a part of chain_response.
std::complex<double> lead_response(const Chain& chain, double frequency_hz);

/// What a wanted displacement's spectrum is multiplied by to get the drive's, V/m. `full` is 1 /
/// chain_response, with no delay; `none` knows nothing of the response: the drive's limit for the
/// displacement's.
std::complex<double> inverse_response(const Chain& chain, Inverse inverse, double frequency_hz);

}  // namespace tacto::playback
