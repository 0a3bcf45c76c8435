// SPDX-License-Identifier: GPL-3.0-or-later
// Fidelity as figures, pictures, and one page that needs nothing beside it.
#pragma once

#include <string>
#include <vector>

#include "analysis/fidelity/fidelity.hpp"
#include "data-schema/results/results.hpp"

namespace tacto::analysis {

/// One for each speed and tray: the error; and what was taken away at each speed.
std::vector<schema::ResultFigure> fidelity_figures(const Fidelity& fidelity);

/// For each speed: the error by band of every tray, and a stretch of wanted and felt (the first tray and the
/// last).
std::vector<schema::ResultPicture> fidelity_pictures(const Fidelity& fidelity);

/// Errors: of drawing.
schema::Result<std::string> fidelity_page(const Fidelity& fidelity);

}  // namespace tacto::analysis
