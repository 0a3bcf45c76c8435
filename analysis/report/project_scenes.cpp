// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes, force devices and hands.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/report/project_readers.hpp"
#include "data-schema/base/quantity.hpp"
#include "data-schema/device/device.hpp"
#include "data-schema/device/hand.hpp"
#include "data-schema/scene/scene.hpp"

namespace tacto::analysis {
namespace {

using schema::Dimension;
using schema::for_people;
using schema::length_for_people;
using schema::Result;

void add_patch(const schema::Patch& patch, ProjectFile& file) {
  std::vector<std::string_view> types;
  for (const schema::ForceLayer& layer : patch.layers) types.push_back(type_of(layer));
  file.figures.push_back(
      {patch.name, fmt::format("{} at {}, {}; {} x {}", fmt::join(types, ", "), length_for_people(patch.x_m),
                               length_for_people(patch.y_m), length_for_people(patch.width_m),
                               length_for_people(patch.height_m))});
}

std::string axis_words(const schema::DeviceAxis& axis) {
  return fmt::format("{:.4g} kg, {:.4g} N s/m, {}, {} to {}, steps of {}", axis.mass_kg,
                     axis.viscous_n_s_per_m, for_people(axis.coulomb_n, Dimension::force),
                     length_for_people(axis.travel_from_m), length_for_people(axis.travel_to_m),
                     length_for_people(axis.encoder_step_m));
}

}  // namespace

Result<void> add_scene(const std::string& path, ProjectFile& file) {
  const auto scene = schema::read_scene(path);
  TACTO_TRY(scene);
  file.date = scene->created;
  file.origin = scene->name;
  for (const schema::Layer& layer : scene->layers)
    layer.visit([&](const schema::TextureLayer& texture) {
      file.figures.push_back(
          {texture.texture, fmt::format("at {}, {}", for_people(texture.at_m, Dimension::length),
                                        for_people(texture.gain_m_per_n, Dimension::compliance))});
    });
  for (const schema::Patch& patch : scene->patches) add_patch(patch, file);
  for (const schema::Piece& piece : scene->pieces)
    file.figures.push_back(
        {piece.name, fmt::format("{}, {:.4g} N/m", to_string(piece.shape), piece.stiffness_n_per_m)});
  return {};
}

Result<void> add_device(const std::string& path, ProjectFile& file) {
  const auto device = schema::read_device(path);
  TACTO_TRY(device);
  file.origin = device->name;
  for (const schema::DeviceAxis& axis : device->axes)
    file.figures.push_back({"axis " + axis.name, axis_words(axis)});
  file.figures.push_back({"peak force", for_people(device->peak_force_n, Dimension::force)});
  file.figures.push_back({"continuous force", for_people(device->continuous_force_n, Dimension::force)});
  file.figures.push_back({"delay", for_people(device->delay_s, Dimension::time)});
  file.figures.push_back({"from", device->source});
  file.figures.push_back({"notes", device->notes});
  return {};
}

Result<void> add_hand(const std::string& path, ProjectFile& file) {
  const auto hand = schema::read_hand(path);
  TACTO_TRY(hand);
  file.origin = hand->name;
  file.figures = {{"mass", fmt::format("{:.4g} kg", hand->mass_kg)},
                  {"damping", fmt::format("{:.4g} N s/m", hand->damping_n_s_per_m)},
                  {"stiffness", fmt::format("{:.4g} N/m", hand->stiffness_n_per_m)},
                  {"from", hand->source}};
  return {};
}

}  // namespace tacto::analysis
