// SPDX-License-Identifier: GPL-3.0-or-later
// What lies under a finger along its path, and what it asks for.
#pragma once

#include <cstddef>
#include <deque>
#include <span>
#include <vector>

#include "playback/model/finger_path.hpp"
#include "playback/model/texture_lookup.hpp"
#include "playback/prepare/prepare.hpp"
#include "playback/render/played_ends.hpp"
#include "playback/render/reference/exact_target.hpp"

namespace tacto::playback {

/// Textures where they lie, with what is beyond their ends, along one path. The path stays where it is.
class FeltPath {
 public:
  /// Errors: as as_played().
  static schema::Result<FeltPath> make(std::span<const PlacedTexture> textures, const FingerPath& path,
                                       Ends ends);

  /// Samples of the grid in which the finger is beside all of them.
  std::size_t count_outside(const ReadingGrid& grid) const;
  /// unsuitable, with where they lie.
  tl::unexpected<schema::Error> never_met() const;
  /// The widest of their ends' fades.
  double fade_m() const;
  /// As exact_wanted, of gain_m_per_n times all of them, each times its weight.
  PaddedSpectrum target(const ReadingGrid& grid, const spatial::Band& band, double gain_m_per_n,
                        double onset_s) const;

 private:
  struct Layer {
    TextureLookup lookup;
    double weight;
  };
  explicit FeltPath(const FingerPath& path) : path_(&path) {}

  const FingerPath* path_;
  std::deque<PlayedSignal> signals_;  // that the lookups refer to: they stay where they are
  std::vector<Layer> layers_;
  double start_m_ = 0, end_m_ = 0;
};

}  // namespace tacto::playback
