// SPDX-License-Identifier: GPL-3.0-or-later
// The forces of a scene along the path of a hand, offline, by the kernel that also runs in real time.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "data-schema/device/device.hpp"
#include "data-schema/device/hand.hpp"
#include "playback/model/finger_path.hpp"
#include "playback/model/limit_tally.hpp"
#include "playback/prepare/scene/prepared_scene.hpp"

namespace tacto::playback {

/// One axis of the device: counts and forces of all ticks.
struct PlaneAxisRun {
  std::string name;
  std::vector<std::int32_t> counts;
  std::vector<double> place_m;  ///< of the axis
  std::vector<double> hand_m;   ///< to which the person moves the hand; empty if the path is imposed
  std::vector<float> force_n;   ///< on the hand
};

/// A piece that slides: its place along its direction after the tick.
struct SlideRun {
  std::string piece;
  std::uint32_t layer = 0;
  std::vector<double> place_m;
};

struct PlaneRendering {
  double rate_hz = 0;
  bool in_space = false;       ///< of pieces: the axis z has a force, too
  std::vector<double> time_s;  ///< of the path, at each tick
  std::vector<PlaneAxisRun> axes;
  LimitCounts limits;
  double largest_rounding_n = 0;  ///< greatest difference to the kernel in double precision, other ticks
  /// Of pieces: ticks in which the force differs by more than 0.1 % from that of double precision. Where two
  /// places are as near, rounding decides, and the ghost points then hold the hand on different sides.
  std::size_t other_side_ticks = 0;
  double largest_force_n = 0;  ///< of the vector
  std::vector<SlideRun> slides = {};
};

/// The names of the device's axes in the plane: those of which the path has a column.
std::vector<std::string> plane_axes_of(const schema::Device& device);

/// The same, and of an axis z if the table `file` has a column of it: without one the axis stays at 0.
std::vector<std::string> path_axes_of(const schema::Device& device, const std::string& file);

/// A path never overshoots its knots. `where` names it. Errors: unsuitable, with axis and knot, if the path
/// of an axis leaves its travel.
schema::Result<void> check_travel(const schema::Device& device, const std::vector<FingerPath>& paths,
                                  const std::string& where);

/// Each tick reads the counts (place / encoder step, rounded to the nearest) and gives the force, from the
/// first tick on without a ramp. Without a hand the axes move along `paths` (one per axis of
/// path_axes_of()), whatever the force. With a hand, `paths` are the places to which the person moves it,
/// linear between ticks, and the axes move by firmware_host::PlanarBody. Errors: by force_setup_of();
/// unsuitable, if a path leaves the travel, or has over 2^26 ticks.
schema::Result<PlaneRendering> render_plane(const PreparedScene& scene, const schema::Device& device,
                                            std::optional<double> rate_hz,
                                            const std::vector<FingerPath>& paths,
                                            const std::optional<schema::Hand>& hand = std::nullopt);

}  // namespace tacto::playback
