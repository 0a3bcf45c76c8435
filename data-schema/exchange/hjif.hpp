// SPDX-License-Identifier: GPL-3.0-or-later
// A texture as MPEG haptics in JSON (HJIF, ISO/IEC 23090-31): a curve through keyframes along position.
#pragma once

#include <cstddef>
#include <string>

#include "data-schema/base/error.hpp"
#include "data-schema/texture/texture.hpp"

namespace tacto::schema {

struct Hjif {
  std::string text;
  int step_um = 0;  ///< between keyframes
  std::size_t keyframes = 0;
  double peak_n = 0;    ///< is the channel's gain; the amplitudes are relative to it
  double error = 0;     ///< RMS of the curve minus the texture over the texture's RMS, at its samples
  double length_m = 0;  ///< of the curve: whole micrometres
};

/// The keyframes have the largest distance, in whole micrometres up to 100 (unit_exponent -6), at which the
/// error is at most `max_error`: "Main" profile, level 1, one perception "Vibrotactile Texture", one band
/// "Curve" with one effect. The curve is Akima's (J. ACM 17:589, 1970) with the ends of
/// scipy.interpolate.Akima1DInterpolator, through amplitudes in single precision, as the reference software
/// (MPEGGroup/HapticReferenceSoftware) reads them. The format has no member for the unit of force, the valid
/// band, the origin on the bench, direction and spread. Errors: unsuitable: not a force, shorter than 10 um,
/// only zeros, or not within `max_error` at 1 um, with the error there.
Result<Hjif> hjif_of(const Texture& texture, const std::string& description, double max_error);

}  // namespace tacto::schema
