// SPDX-License-Identifier: GPL-3.0-or-later
// Faults of measuring and of writing down that a fit would hide.
#pragma once

#include "analysis/identify/fit/hysteresis_loop.hpp"
#include "analysis/identify/fit/response_fit.hpp"

namespace tacto::analysis {

/// How values were turned on request before they were looked at.
struct Turned {
  bool conjugated = false;  ///< --phase-sign -1
  bool inverted = false;    ///< --invert
};

/// Before a fit. Errors: unsuitable, with the option that puts it right: a table's degrees that are all
/// within 2 pi, and that leave less than a quarter of what they leave where they are taken for radians.
schema::Result<void> check_units(const BodeData& data, const ModelChoice& choice,
                                 const schema::Transducer& base);

/// Before a fit. Errors: unsuitable, with what would put it right: phases that grow where they must fall (the
/// other sign convention), a response upside down, or both (whichever leaves least; an option that was given
/// and should not have been is named as to be left out), a step of half a turn between neighbours where the
/// amplitude does not fall (phases unwrapped as if they had a period of 180 degrees): each only where the
/// data, so changed, leave less than a quarter of what they leave as they are. Jumps of whole turns do not
/// matter: values are complex.
schema::Result<void> check_phases(const BodeData& data, const ModelChoice& choice,
                                  const schema::Transducer& base, Turned turned = {});

/// Before a fit: check_bode(), check_units() and check_phases().
schema::Result<void> check_measured(const BodeData& data, const ModelChoice& choice,
                                    const schema::Transducer& base, Turned turned);

/// After it. Errors: unsuitable: a table that is a misfit, and whose amplitudes leave noise only (R^2 above
/// 0.99) where they are taken for levels in decibels.
schema::Result<void> check_levels(const ResponseFit& fit, const ModelChoice& choice,
                                  const schema::Transducer& base);

/// Errors: unsuitable: a gain more than 200 times the base's or less than a 200th, with the unit
/// that would explain it.
schema::Result<void> check_size(const ResponseFit& fit, const schema::Transducer& base);
/// A resonance more than 3.5 times the base's or less than that below it (a bender of this kind has none
/// there), with the unit of frequency that would explain it. Of a finger's load nothing is
/// said, nor of a fit that claims nothing.
schema::Result<void> check_frequencies(const ResponseFit& fit, const schema::Transducer& base);
/// Of loops, against the base at rest, likewise; and a negative gain: the answer is upside down.
schema::Result<void> check_size(const LoopFit& fit, const schema::Transducer& base,
                                const std::string& source);
schema::Result<void> check_upright(const LoopFit& fit, const std::string& source, bool inverted = false);

}  // namespace tacto::analysis
