// SPDX-License-Identifier: GPL-3.0-or-later
// The outputs of a run of 'tactograph spectrogram': tables and netCDF row by row, pictures at the end; they
// appear together or not at all.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/spectrogram/spectrogram_writer.hpp"
#include "spatial/picture/figure.hpp"

namespace tacto::spatial {

class SpectrogramFiles {
 public:
  /// Precondition: check_outputs(paths). Errors: cannot_write.
  schema::Result<void> open(std::span<const std::string> paths, bool several, bool compress);
  /// Whether a figure is needed.
  bool has_pictures() const { return !pictures_.empty(); }

  /// Calls SpectrogramWriter::begin() of every table and netCDF file.
  schema::Result<void> begin(const schema::SpectrogramHeader& header);
  schema::Result<void> rows(std::size_t first, std::span<const float> cells);

  /// Ends all files, draws the pictures (`figure` may be null if there are none) and renames all files
  /// together. Errors: of the writers and the figure; cannot_write; usage, if a file that must not be
  /// replaced has the name.
  schema::Result<void> finish(const Figure* figure, schema::Existing existing);

 private:
  schema::PendingFiles pending_;
  std::vector<std::unique_ptr<schema::SpectrogramWriter>> writers_;
  std::vector<std::string> pictures_;
};

}  // namespace tacto::spatial
