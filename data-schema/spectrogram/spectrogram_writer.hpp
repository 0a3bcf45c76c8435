// SPDX-License-Identifier: GPL-3.0-or-later
// Spectrograms written row by row: what is in memory does not grow with them.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "data-schema/base/error.hpp"
#include "data-schema/spectrogram/spectrogram.hpp"

namespace tacto::schema {

struct SpectrogramFileOptions {
  /// A leading dimension (or column) `stroke`, though one only may come.
  bool several = false;
  /// netCDF: deflate the cells. Theirs is mostly noise: a few times slower to write, and hardly smaller.
  bool compress = false;
  /// What errors call the file, where it is written under a temporary name.
  std::string named = {};
};

/// For each spectrogram begin(), then rows() by growing position until all of its header's positions are
/// there; close() after the last. An object that is not closed leaves a file that is not sound: write under a
/// temporary name (PendingFiles).
class SpectrogramWriter {
 public:
  SpectrogramWriter() = default;
  SpectrogramWriter(const SpectrogramWriter&) = delete;
  SpectrogramWriter& operator=(const SpectrogramWriter&) = delete;
  virtual ~SpectrogramWriter() = default;

  /// Errors: unsuitable, without cells, or where axes differ from the first one's; cannot_write.
  virtual Result<void> begin(const SpectrogramHeader& header) = 0;
  /// Whole rows, as they stand in Spectrogram::cells, from row `first` of the spectrogram that was begun
  /// last. Errors: cannot_write.
  virtual Result<void> rows(std::size_t first, std::span<const float> cells) = 0;
  /// Errors: cannot_write; unsuitable, without a spectrogram.
  virtual Result<void> close() = 0;
};

/// What write_spectrogram_nc() and write_spectrogram_csv() write. Errors: cannot_write, then or later.
Result<std::unique_ptr<SpectrogramWriter>> open_spectrogram_nc(const std::string& path,
                                                               const SpectrogramFileOptions& options);
Result<std::unique_ptr<SpectrogramWriter>> open_spectrogram_csv(const std::string& path,
                                                                const SpectrogramFileOptions& options);

}  // namespace tacto::schema
