// SPDX-License-Identifier: GPL-3.0-or-later
// The options of a description, for `describe` and `corpus`.
#pragma once

#include "data-schema/command/verb.hpp"
#include "spatial/features/description.hpp"

namespace tacto::spatial {

/// Declares them on a parser; `options` must outlive it.
inline void declare_description(CLI::App& app, DescriptionOptions& options) {
  cli::add_quantity(app, "--window", options.window_m, schema::Dimension::length,
                    "Window of the spectrum [a quarter of the texture, or 8 times its longest wavelength]");
}

}  // namespace tacto::spatial
