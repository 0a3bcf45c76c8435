// SPDX-License-Identifier: GPL-3.0-or-later
// The scene's kernel in double precision: the reference for the rounding error of single precision.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <vector>

#include "data-schema/device/device.hpp"
#include "playback/prepare/scene/prepared_scene.hpp"
#include "playback/render/reference/exact_ghost.hpp"

namespace tacto::playback {

/// The formulas of core::SceneKernel, with the full force from the first tick, implemented from those
/// formulas and not from its source: numbers as in the scene's file, every line of the speed's window tested
/// against every count. What is a free choice of the kernel is the same here: to which patch a place within
/// rounding of a border belongs, the window of the RMS and one Newton step per tick for its root. Slow; not
/// for the tick.
class ExactScene {
 public:
  /// Keeps references to both.
  ExactScene(const PreparedScene& scene, const schema::Device& device, double rate_hz);

  /// Forces of the device's axes, before and after the limits.
  struct Output {
    std::vector<double> unlimited_n, force_n;
  };
  Output tick(const std::vector<std::int32_t>& counts);

  struct Vector {
    double x = 0, y = 0;
  };
  /// The force before the limits on a hand at this place, m, with this speed, m/s. Independent of the ticks:
  /// without bodies and lassos.
  Vector force_at(Vector place, Vector speed) const {
    return force(place, {static_cast<float>(place.x), static_cast<float>(place.y)}, speed, speed, nullptr);
  }

 private:
  struct Edge {
    std::int64_t tick, count;
  };
  struct Speed {
    std::deque<Edge> edges;
    std::int64_t count = 0;
    int way = 0;
    double per_tick = 0;
  };
  std::vector<double> tick_in_space(const std::vector<std::int32_t>& counts);
  double track(Speed& speed, std::int64_t count);
  Vector groove_force(const schema::GroovesLayer& grooves, double angle_rad, Vector from_centre,
                      Vector speed) const;
  Vector noise_force(const schema::NoiseLayer& noise, double angle_rad, Vector from_centre,
                     Vector speed) const;
  Vector field_force(const schema::FieldLayer& field, double angle_rad, Vector from_centre) const;
  Vector relief_force(const Relief& relief, double kappa_n, double angle_rad, Vector from_centre,
                      Vector speed) const;
  Vector map_force(const ForceRelief& forces, double gain, double angle_rad, Vector from_centre,
                   Vector speed) const;
  /// In the axes of its patch.
  struct Body {
    Vector place, speed;
    std::int64_t tick = -1;  // in which it moved last
  };
  using Bodies = std::map<const schema::ForceLayer*, Body>;
  Vector body_force(const schema::BodyLayer& layer, Body& body, Vector hand, Vector speed) const;
  Vector lasso_force(const schema::LassoLayer& layer, Body& body, Vector hand) const;
  void advance(Body& body, double mass_kg, double damping, Vector force_n, double static_n,
               double kinetic_n) const;
  Vector force(Vector place, core::PlaneVector single, Vector speed, Vector tick_speed, Bodies* bodies) const;
  std::vector<double> limited(std::vector<double> force_n);
  struct Rms {
    double limit_n = 0, mean_square = 0, root = 0;
  };
  double rms_limited(Rms& rms, double force_n) const;

  const PreparedScene& scene_;
  core::SceneView view_;
  const schema::Device& device_;
  double rate_hz_;
  std::int64_t tick_ = 0;
  std::array<Speed, 3> speeds_;
  std::vector<std::int32_t> last_counts_;
  ExactGhost ghost_;
  Bodies bodies_;
  std::vector<Rms> axis_rms_;
  Rms rms_;
  std::vector<double> last_n_;
};

}  // namespace tacto::playback
