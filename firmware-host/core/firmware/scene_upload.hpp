// SPDX-License-Identifier: Apache-2.0
// Receives a scene part by part.
#pragma once

#include "firmware-host/core/firmware/profile_upload.hpp"
#include "firmware-host/core/scene/scene_block.hpp"

namespace tacto::core {

/// Stores the block in memory of the board, followed by the memory for what changes while it plays. Parts
/// come in order; a repeated part is written again. Only a block that read_scene_block() accepts can be
/// armed. For the main loop.
class SceneUpload {
 public:
  /// `memory` holds `words` numbers of 4 bytes.
  SceneUpload(float* memory, uint32_t words) noexcept : memory_(memory), words_(words) {}

  uint32_t most_bytes() const noexcept { return (words_ - live_words()) * 4; }
  Reply part(const wire::ScenePart& message) noexcept;
  void forget() noexcept { here_ = 0, complete_ = false; }

  bool complete() const noexcept { return complete_; }
  uint32_t here() const noexcept { return here_; }
  const SceneView& view() const noexcept { return view_; }
  float* live() const noexcept { return memory_ + (words_ - live_words()); }

 private:
  // SceneView::live_words() of the largest scene; in a small memory a block of half of it cannot need more.
  uint32_t live_words() const noexcept {
    constexpr uint32_t kMost =
        kMostSceneLayers * (kMostLayerNumbers + kPatchWords) + kMostSceneBodies * (kBodyStateWords + 1);
    return words_ / 2 < kMost ? words_ / 2 : kMost;
  }

  float* memory_;
  uint32_t words_;
  uint32_t bytes_ = 0, here_ = 0;
  bool complete_ = false;
  SceneView view_;
};

}  // namespace tacto::core
