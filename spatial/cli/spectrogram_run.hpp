// SPDX-License-Identifier: GPL-3.0-or-later
// A run of 'tactograph spectrogram': computes texture after texture with one maker and writes all files.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/report/progress.hpp"
#include "data-schema/spectrogram/spectrogram.hpp"
#include "spatial/cli/spectrogram_files.hpp"
#include "spatial/cli/texture_inputs.hpp"
#include "spatial/spectrogram/spectrogram_maker.hpp"
#include "spatial/spectrogram/spectrogram_tally.hpp"

namespace tacto::spatial {

/// Stores only a few numbers of each spectrogram; with `keep` (for pictures) also all of it, and its texture.
class SpectrogramRun {
 public:
  struct Line {
    std::string name;
    std::size_t positions = 0;
    SpectrogramTally tally;
  };

  /// `lowest_per_m`: lower limit of the band over which the lines are summed. Default: that of the pictures.
  SpectrogramRun(const SpectrogramOptions& options, std::optional<double> lowest_per_m,
                 SpectrogramFiles& files, bool keep)
      : options_(options), asked_lowest_per_m_(lowest_per_m), files_(files), keep_(keep) {}

  /// Errors: of the inputs, the maker and the files; unsuitable, with both names, for a texture with another
  /// pitch or quantity than the first.
  schema::Result<void> transform(TextureInputs& inputs);

  /// After transform(): one line for each texture, and their common values.
  const std::vector<Line>& lines() const { return lines_; }
  const schema::SpectrogramHeader& first() const { return *first_; }
  const Decimation& decimation() const { return maker_->decimation(); }
  double lowest_per_m() const { return asked_lowest_per_m_.value_or(lowest_shown_per_m(lowest_, *first_)); }
  const std::vector<NamedTexture>& textures() const { return textures_; }
  const std::vector<schema::Spectrogram>& spectrograms() const { return spectrograms_; }

 private:
  schema::Result<void> take(NamedTexture texture);
  schema::Result<void> prepare(const NamedTexture& first);
  schema::Result<void> check_alike(const NamedTexture& other) const;
  schema::Result<void> make(const NamedTexture& texture, const schema::SpectrogramHeader& header);

  SpectrogramOptions options_;
  std::optional<double> asked_lowest_per_m_;
  SpectrogramFiles& files_;
  bool keep_;
  cli::Progress progress_{"spectrogram"};
  std::size_t expected_ = 0;
  std::optional<SpectrogramMaker> maker_;
  std::optional<schema::SpectrogramHeader> first_;
  std::string first_path_;
  double lowest_ = 0;
  std::vector<Line> lines_;
  std::vector<NamedTexture> textures_;
  std::vector<schema::Spectrogram> spectrograms_;
};

}  // namespace tacto::spatial
