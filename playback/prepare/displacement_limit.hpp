// SPDX-License-Identifier: GPL-3.0-or-later
// Checks the transducer's displacement limit when the finger's path is not known in advance.
#pragma once

#include <string>

#include "playback/prepare/prepare.hpp"

namespace tacto::playback {

/// The largest displacement of the tray under this program, m, at its own gain: gain x the largest sample of
/// any level x the largest |chain x inverse| from 0 Hz to stops_at_hz. Fades and ramps of the playback stay
/// between such values. An upper bound for each frequency; two components that the inverse shifts against
/// each other (magnitude, gain) may add up to more. Uses the transducer's linear model, without uncompensated
/// hysteresis and without limits.
double tray_peak_m(const Prepared& prepared, const schema::Transducer& transducer,
                   const PrepareOptions& options);

/// Checks that the tray stays within the transducer's displacement_limit_m at `factor` times the program's
/// own gain. Errors: unsuitable, with the largest gain that fits, also as a factor of the default gain.
schema::Result<void> check_displacement(double peak_m, double factor, double gain_m_per_n,
                                        double default_gain_m_per_n, const schema::Transducer& transducer);

/// An addition to the remedy if the rate cuts the band and the largest displacement is above its end, where
/// the inverse is not constrained: a resonance may be there. Otherwise empty.
std::string rate_as_cause(const Prepared& prepared, const schema::Transducer& transducer,
                          const PrepareOptions& options);

}  // namespace tacto::playback
