// SPDX-License-Identifier: GPL-3.0-or-later
// Common parts of spectrogram files: the comparison of axes. Internal to this folder.
#pragma once

#include <optional>
#include <string>

#include "data-schema/spectrogram/spectrogram.hpp"

namespace tacto::schema {

inline constexpr double kMillimetres = 1e3;  ///< in a metre; also unit^2 mm in one unit^2 m

/// Checks that a header has cells, and shares frequency axis, quantity, scaling, windowing, and (up to the
/// end of the shorter) positions with the first one of the file. Errors: unsuitable, naming the difference.
Result<void> check_axes(const std::optional<SpectrogramHeader>& first, const SpectrogramHeader& header);

}  // namespace tacto::schema
