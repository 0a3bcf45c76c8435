// SPDX-License-Identifier: GPL-3.0-or-later
// The frequency response from the drive's samples to the tray, and its inverse.
#pragma once

#include <complex>

#include "data-schema/transducer/transducer.hpp"

namespace tacto::playback {

/// The analog filter after the converter. A filter that is named here replaces that of the transducer's file.
enum class Reconstruction { none, butterworth3 };
/// Whether samples are points of a band-limited signal, or the converter holds each one until the next.
enum class Hold { none, zero_order };
/// What the drive compensates: amplitude and phase of the chain, the amplitude only, the gain at rest only,
/// or nothing.
enum class Inverse { full, magnitude, gain, none };

/// From the drive's samples to the tray's displacement.
struct Chain {
  schema::Transducer transducer;
  Reconstruction reconstruction = Reconstruction::none;
  double reconstruction_cutoff_hz = 600;  ///< Wiertlewski 2011
  Hold hold = Hold::none;
  double sample_rate_hz = 10e3;
  /// The pole that a section after the filter compensates (hysteresis_inverse.hpp); 0: none.
  double compensated_pole_hz = 0;
};

/// Response of the actuator (equations 5 and 6 of Wiertlewski 2011), times those of the filter and the hold
/// if there are any, m/V. The hold is sinc(f / rate) exp(-i pi f / rate); its images above half the rate are
/// not included.
std::complex<double> chain_response(const Chain& chain, double frequency_hz);
/// Factor by which the charge of a low-pass with this pole decays in a tick: exp(-2 pi pole / rate).
double kept_in_a_tick(double pole_hz, double rate_hz);
/// Response of the section that compensates compensated_pole_hz, 1; a factor of chain_response.
std::complex<double> lead_response(const Chain& chain, double frequency_hz);

/// The spectrum of the drive is that of the target displacement times this, V/m. `full` is 1 /
/// chain_response, without delay; `none` does not use the response: it is the drive's limit over the
/// displacement's.
std::complex<double> inverse_response(const Chain& chain, Inverse inverse, double frequency_hz);

}  // namespace tacto::playback
