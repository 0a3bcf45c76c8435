// SPDX-License-Identifier: GPL-3.0-or-later
// What the files of spectrograms share: the units they are written in, and axes that fit. Internal to this
// folder.
#pragma once

#include <optional>
#include <string>

#include "data-schema/spectrogram/spectrogram.hpp"

namespace tacto::schema {

inline constexpr double kMillimetres = 1e3;  ///< in a metre; also unit^2 mm in one unit^2 m

/// The cells' unit as UDUNITS reads it: densities "N2 mm", "(m/s)2 mm", "mm" for the unit "1"; amplitudes
/// "N", "m/s", "1".
std::string cell_unit(const SpectrogramHeader& header);

/// What brings a cell to that unit.
float cell_factor(Scaling scaling);

/// Whether a header has cells, and shares frequency axis, quantity, scaling, windowing, and (up to the end of
/// the shorter) positions with the file's first. Errors: unsuitable, naming what differs.
Result<void> check_axes(const std::optional<SpectrogramHeader>& first, const SpectrogramHeader& header);

}  // namespace tacto::schema
