// SPDX-License-Identifier: GPL-3.0-or-later
// The input of one rendering, for both engines.
#pragma once

#include <span>

#include "playback/model/chain.hpp"
#include "playback/model/finger_path.hpp"
#include "playback/prepare/prepare.hpp"
#include "playback/render/reference/padded_spectrum.hpp"
#include "playback/render/render.hpp"

namespace tacto::playback {

struct RenderJob {
  std::span<const PlacedTexture> textures;
  const FingerPath& path;
  const PaddedSpectrum& target;
  Chain chain;
  RenderOptions options;
};

}  // namespace tacto::playback
