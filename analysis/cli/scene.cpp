// SPDX-License-Identifier: GPL-3.0-or-later
// tactograph scene: a picture of the force patches of a scene.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>

#include "analysis/cli/verbs.hpp"
#include "analysis/scene/scene_figure.hpp"
#include "data-schema/base/unknown_note.hpp"
#include "data-schema/command/output_options.hpp"
#include "data-schema/report/progress.hpp"

namespace tacto::analysis {
namespace {

using cli::Report;
using schema::Result;

struct SceneVerbOptions {
  std::string scene, device, hand, session, output;
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

Result<Report> run_scene(const SceneVerbOptions& o) {
  TACTO_TRY(cli::check_ending(o.output, {".png", ".svg"}, "use .png or .svg"));
  TACTO_TRY(schema::check_output_free(o.output, o.existing));
  if (!o.hand.empty() && o.device.empty())
    return schema::fail(schema::ErrorKind::usage, "needs the device that the hand holds", "--hand",
                        "give --device NAME");
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
  app.add_option("SCENE", o.scene,
                 "Scene with force patches: stem or file name ('info' lists what it contains)")
      ->required();
  app.add_option("-o,--output", o.output, "Output file, .png or .svg")->required();
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
  cli::declare_force(app, o.existing);
  return [options] { return run_scene(*options); };
}

}  // namespace

const cli::Verb kSceneVerb{
    "scene", "Draw the force patches of a scene in the plane, and the path and forces of a session over them",
    "tactograph scene plane -o plane.png --device sandpaper-1990\n"
    "  tactograph scene plane -o pushed.svg --session pushed",
    declare_scene};

}  // namespace tacto::analysis
