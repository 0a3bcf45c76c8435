// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/scene/hand_path.hpp"

#include <algorithm>
#include <cmath>

#include "firmware-host/core/scene/scene_kernel.hpp"
#include "playback/session/force_session.hpp"
#include "playback/session/session_replay.hpp"

namespace tacto::analysis {

using schema::Result;
using spatial::Point;

namespace {

constexpr double kCellsPerPoint = 2;  // of the path that is drawn

// A vector of a tick along x and y; 0 along an axis that the device does not have.
struct PlaneTick {
  Point place_m, force_n;

  PlaneTick(const schema::SessionTick& tick, const std::vector<schema::DeviceAxis>& axes) {
    for (std::size_t i = 0; i < axes.size() && i < tick.axes; ++i) {
      const double place = tick.counts[i] * axes[i].encoder_step_m, force = double{tick.force_n[i]};
      if (axes[i].name == "x") place_m.x = place, force_n.x = force;
      if (axes[i].name == "y") place_m.y = place, force_n.y = force;
    }
  }
};

Result<schema::SessionHeader> force_header(const std::string& name) {
  const auto reader = schema::SessionReader::open(name);
  TACTO_TRY(reader);
  if (!reader->header().forces)
    return schema::fail(schema::ErrorKind::unsuitable, "is a session of a tray, not of a force device",
                        reader->path(), "name a session of a scene with force patches");
  return reader->header();
}

double length_between(Point a, Point b) {
  return std::hypot(a.x - b.x, a.y - b.y);
}

}  // namespace

HandPath::HandPath(const SceneMap& map)
    : map_(map),
      drawn_(static_cast<std::size_t>(std::ceil(kCellsPerPoint * map.box.width) + 1) *
             static_cast<std::size_t>(std::ceil(kCellsPerPoint * map.box.height) + 1)) {}

double HandPath::largest_force_n() const {
  double largest_n = 0;
  for (const ForceArrow& arrow : arrows_) largest_n = std::max(largest_n, std::hypot(arrow.x_n, arrow.y_n));
  return largest_n;
}

void HandPath::add(Point place_m, double force_x_n, double force_y_n) {
  const Point at = map_.place(place_m);
  if (lines_.empty() || lifted_) {
    lifted_ = false;
    last_ = at;
    last_m_ = place_m;
    lines_.push_back({at});
    pen_down_ = true;
  }
  since_arrow_ += length_between(at, last_);
  length_m_ += length_between(place_m, last_m_);
  draw_to(at);
  last_ = at;
  last_m_ = place_m;
  if (since_arrow_ >= spacing_ && (force_x_n != 0 || force_y_n != 0)) add_arrow(at, force_x_n, force_y_n);
}

void HandPath::draw_to(Point at) {
  const auto columns = static_cast<std::size_t>(std::ceil(kCellsPerPoint * map_.box.width) + 1);
  const auto cell = [](double along, double length) {
    return static_cast<std::size_t>(kCellsPerPoint * std::clamp(along, 0.0, length));
  };
  const std::size_t index =
      cell(at.y - map_.box.y, map_.box.height) * columns + cell(at.x - map_.box.x, map_.box.width);
  if (index == last_cell_) return;
  last_cell_ = index;
  if (drawn_[index]) {
    if (pen_down_) lines_.back().push_back(at);
    pen_down_ = false;
    return;
  }
  drawn_[index] = true;
  if (!pen_down_) lines_.push_back({last_});
  pen_down_ = true;
  lines_.back().push_back(at);
}

void HandPath::add_arrow(Point at, double x_n, double y_n) {
  since_arrow_ = 0;
  const auto near = [&](const ForceArrow& arrow) {
    return length_between(arrow.from, at) < kArrowSpacing / 3;
  };
  if (std::ranges::any_of(arrows_, near)) return;
  arrows_.push_back({at, x_n, y_n});
  if (arrows_.size() <= kMostArrows) return;
  for (std::size_t i = 0; 2 * i < arrows_.size(); ++i) arrows_[i] = arrows_[2 * i];
  arrows_.resize((arrows_.size() + 1) / 2);
  spacing_ *= 2;
}

std::vector<BodyOfScene> bodies_of(const std::vector<schema::Patch>& patches) {
  std::vector<BodyOfScene> bodies;
  std::uint32_t layer = 0;
  for (std::uint32_t patch = 0; patch < patches.size(); ++patch)
    for (const schema::ForceLayer& of : patches[patch].layers) {
      of.visit(
          [&](const schema::BodyLayer& /*body*/) {
            bodies.push_back({patch, layer, 0});
          },
          [&](const schema::LassoLayer& lasso) {
            bodies.push_back({patch, layer, lasso.length_m.value});
          },
          [](const auto& /*without a place*/) {});
      ++layer;
    }
  return bodies;
}

Result<std::vector<HandPath>> read_body_paths(const std::string& name, const SceneMap& map,
                                              const std::vector<BodyOfScene>& bodies) {
  std::vector<HandPath> paths(bodies.size(), HandPath(map));
  const auto replayed = playback::replay_session(name, {}, {}, [&](const core::SceneKernel& scene) {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      core::PlaneVector place_m;
      if (scene.body_place(bodies[i].patch, bodies[i].layer, place_m))
        paths[i].add({double{place_m.x}, double{place_m.y}}, 0, 0);
      else
        paths[i].lift();
    }
  });
  TACTO_TRY(replayed);
  return paths;
}

Result<HandSession> read_hand_session(const std::string& name) {
  const auto header = force_header(name);
  TACTO_TRY(header);
  HandSession session{schema::session_path(name), header->simulated, header->scene_sha256, 0, {}};
  const auto read = playback::read_force_session(name, [&](const schema::SessionTick& tick, double time_s) {
    session.range.add(PlaneTick(tick, header->forces->axes).place_m);
    session.duration_s = time_s;
  });
  TACTO_TRY(read);
  return session;
}

Result<HandPath> read_hand_path(const std::string& name, const SceneMap& map) {
  const auto header = force_header(name);
  TACTO_TRY(header);
  HandPath path(map);
  const auto read = playback::read_force_session(name, [&](const schema::SessionTick& tick, double) {
    const PlaneTick of(tick, header->forces->axes);
    path.add(of.place_m, of.force_n.x, of.force_n.y);
  });
  TACTO_TRY(read);
  return path;
}

}  // namespace tacto::analysis
