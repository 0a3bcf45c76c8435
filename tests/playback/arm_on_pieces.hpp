// SPDX-License-Identifier: GPL-3.0-or-later
// Pieces in space on the preset arm without limits, at 1 kHz: the kernel, the ghost point alone, and the
// reference in double precision.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "firmware-host/core/scene/scene_kernel.hpp"
#include "playback/prepare/scene/scene_device.hpp"
#include "playback/render/reference/exact_scene.hpp"
#include "tests/playback/unlimited_device.hpp"

namespace tacto::playback {

struct ArmOnPieces {
  using Place = std::array<double, 3>;

  double step_m;
  schema::Device device;
  core::ForceSetup setup;
  PreparedScene scene;
  std::vector<float> live;
  core::SceneView view;
  core::SceneKernel kernel;
  core::GhostPoint ghost;
  std::optional<ExactScene> exact;
  /// Of the reference, and of the kernel from it, since the beginning.
  double largest_n = 0, largest_error_n = 0;

  explicit ArmOnPieces(const std::vector<schema::Piece>& pieces, double encoder_step_m = 1e-6,
                       schema::PieceContact contact = schema::PieceContact::ghost)
      : step_m(encoder_step_m), device(unlimited_device(encoder_step_m, "arm")) {
    schema::Scene of;
    of.pieces = pieces;
    of.contact = contact;
    setup = *force_setup_of(device, 1000);
    setup.onset_s = 0;
    auto prepared = prepare_scene(of, "s.scene.json", device, 1000);
    EXPECT_TRUE(prepared) << schema::message(prepared.error());
    scene = std::move(*prepared);
    view = scene.view();
    live.resize(view.live_words());
    kernel.set(view, setup, live.data());
    exact.emplace(scene, device, 1000);
  }
  std::vector<std::int32_t> counts_of(const Place& place_m) const {
    std::vector<std::int32_t> counts;
    for (const double along_m : place_m)
      counts.push_back(static_cast<std::int32_t>(std::lround(along_m / step_m)));
    return counts;
  }
  /// N, by the kernel, a tick later.
  Place at(const Place& place_m) {
    const core::ForceOutput output = kernel.tick(counts_of(place_m).data(), true);
    return {double{output.unlimited_n[0]}, double{output.unlimited_n[1]}, double{output.unlimited_n[2]}};
  }
  /// Also in double precision.
  void compare_at(const Place& place_m) {
    const Place force_n = at(place_m);
    const auto reference = exact->tick(counts_of(place_m)).unlimited_n;
    for (std::size_t i = 0; i < 3; ++i) {
      largest_n = std::max(largest_n, std::abs(reference[i]));
      largest_error_n = std::max(largest_error_n, std::abs(force_n[i] - reference[i]));
    }
  }
  /// m, of the ghost point alone, which shares `live` with the kernel.
  Place ghost_at(const Place& place_m) {
    const auto counts = counts_of(place_m);
    const auto single = static_cast<float>(step_m);
    const float steps[3] = {single, single, single};
    ghost.force(view, live.data(), {{counts[0], counts[1], counts[2]}, {}}, steps, setup);
    const core::SpacePlace& at = ghost.place();
    return {at.counts[0] * step_m + double{at.rest_m.x}, at.counts[1] * step_m + double{at.rest_m.y},
            at.counts[2] * step_m + double{at.rest_m.z}};
  }
};

}  // namespace tacto::playback
