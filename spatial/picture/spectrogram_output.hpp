// SPDX-License-Identifier: GPL-3.0-or-later
// Spectrograms as files, the form chosen by each path's extension: .png, .svg, .nc, .csv.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "data-schema/error.hpp"
#include "data-schema/spectrogram.hpp"
#include "spatial/picture/spectrogram_figure.hpp"

namespace tacto::spatial {

/// Before any work is done: whether each path has a known extension, is named once, and can be written.
/// Errors: usage; cannot_write.
schema::Result<void> check_outputs(std::span<const std::string> paths);

/// Writes all files; they appear together or not at all. Precondition: check_outputs(paths).
/// Errors: those of the figure and of the spectrogram's writers.
schema::Result<void> write_outputs(std::span<const std::string> paths, const SpectrogramFigure& figure,
                                   std::span<const schema::Spectrogram> spectrograms);

}  // namespace tacto::spatial
