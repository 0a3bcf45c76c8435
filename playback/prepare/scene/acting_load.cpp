// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/prepare/scene/acting_load.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numeric>

#include "playback/prepare/scene/scene_device.hpp"

namespace tacto::playback {

ActingLoad load_of(const schema::ForceLayer& layer) {
  ActingLoad load;
  load.stiffness_n_per_m = local_stiffness_n_per_m(layer);
  layer.visit([](const schema::SpringLayer& /*spring*/) {},
              [&](const schema::DamperLayer& damper) {
                load.least_damping_n_s_per_m = least_value(damper.damping_n_s_per_m);
                load.most_damping_n_s_per_m = largest_value(damper.damping_n_s_per_m);
              },
              [&](const schema::MoverLayer& mover) {
                load.least_damping_n_s_per_m = least_value(mover.damping_n_s_per_m);
                load.most_damping_n_s_per_m = largest_value(mover.damping_n_s_per_m);
              },
              [&](const schema::ForceMapLayer& map) {
                load.curl_n_per_m = std::abs(farthest_value(map.gain)) * map.curl_n_per_m;
              },
              [&](const auto& /*other*/) {
                if (!(load.stiffness_n_per_m > 0)) load.unknown = {std::string(type_of(layer))};
              });
  return load;
}

ActingLoad load_of(const std::vector<schema::Patch>& patches, const std::vector<std::size_t>& acting) {
  ActingLoad sum;
  for (const std::size_t i : acting)
    for (std::size_t j = 0; j < patches[i].layers.size(); ++j) {
      const ActingLoad load = load_of(patches[i].layers[j]);
      sum.stiffness_n_per_m += load.stiffness_n_per_m;
      sum.least_damping_n_s_per_m += load.least_damping_n_s_per_m;
      sum.most_damping_n_s_per_m += load.most_damping_n_s_per_m;
      sum.curl_n_per_m += load.curl_n_per_m;
      for (const std::string& type : load.unknown)
        sum.unknown.push_back(fmt::format("{} {} of patch '{}'", type, j, patches[i].name));
    }
  return sum;
}

std::vector<std::string> unknown_layers(const std::vector<schema::Patch>& patches) {
  std::vector<std::size_t> all(patches.size());
  std::iota(all.begin(), all.end(), 0);
  return load_of(patches, all).unknown;
}

}  // namespace tacto::playback
