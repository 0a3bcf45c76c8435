// SPDX-License-Identifier: GPL-3.0-or-later
// tactograph scene: a picture of the force patches of a scene, or of its pieces in space.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <charconv>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "analysis/cli/verbs.hpp"
#include "analysis/scene/piece_figure.hpp"
#include "analysis/scene/scene_figure.hpp"
#include "analysis/scene/scene_sample.hpp"
#include "data-schema/base/unknown_note.hpp"
#include "data-schema/command/output_options.hpp"
#include "data-schema/report/progress.hpp"
#include "playback/player/scene_command.hpp"

namespace tacto::analysis {
namespace {

using cli::Report;
using schema::Result;

struct SceneVerbOptions {
  std::string scene, device, hand, session, output, through;
  std::vector<std::string> sample;  // what, place
  schema::Existing existing = schema::Existing::keep;
};

void warn_of(const SceneVerbOptions& o, const ScenePicture& picture) {
  const std::string file = schema::scene_path(o.scene);
  if (const std::string note = schema::unknown_note(file, picture.scene); !note.empty()) cli::warn(note);
  if (picture.device)
    if (const std::string note = schema::unknown_note(o.device, *picture.device); !note.empty())
      cli::warn(note);
  if (!picture.scene.layers.empty())
    cli::warn(fmt::format("{}: its {} layers of a tray are left out", file, picture.scene.layers.size()));
  const auto sha256 = schema::sha256_of_file(file);
  if (picture.session && sha256 && *sha256 != picture.session->scene_sha256)
    cli::warn(
        fmt::format("{}: its scene was another one, or {} was changed since then: the forces are those of "
                    "the session, the picture is that of the scene",
                    picture.session->path, file));
}

Report report_of(const SceneVerbOptions& o, const ScenePicture& picture, const SceneFigure& figure) {
  const PixelGrid& grid = figure.map().grid;
  Report report;
  report.add("scene", schema::scene_path(o.scene)).add("patches", picture.scene.patches.size());
  if (picture.device) report.add("device", picture.device->name);
  report.add("width_m", grid.columns * grid.pixel_m).add("height_m", grid.rows * grid.pixel_m);
  report.add("pixel_m", grid.pixel_m);
  if (figure.raster().full_n > 0) report.add("slope_of_1_n", figure.raster().full_n);
  if (figure.path()) {
    report.add("session", picture.session->path).add("path_m", figure.path()->length_m());
    report.add("force_arrows", figure.path()->arrows().size());
    if (!picture.session->simulated.empty()) report.add("simulated", picture.session->simulated);
  }
  return report.add("written", o.output);
}

// Three numbers, in cells.
std::optional<std::array<double, 3>> cells_of(const std::string& text) {
  std::array<double, 3> cells{};
  const char *at = text.data(), *const end = at + text.size();
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (i > 0 && (at == end || *at++ != ',')) return std::nullopt;
    const auto [next, failed] = std::from_chars(at, end, cells[i]);
    if (failed != std::errc() || !(std::abs(cells[i]) < 1e9)) return std::nullopt;
    at = next;
  }
  return at == end ? std::optional(cells) : std::nullopt;
}

// With all digits.
Result<Report> run_noise_sample(const std::string& place) {
  const auto cells = cells_of(place);
  if (!cells)
    return schema::fail(schema::ErrorKind::usage, fmt::format("'{}' is not a place of noise", place),
                        "--sample", "write three numbers, in cells: --sample noise 3.14,42,7");
  const NoiseValue value = sample_noise((*cells)[0], (*cells)[1], (*cells)[2]);
  return Report()
      .add("noise", fmt::format("{:.12f}", value.exact))
      .add("kernel", fmt::format("{:.12f}", value.kernel))
      .add("difference", value.kernel - value.exact);
}

Result<Report> run_sample(const SceneVerbOptions& o) {
  if (!o.output.empty() || !o.session.empty())
    return schema::fail(schema::ErrorKind::usage, "draws no picture", "--sample",
                        "leave --output and --session out");
  if (o.scene.empty() && o.sample[0] == "noise") return run_noise_sample(o.sample[1]);
  if (o.scene.empty() || o.device.empty())
    return schema::fail(schema::ErrorKind::usage, "needs a scene and a device", "--sample",
                        "write 'scene SCENE --device NAME --sample PATCH 10mm,20mm', or '--sample noise "
                        "X,Y,Z' without a scene");
  const auto place = playback::parse_place(o.sample[1]);
  TACTO_TRY(place);
  const auto picture = read_scene_picture(o.scene, o.device, o.hand, {});
  TACTO_TRY(picture);
  warn_of(o, *picture);
  const auto sample = sample_scene(*picture, o.sample[0], place->x_m, place->y_m);
  TACTO_TRY(sample);
  return Report()
      .add("sample", o.sample[0])
      .add("x_m", sample->x_m)
      .add("y_m", sample->y_m)
      .add("force_x_n", sample->force_x_n)
      .add("force_y_n", sample->force_y_n)
      .add("kernel_x_n", sample->kernel_x_n)
      .add("kernel_y_n", sample->kernel_y_n)
      .add("difference_n",
           std::hypot(sample->kernel_x_n - sample->force_x_n, sample->kernel_y_n - sample->force_y_n));
}

// "10mm,20mm,-5mm".
Result<std::array<double, 3>> place_in_space(const std::string& text) {
  std::array<double, 3> place_m{};
  std::size_t at = 0;
  for (std::size_t i = 0; i < place_m.size(); ++i) {
    const std::size_t end = i + 1 < place_m.size() ? text.find(',', at) : text.size();
    if (end == std::string::npos)
      return schema::fail(schema::ErrorKind::usage, fmt::format("'{}' is not a place in space", text),
                          "--through", "write three lengths, as in 10mm,20mm,-5mm");
    const auto length_m = schema::parse_quantity(text.substr(at, end - at), schema::Dimension::length);
    if (!length_m)
      return schema::fail(length_m.error().kind, length_m.error().what, "--through", length_m.error().remedy);
    place_m[i] = *length_m;
    at = end + 1;
  }
  return place_m;
}

Result<Report> run_pieces(const SceneVerbOptions& o, schema::Scene scene) {
  if (!o.hand.empty() || !o.session.empty())
    return schema::fail(schema::ErrorKind::unsuitable, "sections of pieces show neither a hand nor a session",
                        o.session.empty() ? "--hand" : "--session", "leave it out");
  PiecePicture picture{scene.name.empty() ? o.scene : scene.name, std::move(scene), {}, {}, {}, {}};
  for (const schema::Piece& piece : picture.scene.pieces) {
    if (schema::is_raised(piece)) {
      auto map =
          schema::read_height_map(schema::texture_in_scene(schema::scene_path(o.scene), piece.relief->file));
      TACTO_TRY(map);
      picture.reliefs[piece.relief->file] = std::move(*map);
    }
    if (piece.shape != schema::PieceShape::mesh || picture.meshes.contains(piece.mesh)) continue;
    auto mesh = schema::read_mesh(schema::texture_in_scene(schema::scene_path(o.scene), piece.mesh));
    TACTO_TRY(mesh);
    picture.meshes[piece.mesh] = std::move(*mesh);
  }
  if (!o.device.empty()) {
    auto device = schema::read_device(o.device);
    TACTO_TRY(device);
    picture.device = std::move(*device);
  }
  if (!o.through.empty()) {
    const auto through_m = place_in_space(o.through);
    TACTO_TRY(through_m);
    picture.through_m = *through_m;
  }
  Report report;
  report.add("scene", schema::scene_path(o.scene)).add("pieces", picture.scene.pieces.size());
  if (picture.device) report.add("device", picture.device->name);
  const PieceFigure figure(std::move(picture));
  for (std::size_t i = 0; i < 3; ++i)
    report.add(fmt::format("through_{}_m", "xyz"[i]), figure.through_m().at(i));
  schema::PendingFiles files;
  TACTO_TRY(add_figure(files, o.output, figure));
  TACTO_TRY(files.commit(o.existing));
  return report.add("written", o.output);
}

Result<Report> run_scene(const SceneVerbOptions& o) {
  if (!o.sample.empty()) return run_sample(o);
  if (o.scene.empty() || o.output.empty())
    return schema::fail(schema::ErrorKind::usage, "needs a scene and the file to write",
                        o.scene.empty() ? "SCENE" : "--output", "write 'scene SCENE -o NAME.png'");
  TACTO_TRY(cli::check_ending(o.output, {".png", ".svg"}, "use .png or .svg"));
  TACTO_TRY(schema::check_output_free(o.output, o.existing));
  if (!o.hand.empty() && o.device.empty())
    return schema::fail(schema::ErrorKind::usage, "needs the device that the hand holds", "--hand",
                        "give --device NAME");
  auto in_space = schema::read_scene(schema::scene_path(o.scene));
  TACTO_TRY(in_space);
  if (!in_space->pieces.empty()) return run_pieces(o, std::move(*in_space));
  if (!o.through.empty())
    return schema::fail(schema::ErrorKind::unsuitable, "only pieces in space have sections", "--through",
                        "leave it out");
  const auto picture = read_scene_picture(o.scene, o.device, o.hand, o.session);
  TACTO_TRY(picture);
  warn_of(o, *picture);
  cli::Progress progress("picture");
  const auto figure = SceneFigure::make(*picture, [&](double part) { progress.update(part); });
  TACTO_TRY(figure);
  schema::PendingFiles files;
  TACTO_TRY(add_figure(files, o.output, *figure));
  TACTO_TRY(files.commit(o.existing));
  return report_of(o, *picture, *figure);
}

cli::Action declare_scene(CLI::App& app) {
  auto options = std::make_shared<SceneVerbOptions>();
  SceneVerbOptions& o = *options;
  app.add_option(
      "SCENE", o.scene,
      "Scene with force patches, or with pieces in space (three sections): stem or file name ('info' "
      "lists what it contains)");
  app.add_option("-o,--output", o.output, "Output file, .png or .svg");
  app.add_option(
         "--sample", o.sample,
         "Instead of a picture: the force of PATCH, or of the layer PATCH.INDEX, on a hand at rest at "
         "X,Y (10mm,20mm) on --device, before its limits: in double precision, and as the device "
         "computes it. Without a scene 'noise X,Y,Z': the value of Perlin's improved noise, in cells")
      ->expected(2);
  app.add_option(
      "--device", o.device,
      fmt::format("Draw the travel of this force device, and filter grooves for it: a preset ({}) or "
                  "NAME.device.json; default: grooves without the filter 'auto'",
                  fmt::join(schema::device_preset_names(), ", ")));
  app.add_option("--hand", o.hand,
                 fmt::format("With --device: filter grooves for the device in this hand: a preset ({}) or "
                             "NAME.hand.json",
                             fmt::join(schema::hand_preset_names(), ", ")));
  app.add_option("--session", o.session, "Draw the path of the hand and the forces on it of NAME.session");
  app.add_option("--through", o.through,
                 "Of pieces: the place through which the sections lead, X,Y,Z as in 10mm,20mm,-5mm; default: "
                 "the middle of the balls, pipes and quadrics");
  cli::declare_force(app, o.existing);
  return [options] { return run_scene(*options); };
}

}  // namespace

const cli::Verb kSceneVerb{"scene",
                           "Draw the force patches of a scene in the plane, and the path and forces of a "
                           "session over them; of pieces "
                           "in space three sections",
                           "tactograph scene plane -o plane.png --device sandpaper-1990\n"
                           "  tactograph scene plane -o pushed.svg --session pushed\n"
                           "  tactograph scene room -o room.png --device arm --through -20mm,0mm,0mm\n"
                           "  tactograph scene plane --device sandpaper-1990 --sample sand 10mm,20mm",
                           declare_scene};

}  // namespace tacto::analysis
