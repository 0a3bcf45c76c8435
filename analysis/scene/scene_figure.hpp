// SPDX-License-Identifier: GPL-3.0-or-later
// The picture of a force scene: its patches in the plane, their relief, springs and dampers, sliders, and the
// path of a hand with the forces on it.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "analysis/scene/hand_path.hpp"
#include "analysis/scene/relief_raster.hpp"
#include "analysis/scene/scene_map.hpp"
#include "data-schema/device/device.hpp"
#include "data-schema/device/hand.hpp"
#include "data-schema/scene/scene.hpp"
#include "playback/prepare/scene/prepared_scene.hpp"
#include "spatial/picture/draw/heading.hpp"
#include "spatial/picture/figure.hpp"

namespace tacto::analysis {

/// What a picture of a scene shows.
struct ScenePicture {
  std::string name;     ///< of the scene, for the title
  schema::Scene scene;  ///< as in its file
  playback::PreparedScene prepared;
  double rate_hz = 0;                    ///< for which it was prepared
  std::optional<schema::Device> device;  ///< whose travel is drawn
  std::optional<HandSession> session;
};

/// Reads a scene for a picture, and prepares it for the device at the largest of its rates, held by the hand.
/// Without a device, filters of grooves that depend on one (filter_m: auto) are left out. Empty names: none
/// of it. Errors: of read_scene, read_device, force_setup_of, read_hand, prepare_scene and read_hand_session;
/// unsuitable, if the scene has no force patches.
schema::Result<ScenePicture> read_scene_picture(const std::string& scene, const std::string& device,
                                                const std::string& hand, const std::string& session);

class SceneFigure : public spatial::Figure {
 public:
  /// Computes the relief of each pixel, and reads the session's path; of a scene with bodies, it replays the
  /// session. `progress` receives fractions. Errors: as read_hand_path() and read_body_paths().
  static schema::Result<SceneFigure> make(ScenePicture picture,
                                          const std::function<void(double)>& progress = {});

  spatial::Size page() const override;
  schema::Result<void> draw(spatial::Canvas& canvas) const override;

  const SceneMap& map() const { return map_; }
  const ReliefRaster& raster() const { return raster_; }
  const std::optional<HandPath>& path() const { return path_; }

 private:
  explicit SceneFigure(ScenePicture picture) : picture_(std::move(picture)) {}
  /// Legend and patches. Returns the lower end.
  double draw_below_map(spatial::Canvas& canvas) const;

  ScenePicture picture_;
  spatial::Heading heading_;
  SceneMap map_;
  ReliefRaster raster_;
  std::optional<HandPath> path_;
  std::vector<BodyOfScene> bodies_;
  std::vector<HandPath> body_paths_;  // with a session: of each body and lasso, from the topmost patch on
};

}  // namespace tacto::analysis
