// SPDX-License-Identifier: GPL-3.0-or-later
// Writes spectrograms row by row: the memory does not grow with their length.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "data-schema/base/error.hpp"
#include "data-schema/spectrogram/spectrogram.hpp"

namespace tacto::schema {

struct SpectrogramFileOptions {
  /// A leading dimension (or column) `stroke`, also for a single spectrogram.
  bool several = false;
  /// netCDF: deflate the cells. They are mostly noise: a few times slower to write, and hardly smaller.
  bool compress = false;
  /// The file's name in errors, if it is written under a temporary name.
  std::string named = {};
};

/// For each spectrogram call begin(), then rows() by growing position until all of its header's positions are
/// written; call close() after the last. Without close() the file is incomplete: write under a temporary name
/// (PendingFiles).
class SpectrogramWriter {
 public:
  SpectrogramWriter() = default;
  SpectrogramWriter(const SpectrogramWriter&) = delete;
  SpectrogramWriter& operator=(const SpectrogramWriter&) = delete;
  virtual ~SpectrogramWriter() = default;

  /// Errors: unsuitable, without cells, or where axes differ from the first one's; cannot_write.
  virtual Result<void> begin(const SpectrogramHeader& header) = 0;
  /// Whole rows, as in Spectrogram::cells, from row `first` of the current spectrogram. Errors: cannot_write.
  virtual Result<void> rows(std::size_t first, std::span<const float> cells) = 0;
  /// Errors: cannot_write; unsuitable, without a spectrogram.
  virtual Result<void> close() = 0;
};

/// Writers of the formats of write_spectrogram_nc() and write_spectrogram_csv(). Errors: cannot_write, then
/// or later.
Result<std::unique_ptr<SpectrogramWriter>> open_spectrogram_nc(const std::string& path,
                                                               const SpectrogramFileOptions& options);
Result<std::unique_ptr<SpectrogramWriter>> open_spectrogram_csv(const std::string& path,
                                                                const SpectrogramFileOptions& options);

}  // namespace tacto::schema
