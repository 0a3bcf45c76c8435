// SPDX-License-Identifier: GPL-3.0-or-later
// Finds faults of measurements and tables that a fit would hide.
#pragma once

#include "analysis/identify/fit/hysteresis_loop.hpp"
#include "analysis/identify/fit/response_fit.hpp"

namespace tacto::analysis {

/// Changes of the values that the user requested.
struct Turned {
  bool conjugated = false;  ///< --phase-sign -1
  bool inverted = false;    ///< --invert
};

/// Before a fit. Errors: unsuitable, with the option that corrects it: all of a table's degrees are within 2
/// pi, and their residual as radians is less than a quarter of that as degrees.
schema::Result<void> check_units(const BodeData& data, const ModelChoice& choice,
                                 const schema::Transducer& base);

/// Before a fit. Errors: unsuitable, with a remedy: phases that increase instead of decreasing (the other
/// sign convention), an inverted response, or both (whichever has the smallest residual; the message names a
/// given option that has to be left out); a step of half a turn between neighbours without a decrease of the
/// amplitude (phases unwrapped with a period of 180 degrees). Each is reported only if the changed data have
/// less than a quarter of the unchanged data's residual. Jumps of whole turns do not matter: values are
/// complex.
schema::Result<void> check_phases(const BodeData& data, const ModelChoice& choice,
                                  const schema::Transducer& base, Turned turned = {});

/// Before a fit: check_bode(), check_units() and check_phases().
schema::Result<void> check_measured(const BodeData& data, const ModelChoice& choice,
                                    const schema::Transducer& base, Turned turned);

/// After a fit. Errors: unsuitable: a table that is a misfit, whose residual is noise (R^2 above 0.99) if its
/// amplitudes are taken as levels in decibels and fitted by the same model.
schema::Result<void> check_levels(const ResponseFit& fit, const schema::Transducer& base);

/// Errors: unsuitable: a gain of more than 200 times the base's or less than a 200th, with the unit that
/// would explain it.
schema::Result<void> check_size(const ResponseFit& fit, const schema::Transducer& base);
/// Errors: unsuitable: a resonance more than 3.5 times above or below the base's (a bender of this kind has
/// none there), with the unit of frequency that would explain it. Fits of a finger's load, and fits without
/// intervals, are not checked.
schema::Result<void> check_frequencies(const ResponseFit& fit, const schema::Transducer& base);
/// The same for loops, against the base at 0 Hz; also a negative gain: the answer is inverted.
schema::Result<void> check_size(const LoopFit& fit, const schema::Transducer& base,
                                const std::string& source);
schema::Result<void> check_upright(const LoopFit& fit, const std::string& source, bool inverted = false);

}  // namespace tacto::analysis
