// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/scene/scene_sample.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "firmware-host/core/scene/scene_kernel.hpp"
#include "playback/prepare/scene/scene_device.hpp"
#include "playback/render/reference/exact_noise.hpp"
#include "playback/render/reference/exact_scene.hpp"

namespace tacto::analysis {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

namespace {

// The patch, with the layer that is named alone.
Result<schema::Patch> sampled_part(const playback::PreparedScene& scene, const std::string& what) {
  for (const schema::Patch& patch : scene.patches) {
    if (patch.name == what) return patch;
    for (std::size_t i = 0; i < patch.layers.size(); ++i)
      if (what == fmt::format("{}.{}", patch.name, i)) {
        schema::Patch alone = patch;
        alone.layers = {patch.layers[i]};
        return alone;
      }
  }
  return fail(ErrorKind::not_found, fmt::format("the scene has no patch or layer '{}'", what), "--sample",
              "give the name of a patch, or NAME.INDEX of one of its layers; 'tactograph info' lists them");
}

}  // namespace

Result<SceneSample> sample_scene(const ScenePicture& picture, const std::string& what, double x_m,
                                 double y_m) {
  auto part = sampled_part(picture.prepared, what);
  TACTO_TRY(part);
  part->combine = schema::PatchCombine::topmost;
  const playback::PreparedScene alone = picture.prepared.with({*part});
  auto setup = playback::force_setup_of(*picture.device, picture.rate_hz);
  TACTO_TRY(setup);
  const core::SceneView view = alone.view();
  std::vector<float> live(view.live_words());
  core::SceneKernel kernel;
  kernel.set(view, *setup, live.data());
  std::int32_t counts[core::kMostAxes] = {};
  SceneSample sample;
  for (std::uint32_t i = 0; i < setup->axis_count; ++i) {
    if (setup->axes[i].along == core::AxisAlong::z) continue;
    const bool is_x = setup->axes[i].along == core::AxisAlong::x;
    const double step_m = picture.device->axes[i].encoder_step_m;
    counts[i] = static_cast<std::int32_t>(std::lround((is_x ? x_m : y_m) / step_m));
    (is_x ? sample.x_m : sample.y_m) = counts[i] * step_m;
  }
  const core::PlaneVector place{static_cast<float>(sample.x_m), static_cast<float>(sample.y_m)};
  if (!core::within_patch(view.patches[0], core::place_in_patch(view.patches[0], place)))
    return fail(ErrorKind::unsuitable,
                fmt::format("the place {:g} m, {:g} m is outside of the patch '{}'", sample.x_m, sample.y_m,
                            part->name),
                "--sample", "give a place in the patch, in the plane of the device");
  const playback::ExactScene exact(alone, *picture.device, picture.rate_hz);
  const playback::ExactScene::Vector force = exact.force_at({sample.x_m, sample.y_m}, {0, 0});
  sample.force_x_n = force.x, sample.force_y_n = force.y;
  const core::ForceOutput output = kernel.tick(counts, true);
  for (std::uint32_t i = 0; i < setup->axis_count; ++i) {
    if (setup->axes[i].along == core::AxisAlong::x) sample.kernel_x_n = double{output.unlimited_n[i]};
    if (setup->axes[i].along == core::AxisAlong::y) sample.kernel_y_n = double{output.unlimited_n[i]};
  }
  return sample;
}

NoiseValue sample_noise(double x, double y, double z) {
  const auto place = [](double cells) { return static_cast<core::Q32>(std::floor(cells * 0x1p32)); };
  return {playback::exact_noise(core::kPerlinNoise, x, y, z),
          double{core::noise(core::kPerlinNoise, place(x), place(y), place(z)).value}};
}

}  // namespace tacto::analysis
