// SPDX-License-Identifier: GPL-3.0-or-later
// One rendering as its engines see it.
#pragma once

#include <span>

#include "playback/model/chain.hpp"
#include "playback/model/finger_path.hpp"
#include "playback/prepare/prepare.hpp"
#include "playback/render/reference/padded_spectrum.hpp"
#include "playback/render/render.hpp"

namespace tacto::playback {

/// What both engines are given.
struct RenderJob {
  std::span<const PlacedTexture> textures;
  const FingerPath& path;
  const PaddedSpectrum& target;
  Chain chain;
  RenderOptions options;
};

}  // namespace tacto::playback
