// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/render/reference/exact_scene.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "firmware-host/core/scene/edge_speed.hpp"
#include "firmware-host/core/scene/force_limiter.hpp"
#include "playback/prepare/relief/groove_series.hpp"
#include "playback/prepare/relief/noise_octaves.hpp"
#include "playback/render/reference/exact_noise.hpp"
#include "playback/render/reference/exact_relief.hpp"

namespace tacto::playback {
namespace {

constexpr double kVacuumPermittivity = 8.8541878188e-12;  // F/m, CODATA 2022

double norm(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum);
}

// A place and a speed after a tick of `tick_s` under a held force: m v' = force - b v by the method of Runge
// and Kutta, in steps of at most 1/16 of the tick and of m / b: an error below 1e-8 of the change.
std::pair<double, double> moved(double x, double v, double force_n, double mass_kg, double damping,
                                double tick_s) {
  const double steps = 16 * std::ceil(1 + damping * tick_s / mass_kg), h = tick_s / steps;
  const auto change = [&](double speed) { return (force_n - damping * speed) / mass_kg; };
  for (double i = 0; i < steps; ++i) {
    const double a = change(v), b = change(v + h / 2 * a), c = change(v + h / 2 * b), d = change(v + h * c);
    x += h * (v + h / 6 * (a + b + c));
    v += h / 6 * (a + 2 * b + 2 * c + d);
  }
  return {x, v};
}

}  // namespace

// Friction is what stops the body at the end of the tick, within its limit: a free choice of the kernel.
void ExactScene::advance(Body& body, double mass_kg, double damping, Vector force_n, double static_n,
                         double kinetic_n) const {
  const auto after = [&](double x, double v, double n) {
    return moved(x, v, n, mass_kg, damping, 1 / rate_hz_);
  };
  const double speed_by_force = after(0, 0, 1).second;
  const Vector stop{-after(0, body.speed.x, force_n.x).second / speed_by_force,
                    -after(0, body.speed.y, force_n.y).second / speed_by_force};
  const double needed_n = std::hypot(stop.x, stop.y);
  const bool rests = body.speed.x == 0 && body.speed.y == 0;
  const double most_n = rests ? static_n : kinetic_n;
  const bool stops = needed_n <= most_n;
  if (rests && stops) return;
  const double share = stops ? 1 : most_n / needed_n;
  std::tie(body.place.x, body.speed.x) = after(body.place.x, body.speed.x, force_n.x + share * stop.x);
  std::tie(body.place.y, body.speed.y) = after(body.place.y, body.speed.y, force_n.y + share * stop.y);
  if (stops) body.speed = {};
}

ExactScene::Vector ExactScene::body_force(const schema::BodyLayer& layer, Body& body, Vector hand,
                                          Vector speed) const {
  const double k = layer.stiffness_n_per_m.value, b = layer.damping_n_s_per_m.value;
  const Vector on_body{k * (hand.x - body.place.x) + b * (speed.x - body.speed.x),
                       k * (hand.y - body.place.y) + b * (speed.y - body.speed.y)};
  advance(body, layer.mass_kg.value, 0, on_body, layer.static_friction_n.value,
          layer.kinetic_friction_n.value);
  return {-on_body.x, -on_body.y};
}

ExactScene::Vector ExactScene::lasso_force(const schema::LassoLayer& layer, Body& body, Vector hand) const {
  const double x = hand.x - body.place.x, y = hand.y - body.place.y, distance = std::hypot(x, y);
  const double pull_n = std::max(0.0, layer.stiffness_n_per_m.value * (distance - layer.length_m.value));
  const Vector on_mass = pull_n > 0 ? Vector{pull_n * x / distance, pull_n * y / distance} : Vector{};
  advance(body, layer.mass_kg.value, layer.damping_n_s_per_m.value, on_mass, 0, 0);
  return {-on_mass.x, -on_mass.y};
}

ExactScene::Vector ExactScene::relief_force(const Relief& relief, double kappa_n, double angle_rad,
                                            Vector from_centre, Vector speed) const {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  const double passed_mps =
      relief.rows > 1 ? std::hypot(speed.x, speed.y) : std::abs(c * speed.x + s * speed.y);
  const auto [u, v] = exact_slope(relief, c * from_centre.x + s * from_centre.y,
                                  c * from_centre.y - s * from_centre.x, passed_mps, rate_hz_);
  const double force = -kappa_n;
  return {force * (c * u - s * v), force * (s * u + c * v)};
}

// Its last level is played at all higher speeds.
ExactScene::Vector ExactScene::map_force(const ForceRelief& forces, double gain, double angle_rad,
                                         Vector from_centre, Vector speed) const {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  const Relief& x = forces.x;
  const double passed_mps = x.rows > 1 ? std::hypot(speed.x, speed.y) : std::abs(c * speed.x + s * speed.y);
  const double played = std::min(level_at(x, passed_mps, rate_hz_), static_cast<double>(x.levels.size() - 1));
  double u = 0, v = 0;
  for (std::size_t n = 0; n < x.levels.size(); ++n) {
    const double weight = std::max(0.0, 1 - std::abs(static_cast<double>(n) - played));
    if (weight == 0) continue;
    const double column = place_on_level(x, x.levels[n], 0, c * from_centre.x + s * from_centre.y),
                 row = place_on_level(x, x.levels[n], 1, c * from_centre.y - s * from_centre.x);
    u += gain * weight * spline_of(forces.x.levels[n], column, row).value;
    v += gain * weight * spline_of(forces.y.levels[n], column, row).value;
  }
  return {c * u - s * v, s * u + c * v};
}

// -kappa times the derivative of the series, along the direction of the grooves.
ExactScene::Vector ExactScene::groove_force(const schema::GroovesLayer& grooves, double angle_rad,
                                            Vector from_centre, Vector speed) const {
  const double across = angle_rad + grooves.direction_deg.value * std::numbers::pi / 180;
  const double x = std::cos(across), y = std::sin(across), period_m = grooves.period_m.value;
  const double per_tick = std::abs(x * speed.x + y * speed.y) / period_m / rate_hz_;
  const double turn = 2 * std::numbers::pi / period_m;
  const auto amplitudes = groove_amplitudes(grooves.profile, grooves.filter_m->value / period_m);
  double slope = 0;
  for (std::size_t n = 1; n <= amplitudes.size(); ++n) {
    const auto order = static_cast<double>(n);
    const double angle = turn * order * (x * from_centre.x + y * from_centre.y);
    slope -= played_share(order * per_tick) * amplitudes[n - 1] * turn * order * std::sin(angle);
  }
  const double force_n = -grooves.kappa_n.value * grooves.depth_m.value * slope;
  return {force_n * x, force_n * y};
}

// By central differences of the heights.
ExactScene::Vector ExactScene::noise_force(const schema::NoiseLayer& noise, double angle_rad,
                                           Vector from_centre, Vector speed) const {
  const core::NoiseTable table = core::shuffled_noise(static_cast<std::uint32_t>(noise.seed.value));
  const double c = std::cos(angle_rad), s = std::sin(angle_rad), half = 1e-5;  // cells
  double cells_per_m = 1 / noise.period_m.value, u = 0, v = 0;
  for (const double amplitude : octave_amplitudes(noise)) {
    const double x = (c * from_centre.x + s * from_centre.y) * cells_per_m,
                 y = (c * from_centre.y - s * from_centre.x) * cells_per_m;
    const double per_tick = core::kNoiseCycles * std::hypot(speed.x, speed.y) * cells_per_m / rate_hz_;
    const double per_cell = amplitude * played_share(per_tick) * cells_per_m / (2 * half);
    u += per_cell * (exact_noise(table, x + half, y, 0) - exact_noise(table, x - half, y, 0));
    v += per_cell * (exact_noise(table, x, y + half, 0) - exact_noise(table, x, y - half, 0));
    cells_per_m *= 2;
  }
  const double force = -noise.kappa_n.value * noise.depth_m.value;
  return {force * (c * u - s * v), force * (s * u + c * v)};
}

// In the units of the atoms: Lennard-Jones's force 24 epsilon / r (2 (sigma/r)^12 - (sigma/r)^6) and
// Coulomb's q Q / (4 pi epsilon_0 r^2) along the distance; in a core the force of its border, times the share
// of the radius.
ExactScene::Vector ExactScene::field_force(const schema::FieldLayer& field, double angle_rad,
                                           Vector from_centre) const {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad), scale = field.length_scale.value;
  const double x = (c * from_centre.x + s * from_centre.y) / scale,
               y = (c * from_centre.y - s * from_centre.x) / scale, z = field.z_m.value / scale;
  double u = 0, v = 0;
  for (const schema::Atom& atom : scene_.reliefs.of(field)) {
    const double r = std::hypot(x - atom.x_m, y - atom.y_m, z - atom.z_m);
    const double core_m = field.core.value * atom.sigma_m, acting_m = std::max(r, core_m);
    const double ratio = std::pow(atom.sigma_m / acting_m, 6);
    const double coulomb =
        atom.charge_c * field.probe_charge_c.value / (4 * std::numbers::pi * kVacuumPermittivity);
    const double force_n =
        24 * atom.epsilon_j / acting_m * (2 * ratio * ratio - ratio) + coulomb / (acting_m * acting_m);
    u += force_n * (x - atom.x_m) / acting_m;
    v += force_n * (y - atom.y_m) / acting_m;
  }
  const double force = field.force_scale.value;
  return {force * (c * u - s * v), force * (s * u + c * v)};
}

ExactScene::ExactScene(const PreparedScene& scene, const schema::Device& device, double rate_hz)
    : scene_(scene),
      view_(scene.view()),
      device_(device),
      rate_hz_(rate_hz),
      ghost_(scene, device, rate_hz),
      rms_{device.continuous_force_n, 0, device.continuous_force_n},
      last_n_(device.axes.size()) {
  for (const schema::DeviceAxis& axis : device.axes)
    axis_rms_.push_back({axis.continuous_force_n, 0, axis.continuous_force_n});
}

// `edges` begins with the oldest.
double ExactScene::track(Speed& speed, std::int64_t count) {
  auto& edges = speed.edges;
  if (edges.empty()) {
    edges.push_back({tick_, count});
    speed.count = count;
    return 0;
  }
  const std::int64_t moved = count - speed.count;
  if (moved == 0) {
    const double since = static_cast<double>(tick_ - edges.back().tick);
    if (since >= core::kLongestSpeedTicks) {
      edges = {{tick_ - core::kLongestSpeedTicks, count}};
      speed.way = 0;
      return speed.per_tick = 0;
    }
    return speed.per_tick = std::clamp(speed.per_tick, -1 / since, 1 / since);
  }
  const int way = moved > 0 ? 1 : -1;
  const bool turned = way == -speed.way;
  const bool same_border = (turned || speed.way == 0) && std::abs(moved) == 1;
  if (turned) edges = {{tick_ - 1, speed.count}};
  speed.count = count;
  speed.way = way;
  if (same_border) {
    edges = {{tick_, count}};
    return speed.per_tick = 0;
  }
  edges.push_back({tick_, count});
  if (edges.size() > core::kSpeedEdges) edges.pop_front();
  // The counts over time between these edges: each stays until the tick before the next.
  std::vector<Edge> points;
  speed.per_tick = static_cast<double>(count - edges[edges.size() - 2].count);
  for (std::size_t i = edges.size() - 1; i-- > 0;) {
    points.push_back({edges[i + 1].tick - 1, edges[i].count});
    const std::int64_t ticks = tick_ - edges[i].tick, counts = count - edges[i].count;
    const bool straight = std::ranges::all_of(points, [&](const Edge& point) {
      return std::abs((count - point.count) * ticks - counts * (tick_ - point.tick)) <= ticks;
    });
    if (ticks > core::kLongestSpeedTicks || !straight) break;
    speed.per_tick = static_cast<double>(counts) / static_cast<double>(ticks);
    points.push_back(edges[i]);
  }
  return speed.per_tick;
}

ExactScene::Vector ExactScene::force(Vector place, core::PlaneVector single, Vector speed, Vector tick_speed,
                                     Bodies* bodies) const {
  Vector sum;
  bool covered = false;
  for (std::size_t i = 0; i < scene_.patches.size(); ++i) {
    const schema::Patch& patch = scene_.patches[i];
    const bool there = core::within_patch(view_.patches[i], core::place_in_patch(view_.patches[i], single));
    const bool adds = patch.combine == schema::PatchCombine::add;
    if (!there || (covered && !adds)) continue;
    if (!adds) covered = true;
    const double angle = patch.angle_deg * std::numbers::pi / 180, c = std::cos(angle), s = std::sin(angle);
    const auto in_patch = [&](Vector v) { return Vector{c * v.x + s * v.y, c * v.y - s * v.x}; };
    const Vector hand = in_patch({place.x - patch.x_m, place.y - patch.y_m});
    const auto add_turned = [&](Vector n) { sum.x += c * n.x - s * n.y, sum.y += s * n.x + c * n.y; };
    // Where it was in the last tick, or at the hand.
    const auto body_of = [&](const schema::ForceLayer& layer) -> Body& {
      Body& body = (*bodies)[&layer];
      if (body.tick != tick_ - 1) body = {hand, {}};
      body.tick = tick_;
      return body;
    };
    for (const schema::ForceLayer& layer : patch.layers)
      layer.visit(
          [&](const schema::BodyLayer& body) {
            if (bodies != nullptr) add_turned(body_force(body, body_of(layer), hand, in_patch(speed)));
          },
          [&](const schema::LassoLayer& lasso) {
            if (bodies != nullptr) add_turned(lasso_force(lasso, body_of(layer), hand));
          },
          [&](const schema::MoverLayer& mover) {
            const double along = angle + mover.direction_deg.value * std::numbers::pi / 180;
            const double b = mover.damping_n_s_per_m.value, own_mps = mover.speed_mps.value;
            sum.x += b * (own_mps * std::cos(along) - speed.x);
            sum.y += b * (own_mps * std::sin(along) - speed.y);
          },
          [&](const schema::SpringLayer& spring) {
            const double u = spring.centre_x_m.value, v = spring.centre_y_m.value;
            const double k = spring.stiffness_n_per_m.value;
            sum.x -= k * (place.x - (patch.x_m + c * u - s * v));
            sum.y -= k * (place.y - (patch.y_m + s * u + c * v));
          },
          [&](const schema::DamperLayer& damper) {
            const Vector resisted = damper.two_ticks ? tick_speed : speed;
            sum.x -= damper.damping_n_s_per_m.value * resisted.x;
            sum.y -= damper.damping_n_s_per_m.value * resisted.y;
          },
          [&](const schema::GroovesLayer& grooves) {
            const Vector along =
                groove_force(grooves, angle, {place.x - patch.x_m, place.y - patch.y_m}, speed);
            sum.x += along.x, sum.y += along.y;
          },
          [&](const schema::NoiseLayer& noise) {
            const Vector slope = noise_force(noise, angle, {place.x - patch.x_m, place.y - patch.y_m}, speed);
            sum.x += slope.x, sum.y += slope.y;
          },
          [&](const schema::HeightMapLayer& map) {
            const Vector slope = relief_force(scene_.reliefs.of(map), map.kappa_n.value, angle,
                                              {place.x - patch.x_m, place.y - patch.y_m}, speed);
            sum.x += slope.x, sum.y += slope.y;
          },
          [&](const schema::TextureForceLayer& texture) {
            const double along = angle + texture.direction_deg.value * std::numbers::pi / 180;
            const Vector slope = relief_force(scene_.reliefs.of(texture), texture.gain.value, along,
                                              {place.x - patch.x_m, place.y - patch.y_m}, speed);
            sum.x += slope.x, sum.y += slope.y;
          },
          [&](const schema::FieldLayer& field) {
            const Vector along = field_force(field, angle, {place.x - patch.x_m, place.y - patch.y_m});
            sum.x += along.x, sum.y += along.y;
          },
          [&](const schema::ForceMapLayer& map) {
            const Vector along = map_force(scene_.reliefs.of(map), map.gain.value, angle,
                                           {place.x - patch.x_m, place.y - patch.y_m}, speed);
            sum.x += along.x, sum.y += along.y;
          });
  }
  return sum;
}

double ExactScene::rms_limited(Rms& rms, double force_n) const {
  const double window = core::kContinuousWindowS * rate_hz_;
  rms.mean_square += (force_n * force_n - rms.mean_square) / window;
  const double square = std::max(rms.mean_square, rms.limit_n * rms.limit_n);
  rms.root = 0.5 * (rms.root + square / rms.root);
  return force_n * rms.limit_n / rms.root;
}

std::vector<double> ExactScene::limited(std::vector<double> force_n) {
  for (std::size_t i = 0; i < force_n.size(); ++i)
    force_n[i] = std::clamp(force_n[i], -device_.axes[i].peak_force_n, device_.axes[i].peak_force_n);
  const double peak = std::min(1.0, device_.peak_force_n / std::max(norm(force_n), 1e-300));
  for (double& force : force_n) force *= peak;
  const double length = norm(force_n), limited = rms_limited(rms_, length);
  const double share = length > 0 ? limited / length : 1;
  for (std::size_t i = 0; i < force_n.size(); ++i) {
    const double of_axis = rms_limited(axis_rms_[i], force_n[i]), of_vector = share * force_n[i];
    force_n[i] = std::abs(of_axis) < std::abs(of_vector) ? of_axis : of_vector;
  }
  const double step_n = device_.slew_n_per_s / rate_hz_;
  double farthest = 0;
  for (std::size_t i = 0; i < force_n.size(); ++i)
    farthest = std::max(farthest, std::abs(force_n[i] - last_n_[i]));
  const double part = farthest > step_n ? step_n / farthest : 1;
  for (std::size_t i = 0; i < force_n.size(); ++i) last_n_[i] += part * (force_n[i] - last_n_[i]);
  return last_n_;
}

std::vector<double> ExactScene::tick_in_space(const std::vector<std::int32_t>& counts) {
  SpaceMetres place_m = {}, speed_mps = {};
  std::vector<std::size_t> along;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const schema::DeviceAxis& axis = device_.axes[i];
    along.push_back(axis.name == "x" ? 0 : axis.name == "y" ? 1 : 2);
    place_m[along[i]] = counts[i] * axis.encoder_step_m;
    speed_mps[along[i]] = track(speeds_[along[i]], counts[i]) * axis.encoder_step_m * rate_hz_;
  }
  const SpaceMetres sum = ghost_.force(place_m, speed_mps);
  std::vector<double> force_n;
  for (const std::size_t i : along) force_n.push_back(sum[i]);
  return force_n;
}

ExactScene::Output ExactScene::tick(const std::vector<std::int32_t>& counts) {
  ++tick_;
  if (!scene_.pieces.empty()) {
    Output output{tick_in_space(counts), {}};
    output.force_n = limited(output.unlimited_n);
    return output;
  }
  Vector place_m, speed_mps, tick_speed_mps;
  core::PlaneVector single_m;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const schema::DeviceAxis& axis = device_.axes[i];
    if (axis.name == "z") continue;
    const bool x = axis.name == "x";
    (x ? place_m.x : place_m.y) = counts[i] * axis.encoder_step_m;
    (x ? single_m.x : single_m.y) = static_cast<float>(counts[i]) * static_cast<float>(axis.encoder_step_m);
    (x ? speed_mps.x : speed_mps.y) = track(speeds_[x ? 0 : 1], counts[i]) * axis.encoder_step_m * rate_hz_;
    if (!last_counts_.empty())
      (x ? tick_speed_mps.x : tick_speed_mps.y) =
          (static_cast<double>(counts[i]) - last_counts_[i]) * axis.encoder_step_m * rate_hz_;
  }
  last_counts_ = counts;
  const Vector sum = force(place_m, single_m, speed_mps, tick_speed_mps, &bodies_);
  Output output;
  for (const schema::DeviceAxis& axis : device_.axes)
    output.unlimited_n.push_back(axis.name == "x" ? sum.x : axis.name == "y" ? sum.y : 0);
  output.force_n = limited(output.unlimited_n);
  return output;
}

}  // namespace tacto::playback
