// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/live/live_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "data-schema/report/report.hpp"
#include "firmware-host/core/wire/device_messages.hpp"
#include "firmware-host/sim/planar/planar_device.hpp"
#include "playback/player/scene_command.hpp"
#include "playback/wasm/browser_board.hpp"
#include "spatial/picture/draw/colours.hpp"

namespace tacto::analysis {
namespace {

namespace fs = std::filesystem;

using schema::ErrorKind;
using schema::fail;
using schema::Result;

constexpr std::string_view kSceneEnding = ".scene.json", kDeviceEnding = ".device.json";
constexpr std::size_t kFrontSection = 1;
constexpr int kSmallColumns = 160;  // of a small picture

std::string name_without(std::string_view ending, const std::string& file) {
  const std::string name = fs::path(file).filename().string();
  return name.substr(0, name.size() - ending.size());
}

// The files of a folder with an ending of their names, in order.
std::set<std::string> files_with(std::string_view ending, const std::string& folder,
                                 std::error_code& failed) {
  std::set<std::string> found;
  for (fs::directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed)) {
    std::error_code ignored;
    if (at->path().string().ends_with(ending) && at->is_regular_file(ignored))
      found.insert(at->path().string());
  }
  return found;
}

// The page moves the hand along x, y and, of pieces, z.
Result<schema::Device> device_for(const schema::Scene& scene, const std::string& name) {
  auto device = schema::read_device(name);
  TACTO_TRY(device);
  const std::string_view wanted = scene.pieces.empty() ? "x, y" : "x, y, z";
  std::vector<std::string> names;
  for (const schema::DeviceAxis& axis : device->axes) names.push_back(axis.name);
  if (const std::string own = fmt::format("{}", fmt::join(names, ", ")); own != wanted)
    return fail(
        ErrorKind::unsuitable,
        fmt::format("the device '{}' has the axes {}, this scene needs {}", device->name, own, wanted), name,
        "choose another device");
  return device;
}

// The earliest time if there is no such file.
fs::file_time_type scene_time(const std::string& file) {
  std::error_code failed;
  const auto time = fs::last_write_time(file, failed);
  return failed ? fs::file_time_type::min() : time;
}

Result<schema::Scene> read_force_scene(const std::string& file) {
  auto scene = schema::read_scene(file);
  TACTO_TRY(scene);
  if (!scene->patches.empty() || !scene->pieces.empty()) return scene;
  return fail(ErrorKind::unsuitable, "is a scene of a tray: it has neither force patches nor pieces", file,
              "play it with 'tactograph play'");
}

Frame frame_of_axes(const wire::Axes& axes) {
  Frame frame(wire::kMaxFrame);
  frame.resize(wire::encode_frame(axes, 0, frame.data(), frame.size()));
  return frame;
}

// The board says how large a scene it takes, so the scene is prepared while it is connected. Its errors name
// places in the scene, those of the board do not.
Result<void> upload_to_page(LiveScene& live) {
  const wire::Axes axes = firmware_host::axes_on_wire(live.device);
  const auto rate_hz = static_cast<std::uint32_t>(std::lround(live.device.rates_hz.back()));
  playback::ForceRequest request;
  request.file = live.file;
  std::optional<schema::Error> refused;
  auto frames = frames_of(
      live.file,
      [&](firmware_host::Client& client) -> Result<void> {
        auto program =
            playback::make_force_program(request, live.device, std::nullopt, *client.description().axes);
        if (!program) refused = program.error();
        TACTO_TRY(program);
        live.program = std::move(*program);
        return playback::upload_scene(client, live.program);
      },
      &axes, rate_hz);
  if (refused) return tl::unexpected(*refused);
  TACTO_TRY(frames);
  live.upload = {frame_of_axes(axes)};
  live.upload.insert(live.upload.end(), frames->begin(), frames->end());
  return {};
}

// Those that cannot change while the scene plays are left out.
void add_slider(LiveScene& live, const std::string& name, const schema::LayerNumber& number) {
  if (!number.slider) return;
  const auto command = playback::set_command(name, number.value, playback::kUsualRampS, live.program);
  if (command) live.sliders.push_back({name, std::get<wire::Set>(command->message), number});
}

void add_sliders(LiveScene& live) {
  for (const schema::Piece& piece : live.program.scene.pieces)
    for (const schema::PieceNumber& each : schema::kWallNumbers)
      add_slider(live, fmt::format("{}.{}", piece.name, each.name), named_number(piece, each).number);
  for (const schema::Patch& patch : live.program.scene.patches)
    for (std::size_t i = 0; i < patch.layers.size(); ++i) {
      const std::string_view type = schema::type_of(patch.layers[i]);
      const bool alone = std::ranges::count(patch.layers, type, [](const schema::ForceLayer& layer) {
                           return schema::type_of(layer);
                         }) == 1;
      for (const auto& [name, number, changes, whole] : schema::numbers_of(patch.layers[i]))
        add_slider(live,
                   fmt::format("{}.{}.{}", patch.name, alone ? std::string(type) : std::to_string(i), name),
                   number);
    }
}

// In the section from the front the free pixel that is the nearest to the middle of the pieces, and from
// there on as far again as a hand is from a wall that it does not touch.
std::array<double, 3> free_place(const LiveScene& live) {
  constexpr double kAway_m = 5e-3;
  const auto [right, up, across, from] = kPieceSections[kFrontSection];
  const PixelGrid& grid = live.space->map(kFrontSection).grid;
  std::array<double, 3> place_m = live.space->through_m();
  const spatial::Point middle{place_m[right], place_m[up]};
  const auto solid = solid_in_section(live.pieces.scene, grid, across, place_m, live.pieces.meshes,
                                      live.pieces.reliefs, live.pieces.volumes);
  double nearest_m = INFINITY;
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      if (solid[static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.columns) +
                static_cast<std::size_t>(column)] >= 0)
        continue;
      const spatial::Point at = grid.centre_m(column, row);
      const double far_m = std::hypot(at.x - middle.x, at.y - middle.y);
      if (far_m >= nearest_m) continue;
      nearest_m = far_m;
      const double away_m = far_m > grid.pixel_m ? kAway_m + live.program.scene.point_radius_m : 0;
      place_m[right] = at.x + (far_m > 0 ? away_m * (at.x - middle.x) / far_m : 0);
      place_m[up] = at.y + (far_m > 0 ? away_m * (at.y - middle.y) / far_m : 0);
    }
  for (const schema::DeviceAxis& axis : live.device.axes) {
    double& along_m = place_m.at(static_cast<std::size_t>(axis.name[0] - 'x'));
    along_m = std::clamp(along_m, axis.travel_from_m, axis.travel_to_m);
  }
  return place_m;
}

// As many pixels as its width allows, each from the middle of its part.
std::vector<std::uint32_t> small_picture(const spatial::Pixels& pixels) {
  const int step = std::max(1, (pixels.width + kSmallColumns - 1) / kSmallColumns);
  const int width = pixels.width / step, height = pixels.height / step;
  std::vector<std::uint32_t> small = {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column)
      small.push_back(pixels.rgb[static_cast<std::size_t>(row * step + step / 2) *
                                     static_cast<std::size_t>(pixels.width) +
                                 static_cast<std::size_t>(column * step + step / 2)]);
  return small;
}

cli::Report section_row(std::size_t right, std::size_t up, std::size_t across, const PixelGrid& grid) {
  cli::Report row;
  row.add("right", right).add("up", up).add("across", across);
  row.add("left_m", grid.left_m).add("top_m", grid.top_m).add("pixel_m", grid.pixel_m);
  return row.add("columns", grid.columns).add("rows", grid.rows);
}

std::string colour_words(const spatial::Colour& colour) {
  const auto byte = [](double value) { return std::lround(255 * value); };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(colour.red), byte(colour.green), byte(colour.blue));
}

}  // namespace

Result<LiveScene> make_live_scene(const std::string& file, const std::string& own_device) {
  auto scene = read_force_scene(file);
  TACTO_TRY(scene);
  LiveScene live;
  live.file = file;
  const std::string name = !own_device.empty()     ? own_device
                           : scene->pieces.empty() ? "sandpaper-1990"
                                                   : "arm";
  auto device = device_for(*scene, name);
  TACTO_TRY(device);
  live.device = std::move(*device);
  TACTO_TRY(upload_to_page(live));
  add_sliders(live);
  if (scene->pieces.empty()) {
    auto picture = read_scene_picture(file, name, {}, {});
    TACTO_TRY(picture);
    auto figure = SceneFigure::make(std::move(*picture));
    TACTO_TRY(figure);
    live.plane = std::move(*figure);
    return live;
  }
  auto picture = read_piece_picture(std::move(*scene), file, name);
  TACTO_TRY(picture);
  live.pieces = std::move(*picture);
  live.space.emplace(live.pieces);
  live.start_m = free_place(live);
  return live;
}

spatial::Pixels scene_pixels(const LiveScene& scene, std::size_t section, double through_m) {
  if (scene.plane) return shaded(scene.plane->raster());
  const PixelGrid& grid = scene.space->map(section).grid;
  std::array<double, 3> place_m = scene.space->through_m();
  const std::size_t across = kPieceSections[section].across;
  place_m.at(across) = through_m;
  return section_pixels(solid_in_section(scene.pieces.scene, grid, across, place_m, scene.pieces.meshes,
                                         scene.pieces.reliefs, scene.pieces.volumes),
                        grid);
}

std::string scene_json(std::size_t made, const LiveScene& scene) {
  std::vector<cli::Report> axes, sections, parts, sliders;
  for (const schema::DeviceAxis& axis : scene.device.axes)
    axes.push_back(cli::Report()
                       .add("name", axis.name)
                       .add("encoder_step_m", axis.encoder_step_m)
                       .add("from_m", axis.travel_from_m)
                       .add("to_m", axis.travel_to_m)
                       .add("start_m", scene.start_m.at(static_cast<std::size_t>(axis.name[0] - 'x'))));
  if (scene.plane) sections.push_back(section_row(0, 1, 2, scene.plane->map().grid));
  for (std::size_t i = 0; scene.space && i < std::size(kPieceSections); ++i)
    sections.push_back(section_row(kPieceSections[i].right, kPieceSections[i].up, kPieceSections[i].across,
                                   scene.space->map(i).grid));
  for (const schema::Patch& patch : scene.program.scene.patches)
    parts.push_back(cli::Report()
                        .add("name", patch.name)
                        .add("x_m", patch.x_m)
                        .add("y_m", patch.y_m)
                        .add("width_m", patch.width_m)
                        .add("height_m", patch.height_m)
                        .add("angle_deg", patch.angle_deg));
  for (std::size_t i = 0; i < scene.pieces.scene.pieces.size(); ++i) {
    const schema::Piece& piece = scene.pieces.scene.pieces[i];
    parts.push_back(cli::Report()
                        .add("name", piece.name)
                        .add("shape", to_string(piece.shape))
                        .add("colour", colour_words(spatial::series_colour(i))));
  }
  for (const LiveSlider& slider : scene.sliders)
    sliders.push_back(cli::Report()
                          .add("name", slider.name)
                          .add("layer", slider.set.layer)
                          .add("number", slider.set.number)
                          .add("value", slider.number.value)
                          .add("from", slider.number.slider->from)
                          .add("to", slider.number.slider->to));
  cli::Report figures;
  figures.add("made", made)
      .add("name", name_without(kSceneEnding, scene.file))
      .add("device", scene.device.name);
  figures.add("rate_hz", scene.program.session.rate_hz)
      .add("peak_n", double{scene.program.limits.peak_n})
      .add("bytes", scene.program.scene.bytes())
      .add("ramp_s", playback::kUsualRampS)
      .add("ghost", scene.space && scene.program.scene.contact == schema::PieceContact::ghost);
  figures.add("axes", std::move(axes)).add("sections", std::move(sections));
  figures.add(scene.plane ? "patches" : "pieces", std::move(parts));
  return figures.add("sliders", std::move(sliders)).add("notes", scene.program.notes).json();
}

std::string LiveScenes::list_json() {
  std::error_code failed;
  std::vector<cli::Report> rows;
  for (const std::string& path : files_with(kSceneEnding, folder_, failed)) {
    auto one = std::ranges::find(listed_, path, &Listed::file);
    if (one == listed_.end()) one = listed_.insert(listed_.end(), Listed{path, {}, {}, {}});
    if (const auto time = scene_time(path); one->row.empty() || one->time != time) {
      *one = {path, time, {}, {}};
      one->row.add("index", one - listed_.begin()).add("name", name_without(kSceneEnding, path));
      const auto scene = read_force_scene(path);
      if (!scene) one->row.add("reason", schema::message(scene.error()));
      if (scene) one->row.add("patches", scene->patches.size()).add("pieces", scene->pieces.size());
    }
    rows.push_back(one->row);
  }
  cli::Report list;
  list.add("scenes", std::move(rows)).add("devices", device_rows());
  if (failed) list.add("reason", failed.message());
  return list.json();
}

// A folder that can't be read has been reported with the scenes.
std::vector<cli::Report> LiveScenes::device_rows() {
  std::error_code failed;
  std::vector<cli::Report> rows;
  for (const std::string& path : files_with(kDeviceEnding, folder_, failed)) {
    auto one = std::ranges::find(devices_, path);
    if (one == devices_.end()) one = devices_.insert(devices_.end(), path);
    cli::Report row;
    row.add("index", one - devices_.begin()).add("name", name_without(kDeviceEnding, path));
    if (const auto device = schema::read_device(path); !device)
      row.add("reason", schema::message(device.error()));
    rows.push_back(std::move(row));
  }
  return rows;
}

Result<std::string> LiveScenes::file(std::size_t index) const {
  if (index < listed_.size()) return fs::absolute(listed_[index].file).lexically_normal().string();
  return fail(ErrorKind::not_found, "there is no scene of this index", std::to_string(index),
              "load the page again");
}

Result<std::vector<std::uint32_t>> LiveScenes::thumbnail(std::size_t index) {
  const auto own = file(index);
  TACTO_TRY(own);
  std::vector<std::uint32_t>& small = listed_[index].thumbnail;
  if (!small.empty()) return small;
  const auto scene = make_live_scene(*own, {});
  TACTO_TRY(scene);
  const double through_m =
      scene->space ? scene->space->through_m().at(kPieceSections[kFrontSection].across) : 0;
  return small = small_picture(scene_pixels(*scene, kFrontSection, through_m));
}

Result<std::size_t> LiveScenes::make(std::size_t index, std::optional<std::size_t> device) {
  const auto own = file(index);
  TACTO_TRY(own);
  if (device && *device >= devices_.size())
    return fail(ErrorKind::not_found, "there is no device of this index", std::to_string(*device),
                "load the page again");
  auto scene = make_live_scene(*own, device ? devices_[*device] : std::string());
  TACTO_TRY(scene);
  return made_.add(std::move(*scene));
}

Result<std::shared_ptr<const LiveScene>> LiveScenes::made(std::size_t number) {
  if (auto found = made_.find(number)) return found;
  return fail(ErrorKind::not_found, "this scene is not prepared any more", std::to_string(number),
              "choose it again");
}

}  // namespace tacto::analysis
