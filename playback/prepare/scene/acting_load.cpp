// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/prepare/scene/acting_load.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "playback/prepare/scene/scene_device.hpp"

namespace tacto::playback {
namespace {

ActingLoad sum_of(const std::vector<schema::Patch>& patches, const std::vector<std::size_t>& acting) {
  ActingLoad sum;
  for (const std::size_t i : acting)
    for (std::size_t j = 0; j < patches[i].layers.size(); ++j) {
      const ActingLoad load = load_of(patches[i].layers[j]);
      sum.stiffness_n_per_m += load.stiffness_n_per_m;
      sum.least_damping_n_s_per_m += load.least_damping_n_s_per_m;
      sum.most_damping_n_s_per_m += load.most_damping_n_s_per_m;
      sum.repelling_n_per_m += load.repelling_n_per_m;
      sum.holding_n_per_m += load.holding_n_per_m;
      sum.curl_n_per_m += load.curl_n_per_m;
      const auto name = [&](const std::string& type) {
        return fmt::format("{} {} of patch '{}'", type, j, patches[i].name);
      };
      for (const std::string& type : load.unknown) sum.unknown.push_back(name(type));
      for (const ActingBody& body : load.bodies)
        sum.bodies.push_back({name(body.name), body.least, body.most});
    }
  return sum;
}

}  // namespace

std::vector<SampledLoad> ActingLoad::at_ends() const {
  std::set<std::vector<double>> done;
  std::vector<SampledLoad> ends;
  for (const double damping : std::set{least_damping_n_s_per_m, most_damping_n_s_per_m})
    for (const bool stiff : {true, false})
      for (const bool damped : {true, false}) {
        SampledLoad load{stiffness_n_per_m, damping, {}};
        std::vector<double> numbers;
        for (const auto& [name, least, most] : bodies) {
          CoupledBody& body = load.bodies.emplace_back(most);
          body.stiffness_n_per_m = (stiff ? most : least).stiffness_n_per_m;
          body.damping_n_s_per_m = (damped ? most : least).damping_n_s_per_m;
          numbers.insert(numbers.end(), {body.stiffness_n_per_m, body.damping_n_s_per_m});
        }
        numbers.push_back(damping);
        if (done.insert(numbers).second) ends.push_back(std::move(load));
      }
  return ends;
}

ActingLoad load_of(const schema::ForceLayer& layer) {
  ActingLoad load;
  load.stiffness_n_per_m = local_stiffness_n_per_m(layer);
  layer.visit(
      [&](const schema::SpringLayer& spring) {
        load.holding_n_per_m = least_value(spring.stiffness_n_per_m);
      },
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
        load.repelling_n_per_m = std::max({largest_value(map.gain) * map.repelling_n_per_m,
                                           -least_value(map.gain) * map.attracting_n_per_m, 0.0});
      },
      [&](const schema::BodyLayer& body) {
        const auto end = [&](double (*of)(const schema::LayerNumber&)) -> CoupledBody {
          return {body.mass_kg.value, 0, of(body.stiffness_n_per_m), of(body.damping_n_s_per_m),
                  largest_value(body.static_friction_n) > 0};
        };
        load.bodies = {{std::string(type_of(layer)), end(schema::least_value), end(schema::largest_value)}};
      },
      [&](const schema::LassoLayer& lasso) {
        const double own = lasso.damping_n_s_per_m.value;
        load.bodies = {{std::string(type_of(layer)),
                        {lasso.mass_kg.value, own, 0, 0, false},
                        {lasso.mass_kg.value, own, largest_value(lasso.stiffness_n_per_m), 0, false}}};
      },
      [&](const auto& /*other*/) {
        if (!(load.stiffness_n_per_m > 0)) load.unknown = {std::string(type_of(layer))};
      });
  return load;
}

ActingLoad load_of(const std::vector<schema::Patch>& patches, const std::vector<std::size_t>& acting) {
  ActingLoad sum = sum_of(patches, acting);
  if (sum.bodies.size() <= kMostActingBodies) return sum;
  for (const ActingBody& body : sum.bodies) sum.unknown.push_back(body.name);
  sum.bodies.clear();
  return sum;
}

std::vector<std::string> not_held_layers(const std::vector<schema::Patch>& patches) {
  std::vector<std::size_t> all(patches.size());
  std::iota(all.begin(), all.end(), 0);
  ActingLoad sum = sum_of(patches, all);
  for (const ActingBody& body : sum.bodies) sum.unknown.push_back(body.name);
  return sum.unknown;
}

}  // namespace tacto::playback
