// SPDX-License-Identifier: GPL-3.0-or-later
// Fidelity as figures, pictures, and one HTML page that needs no other files.
#pragma once

#include <string>
#include <vector>

#include "analysis/fidelity/fidelity.hpp"
#include "data-schema/results/results.hpp"

namespace tacto::analysis {

/// The error for each speed and tray, and what was removed from the texture at each speed.
std::vector<schema::ResultFigure> fidelity_figures(const Fidelity& fidelity);

/// For each speed: the error by band of every tray, and a section of target and displacement (the first and
/// the last tray).
std::vector<schema::ResultPicture> fidelity_pictures(const Fidelity& fidelity);

/// Errors: those of drawing.
schema::Result<std::string> fidelity_page(const Fidelity& fidelity);

}  // namespace tacto::analysis
