// SPDX-License-Identifier: GPL-3.0-or-later
// From the force patches of a scene to the block that the kernel reads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "data-schema/scene/scene.hpp"
#include "firmware-host/core/scene/scene_block.hpp"

namespace tacto::playback {

/// The block, and the patches from which it was made, both from the topmost patch on.
struct PreparedScene {
  std::vector<schema::Patch> patches;
  std::vector<std::uint32_t> words;  ///< the block (core::SceneHeader), little-endian

  std::size_t bytes() const { return words.size() * sizeof(std::uint32_t); }
  /// Points into this object.
  core::SceneView view() const;
};

/// The bytes of a layer in the block.
std::size_t layer_bytes(const schema::ForceLayer& layer);

/// The members of a layer that are numbers in the block, in its order: they can change while the scene plays
/// (core::SceneKernel::change). Empty for a type that cannot be played yet.
std::vector<std::string_view> numbers_in_block(const schema::ForceLayer& layer);

/// Builds what the scene names and nothing else. Equal orders: the later patch is above. `where` is the
/// scene's file. Precondition: a scene as read_scene() gives it. Errors: unsuitable, if it has no patches; by
/// JSON pointer, for a type of layer that cannot be played yet (with those that can).
schema::Result<PreparedScene> prepare_scene(const schema::Scene& scene, const std::string& where);

}  // namespace tacto::playback
