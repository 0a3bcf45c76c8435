// SPDX-License-Identifier: GPL-3.0-or-later
#include <concepts>

#include "data-schema/cli/describe.hpp"
#include "data-schema/report/choices_report.hpp"
#include "data-schema/scene/scene.hpp"

namespace tacto::schema {
namespace {

cli::Report row_of(const TextureLayer& layer) {
  cli::Report row;
  row.add("type", "texture").add("texture", layer.texture).add("at_m", layer.at_m);
  row.add("gain_m_per_n", layer.gain_m_per_n).add("ends", to_string(layer.ends));
  add_text(row, "gain_set_by", layer.gain_set_by);
  add_text(row, "gain_set_on", layer.gain_set_on);
  return row;
}

// A layer of a patch: its numbers under their names in the file.
cli::Report row_of(const ForceLayer& layer) {
  cli::Report row;
  row.add("type", type_of(layer));
  add_text(row, "file", file_of(layer));
  layer.visit([&]<class L>(const L& of) {
    if constexpr (std::same_as<L, GroovesLayer>) {
      row.add("profile", to_string(of.profile));
      if (!of.filter_m) row.add("filter", "auto");
    }
  });
  for (const auto& [name, number, changes, whole] : numbers_of(layer)) {
    if (whole)
      row.add(std::string(name), static_cast<std::uint64_t>(number.value));  // with all its digits
    else
      row.add(std::string(name), number.value);
  }
  if (is_adaptive(layer)) row.add("adaptive", true);
  layer.visit(
      [&](const DamperLayer& damper) {
        if (damper.two_ticks) row.add("two_ticks", true);
      },
      [](const auto& /*other*/) {});
  return row;
}

cli::Report row_of(const Patch& patch) {
  cli::Report row;
  row.add("patch", patch.name).add("x_m", patch.x_m).add("y_m", patch.y_m);
  row.add("width_m", patch.width_m).add("height_m", patch.height_m).add("angle_deg", patch.angle_deg);
  row.add("order", patch.order).add("combine", to_string(patch.combine));
  std::vector<cli::Report> layers;
  for (const ForceLayer& layer : patch.layers) layers.push_back(row_of(layer));
  return row.add("layers", std::move(layers));
}

// The numbers that can be changed during playback.
std::vector<cli::Report> slider_rows(const Scene& scene) {
  std::vector<cli::Report> rows;
  for (const Patch& patch : scene.patches)
    for (std::size_t i = 0; i < patch.layers.size(); ++i)
      for (const auto& [name, number, changes, whole] : numbers_of(patch.layers[i]))
        if (number.slider)
          rows.push_back(cli::Report()
                             .add("patch", patch.name)
                             .add("layer", i)
                             .add("member", name)
                             .add("value", number.value)
                             .add("from", number.slider->from)
                             .add("to", number.slider->to));
  for (const Piece& piece : scene.pieces)
    for (const PieceNumber& each : kWallNumbers)
      if (const auto [name, number, changes, whole] = named_number(piece, each); number.slider)
        rows.push_back(cli::Report()
                           .add("piece", piece.name)
                           .add("member", name)
                           .add("value", number.value)
                           .add("from", number.slider->from)
                           .add("to", number.slider->to));
  return rows;
}

void add_patches(cli::Report& report, const Scene& scene) {
  if (scene.patches.empty()) return;
  std::vector<cli::Report> rows;
  for (const Patch& patch : scene.patches) rows.push_back(row_of(patch));
  report.add("patches", std::move(rows));
}

cli::Report row_of(const Piece& piece) {
  cli::Report row;
  row.add("piece", piece.name).add("shape", to_string(piece.shape));
  row.add("x_m", piece.x_m).add("y_m", piece.y_m).add("z_m", piece.z_m);
  const auto add_above_0 = [&](const char* key, double value) {
    if (value > 0) row.add(key, value);
  };
  if (!piece.mesh.empty()) row.add("mesh", piece.mesh);
  if (!piece.volume.empty())
    row.add("volume", piece.volume).add("iso", piece.iso).add("value_per_m", piece.value_per_m);
  if (piece.carve)
    row.add("carve_force_n", piece.carve->force_n).add("carve_value_per_s", piece.carve->value_per_s);
  add_above_0("radius_m", piece.radius_m);
  add_above_0("thickness_m", piece.thickness_m);
  row.add("stiffness_n_per_m", piece.stiffness_n_per_m);
  add_above_0("damping_n_s_per_m", piece.damping_n_s_per_m);
  add_above_0("static_friction", piece.static_friction);
  add_above_0("kinetic_friction", piece.kinetic_friction);
  add_above_0("viscous_n_s_per_m", piece.viscous_n_s_per_m);
  add_above_0("arrest_mass_kg", piece.arrest_mass_kg);
  add_above_0("integral_bound_n", piece.integral_bound_n);
  if (const auto& transient = piece.transient) {
    row.add("transient_amplitude_n_s_per_m", transient->amplitude_n_s_per_m);
    row.add("transient_frequency_hz", transient->frequency_hz);
    row.add("transient_decay_per_s", transient->decay_per_s);
  }
  if (piece.hand_surface)
    for (const auto& [name, value] : kHandSurfaceNumbers)
      row.add(value == &HandSurface::amplitude ? "hand_surface_amplitude" : name,
              (*piece.hand_surface).*value);
  std::vector<cli::Report> travel;
  for (const TravelPoint& point : piece.travel)
    travel.push_back(cli::Report().add("depth_m", point.depth_m).add("force_n", point.force_n));
  if (!travel.empty()) row.add("travel", std::move(travel));
  if (const auto& texture = piece.texture) {
    row.add("texture", to_string(texture->type));
    add_text(row, "texture_file", texture->file);
    if (texture->type == PieceTextureType::sine)
      row.add("texture_amplitude_n", texture->amplitude_n)
          .add("texture_period_u_m", texture->periods_m[0])
          .add("texture_period_v_m", texture->periods_m[1]);
    row.add("texture_gain", piece.texture_gain);
  }
  if (piece.slide)
    for (const auto& [name, value] : kSlideNumbers)
      if ((*piece.slide).*value != 0) row.add(std::string("slide_") + name, (*piece.slide).*value);
  if (piece.relief) {
    row.add("relief", piece.relief->file);
    row.add("normals", piece.relief->interpolated ? "interpolated" : "exact");
  }
  if (piece.clay)
    row.add("clay_force_n", piece.clay->force_n)
        .add("clay_sink_m_per_s", piece.clay->sink_m_per_s)
        .add("clay_thickness_m", piece.clay->thickness_m)
        .add("clay_volume", piece.clay->kept ? "kept" : "lost");
  return row;
}

void add_pieces(cli::Report& report, const Scene& scene) {
  if (scene.pieces.empty()) return;
  std::vector<cli::Report> rows;
  for (const Piece& piece : scene.pieces) rows.push_back(row_of(piece));
  report.add("contact", to_string(scene.contact)).add("pieces", std::move(rows));
  if (scene.point_radius_m > 0) report.add("radius_m", scene.point_radius_m);
  if (!scene.tool_m.empty()) report.add("tool_points", scene.tool_m.size());
}

}  // namespace

Result<cli::Report> describe_scene(const std::string& path) {
  const auto scene = read_scene(path);
  TACTO_TRY(scene);
  warn_of_unknown(path, *scene);
  cli::Report report = report_of(FileKind::scene, path, "");
  add_text(report, "name", scene->name);
  std::vector<cli::Report> rows;
  for (const Layer& layer : scene->layers)
    rows.push_back(layer.visit([](const TextureLayer& texture) { return row_of(texture); }));
  if (!rows.empty()) report.add("layers", std::move(rows));
  add_patches(report, *scene);
  add_pieces(report, *scene);
  if (auto sliders = slider_rows(*scene); !sliders.empty()) report.add("sliders", std::move(sliders));
  cli::add_choices(report, scene->playback);
  add_text(report, "notes", scene->notes);
  return report;
}

}  // namespace tacto::schema
