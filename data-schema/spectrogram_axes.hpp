// SPDX-License-Identifier: GPL-3.0-or-later
// What the files of spectrograms share: the units they are written in, and axes that fit. Internal to this
// folder.
#pragma once

#include <span>
#include <string>

#include "data-schema/spectrogram.hpp"

namespace tacto::schema {

inline constexpr double kMillimetres = 1e3;  ///< in a metre; also unit^2 mm in one unit^2 m

/// The density's unit as UDUNITS reads it: "N2 mm", "(m/s)2 mm", "mm" for the unit "1".
std::string density_unit(const std::string& unit);

/// Whether all share frequency axis, quantity, windowing, and (up to the end of the shorter) positions.
/// Errors: unsuitable, naming what differs; or where there is no spectrogram, or an empty one.
Result<void> check_axes(std::span<const Spectrogram> spectrograms);

/// The one with the most positions. Precondition: there is one.
const Spectrogram& longest(std::span<const Spectrogram> spectrograms);

}  // namespace tacto::schema
