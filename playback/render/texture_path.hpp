// SPDX-License-Identifier: GPL-3.0-or-later
// The textures under a finger along its path, and the target displacement.
#pragma once

#include <cstddef>
#include <deque>
#include <span>
#include <vector>

#include "playback/model/finger_path.hpp"
#include "playback/model/texture_lookup.hpp"
#include "playback/prepare/prepare.hpp"
#include "playback/render/loop_seam.hpp"
#include "playback/render/reference/exact_target.hpp"

namespace tacto::playback {

/// Textures at their positions, continued beyond their ends, along one path. The path must outlive this.
class TexturePath {
 public:
  /// Errors: as as_played().
  static schema::Result<TexturePath> make(std::span<const PlacedTexture> textures, const FingerPath& path,
                                          Ends ends);

  /// Number of grid samples at which the finger is outside all textures.
  std::size_t count_outside(const ReadingGrid& grid) const;
  /// The error for a path outside all textures: unsuitable, with their positions.
  tl::unexpected<schema::Error> outside_textures() const;
  /// The widest fade at their ends.
  double fade_m() const;
  /// As exact_target, for the sum of the textures, each times its weight and gain_m_per_n.
  PaddedSpectrum target(const ReadingGrid& grid, const spatial::Band& band, double gain_m_per_n,
                        double onset_s) const;

 private:
  struct Layer {
    TextureLookup lookup;
    double weight;
  };
  explicit TexturePath(const FingerPath& path) : path_(&path) {}

  const FingerPath* path_;
  std::deque<PlayedSignal> signals_;  // the lookups refer to these, so they must not move
  std::vector<Layer> layers_;
  double start_m_ = 0, end_m_ = 0;
};

}  // namespace tacto::playback
