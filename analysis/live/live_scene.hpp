// SPDX-License-Identifier: GPL-3.0-or-later
// A force scene as the page needs it: frames of the wire, pictures, sliders; and the scenes of a folder.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/live/live_folder.hpp"
#include "analysis/scene/piece_figure.hpp"
#include "analysis/scene/scene_figure.hpp"
#include "playback/player/force_program.hpp"

namespace tacto::analysis {

/// A number of the scene that can change while it plays.
struct LiveSlider {
  std::string name;  ///< as of `ctl set`: PATCH.LAYER.MEMBER or PIECE.MEMBER
  wire::Set set;     ///< layer and number
  schema::LayerNumber number;
};

struct LiveScene {
  std::string file;
  schema::Device device;  ///< whose axes the page has
  playback::ForceProgram program;
  /// A frame of these axes, then the frames of playback::upload_scene() to the page's board, each as it was
  /// accepted.
  std::vector<Frame> upload;
  std::vector<LiveSlider> sliders;
  std::array<double, 3> start_m = {};  ///< where the hand begins: of pieces outside of them, if there is room
  std::optional<SceneFigure> plane;    ///< of patches
  std::optional<PieceFigure> space;    ///< of pieces, or it
  PiecePicture pieces;                 ///< with `space`: what it draws
};

/// For a device (a preset, or NAME.device.json) at its largest rate; empty: the preset `sandpaper-1990`
/// (patches) or `arm` (pieces). Errors: as read_scene, read_device, make_force_program, read_scene_picture,
/// read_piece_picture; unsuitable, for a scene of a tray, and for a device whose axes are not x and y, of
/// pieces also z.
schema::Result<LiveScene> make_live_scene(const std::string& file, const std::string& own_device);

/// The picture of the verb `scene` without its frame: patches from above (`section` 0), or pieces in a
/// section of kPieceSections through a place across it.
spatial::Pixels scene_pixels(const LiveScene& scene, std::size_t section, double through_m);

/// The figures of a scene for the page: a JSON object.
std::string scene_json(std::size_t made, const LiveScene& scene);

/// The force scenes of a folder, by index.
class LiveScenes {
 public:
  explicit LiveScenes(std::string folder) : folder_(std::move(folder)) {}

  /// Reads the folder, and the scenes in it that are new or have changed. JSON: `scenes`, by name: index,
  /// name, number of patches or pieces; one that can't be played has the reason. `devices`, by name: index
  /// and name of each NAME.device.json in the folder, or the reason why it can't be read. What was listed
  /// before keeps its index.
  std::string list_json();
  /// A small picture: width, height, and a colour (0xRRGGBB) for each pixel. Errors: as make().
  schema::Result<std::vector<std::uint32_t>> thumbnail(std::size_t index);
  /// Prepares a scene from its files as they are now, for a device of the folder or the scene's preset, under
  /// a new number. Errors: not_found; as make_live_scene.
  schema::Result<std::size_t> make(std::size_t index, std::optional<std::size_t> device);
  /// One of the last kMostMade that were made. Errors: not_found.
  schema::Result<std::shared_ptr<const LiveScene>> made(std::size_t number);

 private:
  static constexpr std::size_t kMostMade = 4;
  struct Listed {
    std::string file;
    std::filesystem::file_time_type time;  // of the file when it was read
    cli::Report row;
    std::vector<std::uint32_t> thumbnail;  // empty: not made yet
  };
  schema::Result<std::string> file(std::size_t index) const;
  std::vector<cli::Report> device_rows();

  std::string folder_;
  std::vector<Listed> listed_;        // by index
  std::vector<std::string> devices_;  // files, by index
  LastUsed<LiveScene, kMostMade> made_;
};

}  // namespace tacto::analysis
