// SPDX-License-Identifier: GPL-3.0-or-later
// The transducer's limit of displacement, where nobody knows the finger's path beforehand.
#pragma once

#include <string>

#include "playback/prepare/prepare.hpp"

namespace tacto::playback {

/// The furthest that the tray goes under a program that was prepared so, m, at its own gain: gain x the
/// largest sample of any level x the largest |chain x inverse| from 0 Hz to where nothing is played. What is
/// played fades, ramps and cross-fades between such values only. An upper bound for every frequency by
/// itself; two parts of a texture that the inverse shifts against each other (magnitude, gain) may add up to
/// more. It knows the transducer's model, and neither hysteresis that is kept nor what limits take away.
double tray_peak_m(const Prepared& prepared, const schema::Transducer& transducer,
                   const PrepareOptions& options);

/// Whether the tray stays within the transducer's displacement_limit_m at `factor` times the program's own
/// gain. Errors: unsuitable, with the largest factor and gain that fit.
schema::Result<void> check_displacement(double peak_m, double factor, double gain_m_per_n,
                                        const schema::Transducer& transducer);

/// What to add to the remedy where the rate cuts the band and the tray goes farthest above its end, where the
/// inverse is no longer held to anything: a resonance may lie there. Else empty.
std::string rate_as_cause(const Prepared& prepared, const schema::Transducer& transducer,
                          const PrepareOptions& options);

}  // namespace tacto::playback
