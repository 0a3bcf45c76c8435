// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/render/plane_render.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "data-schema/files/files.hpp"
#include "firmware-host/core/scene/scene_kernel.hpp"
#include "firmware-host/sim/planar/planar_body.hpp"
#include "playback/prepare/scene/scene_device.hpp"
#include "playback/render/reference/exact_scene.hpp"

namespace tacto::playback {

using schema::Device;
using schema::DeviceAxis;
using schema::ErrorKind;
using schema::fail;
using schema::Result;

namespace {

constexpr double kMostTicks = 1 << 26;
// Of the force: a larger difference of two forces of pieces is not rounding, but another side of a piece.
constexpr double kOtherSide = 1e-3, kOtherSide_n = 0.1;

// The places along the path, at each tick; 0 along an axis without a path.
std::vector<double> places_along(const FingerPath* path, double rate_hz, std::size_t ticks) {
  return path == nullptr ? std::vector<double>(ticks) : positions_along(*path, rate_hz, ticks);
}

// What moves the axes: the path, or a hand that the path moves.
class Motion {
 public:
  Motion(const Device& device, const std::optional<schema::Hand>& hand, double rate_hz,
         std::vector<std::vector<double>> path_m)
      : device_(device), path_m_(std::move(path_m)) {
    if (!hand) return;
    body_.emplace(device, *hand, 1 / rate_hz);
    body_->rest_at(path_at(0));
  }
  void read(std::size_t tick, PlaneRendering& rendering) const {
    for (std::size_t i = 0; i < path_m_.size(); ++i) {
      PlaneAxisRun& axis = rendering.axes[i];
      axis.place_m.push_back(body_ ? body_->place_m(i) : path_m_[i][tick]);
      if (body_) axis.hand_m.push_back(path_m_[i][tick]);
      axis.counts.push_back(firmware_host::encoder_count(device_.axes[i], axis.place_m.back()));
    }
  }
  void move_on(std::size_t tick, const std::vector<double>& force_n) {
    if (body_) body_->step(force_n, path_at(tick), path_at(tick + 1));
  }

 private:
  // After the end the hand stays.
  std::vector<double> path_at(std::size_t tick) const {
    std::vector<double> places_m;
    for (const auto& path_m : path_m_) places_m.push_back(path_m[std::min(tick, path_m.size() - 1)]);
    return places_m;
  }
  const Device& device_;
  std::vector<std::vector<double>> path_m_;
  std::optional<firmware_host::PlanarBody> body_;
};

void run_kernel(PlaneRendering& rendering, const PreparedScene& scene, const core::ForceSetup& setup,
                const Device& device, Motion motion) {
  core::SceneKernel kernel;
  std::vector<float> live(scene.view().live_words());
  kernel.set(scene.view(), setup, live.data());
  ExactScene exact(scene, device, rendering.rate_hz);
  for (std::uint32_t i = 0; i < scene.pieces.size(); ++i)
    if (scene.pieces[i].slide) rendering.slides.push_back({scene.pieces[i].name, i, {}});
  std::vector<std::int32_t> counts(device.axes.size());
  std::vector<double> force_n(device.axes.size());
  for (std::size_t tick = 0; tick < rendering.time_s.size(); ++tick) {
    motion.read(tick, rendering);
    for (std::size_t i = 0; i < counts.size(); ++i) counts[i] = rendering.axes[i].counts[tick];
    const core::ForceOutput output = kernel.tick(counts.data(), true);
    const ExactScene::Output reference = exact.tick(counts);
    rendering.limits.add(output.flags);
    double square = 0, other_square = 0, most_rounding_n = 0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
      force_n[i] = output.force_n[i];
      rendering.axes[i].force_n.push_back(output.force_n[i]);
      square += force_n[i] * force_n[i];
      const double difference_n = force_n[i] - reference.force_n[i];
      most_rounding_n = std::max(most_rounding_n, std::abs(difference_n));
      other_square += difference_n * difference_n;
    }
    if (rendering.in_space &&
        std::sqrt(other_square) > kOtherSide * std::max(kOtherSide_n, std::sqrt(square)))
      ++rendering.other_side_ticks;
    else
      rendering.largest_rounding_n = std::max(rendering.largest_rounding_n, most_rounding_n);
    rendering.largest_force_n = std::max(rendering.largest_force_n, std::sqrt(square));
    for (SlideRun& slide : rendering.slides) slide.place_m.push_back(double{kernel.slid_m(slide.layer)});
    motion.move_on(tick, force_n);
  }
}

}  // namespace

std::vector<std::string> plane_axes_of(const Device& device) {
  std::vector<std::string> names;
  for (const DeviceAxis& axis : device.axes)
    if (axis.name != "z") names.push_back(axis.name);
  return names;
}

std::vector<std::string> path_axes_of(const Device& device, const std::string& file) {
  std::vector<std::string> names = plane_axes_of(device);
  const auto text = schema::read_file(file);
  if (!text || names.size() == device.axes.size() || !has_column(*text, "z")) return names;
  names.clear();
  for (const DeviceAxis& axis : device.axes) names.push_back(axis.name);
  return names;
}

Result<void> check_travel(const Device& device, const std::vector<FingerPath>& paths,
                          const std::string& where) {
  auto path = paths.begin();
  for (const DeviceAxis& axis : device.axes) {
    if (axis.name == "z" && paths.size() < device.axes.size()) continue;
    const auto& places_m = path->position_m;
    const auto out = std::ranges::find_if(
        places_m, [&](double place) { return place < axis.travel_from_m || place > axis.travel_to_m; });
    if (out != places_m.end())
      return fail(
          ErrorKind::unsuitable,
          fmt::format("at {:g} s the path is at {} = {:g} m, beyond the travel of the device",
                      path->time_s[static_cast<std::size_t>(out - places_m.begin())], axis.name, *out),
          where, fmt::format("its travel is from {:g} m to {:g} m", axis.travel_from_m, axis.travel_to_m));
    ++path;
  }
  return {};
}

Result<PlaneRendering> render_plane(const PreparedScene& scene, const Device& device,
                                    std::optional<double> rate_hz, const std::vector<FingerPath>& paths,
                                    const std::optional<schema::Hand>& hand) {
  const auto setup = force_setup_of(device, rate_hz);
  TACTO_TRY(setup);
  TACTO_TRY(check_travel(device, paths, "path"));
  PlaneRendering rendering;
  rendering.in_space = !scene.pieces.empty();
  rendering.rate_hz = rate_hz.value_or(device.rates_hz.back());
  const double ticks = std::floor(paths.front().duration_s() * rendering.rate_hz + 1e-6) + 1;
  if (ticks > kMostTicks)
    return fail(ErrorKind::unsuitable,
                fmt::format("the path has {:.3g} ticks at {:g} Hz", ticks, rendering.rate_hz), "path",
                fmt::format("at most {:g} are rendered", kMostTicks));
  for (double tick = 0; tick < ticks; ++tick)
    rendering.time_s.push_back(paths.front().time_s.front() + tick / rendering.rate_hz);
  std::vector<std::vector<double>> path_m;
  auto path = paths.begin();
  for (const DeviceAxis& axis : device.axes) {
    path_m.push_back(places_along(axis.name == "z" && paths.size() < device.axes.size() ? nullptr : &*path++,
                                  rendering.rate_hz, rendering.time_s.size()));
    rendering.axes.push_back({axis.name, {}, {}, {}, {}});
  }
  run_kernel(rendering, scene, *setup, device, Motion(device, hand, rendering.rate_hz, std::move(path_m)));
  return rendering;
}

}  // namespace tacto::playback
