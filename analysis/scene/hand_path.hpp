// SPDX-License-Identifier: GPL-3.0-or-later
// The path of a hand on a picture, and the forces on it, from the ticks of a session.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "analysis/scene/scene_map.hpp"
#include "data-schema/base/error.hpp"
#include "data-schema/scene/patch.hpp"

namespace tacto::analysis {

/// The force of one tick.
struct ForceArrow {
  spatial::Point from;      ///< on the page
  double x_n = 0, y_n = 0;  ///< on the hand, y upwards
};

/// Lines of a path, on the page, of any number of ticks: a place that was drawn within half a point is not
/// drawn again. Arrows are at least kArrowSpacing of the path apart, and at most kMostArrows.
class HandPath {
 public:
  explicit HandPath(const SceneMap& map);
  /// In the order of the ticks; also of a body, without forces.
  void add(spatial::Point place_m, double force_x_n, double force_y_n);

  /// The next place begins a new line.
  void lift() { lifted_ = true; }

  const std::vector<std::vector<spatial::Point>>& lines() const { return lines_; }
  const std::vector<ForceArrow>& arrows() const { return arrows_; }
  spatial::Point start() const { return lines_.front().front(); }
  spatial::Point end() const { return last_; }
  double length_m() const { return length_m_; }
  double largest_force_n() const;  ///< of the arrows

  static constexpr double kArrowSpacing = 14;
  static constexpr std::size_t kMostArrows = 160;

 private:
  void draw_to(spatial::Point at);
  void add_arrow(spatial::Point at, double x_n, double y_n);

  SceneMap map_;
  std::vector<bool> drawn_;
  std::vector<std::vector<spatial::Point>> lines_;
  std::vector<ForceArrow> arrows_;
  bool pen_down_ = false, lifted_ = false;
  std::size_t last_cell_ = SIZE_MAX;
  spatial::Point last_, last_m_;
  double length_m_ = 0, since_arrow_ = 0, spacing_ = kArrowSpacing;
};

/// A session of forces: what a picture states of it, and its range.
struct HandSession {
  std::string path, simulated, scene_sha256;
  double duration_s = 0;
  PlaneRange range;
};

/// Errors: as playback::read_force_session; unsuitable: a session of a tray.
schema::Result<HandSession> read_hand_session(const std::string& name);

/// Errors: as read_hand_session().
schema::Result<HandPath> read_hand_path(const std::string& name, const SceneMap& map);

/// A body or a lasso of a scene: patch and layer as in the block.
struct BodyOfScene {
  std::uint32_t patch = 0, layer = 0;
  double length_m = 0;  ///< of a lasso: up to this distance its force is 0
};

/// `patches` from the topmost on, as of PreparedScene.
std::vector<BodyOfScene> bodies_of(const std::vector<schema::Patch>& patches);

/// The path of each body while the hand was on its patch, by a replay of the session. Without the part from
/// where the replay differs. Errors: as playback::replay_session().
schema::Result<std::vector<HandPath>> read_body_paths(const std::string& name, const SceneMap& map,
                                                      const std::vector<BodyOfScene>& bodies);

}  // namespace tacto::analysis
