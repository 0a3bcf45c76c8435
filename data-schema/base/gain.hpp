// SPDX-License-Identifier: GPL-3.0-or-later
// The gain of a texture as people write it: "2x", "200%" or "0.5mm/N".
#pragma once

#include <string>
#include <string_view>

#include "data-schema/base/error.hpp"

namespace tacto::schema {

/// A factor of the texture's default gain (that in its file, or 1mm/N; of a scene: the gains of its layers),
/// or displacement for force. A gain below 0 inverts the texture.
struct Gain {
  double value = 1;           ///< a factor, or m/N
  bool times_default = true;  ///< whether it is a factor

  double m_per_n(double default_m_per_n) const { return times_default ? value * default_m_per_n : value; }
};

/// The text of parse_gain, for help and messages.
inline constexpr std::string_view kGainForms =
    "a factor of the texture's default, as in 2x or 200%, or displacement for force, as in 0.5mm/N";

/// Errors: usage, for a bare number, an unknown unit, one of another quantity, NaN, infinity.
Result<Gain> parse_gain(std::string_view text);

/// "1.739mm/N (0.8695x)": a gain in both forms, rounded towards zero in the fourth digit, so that a largest
/// gain can be given as it is printed. Without the factor if the default is 0.
std::string gain_in_words(double gain_m_per_n, double default_m_per_n);

/// Towards zero, to four digits.
double rounded_down(double value);

}  // namespace tacto::schema
