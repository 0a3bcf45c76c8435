// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/trade/scene/scene_runs.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>

#include "analysis/trade/rows/cpu_cost.hpp"
#include "analysis/trade/rows/played_speeds.hpp"
#include "firmware-host/sim/planar/planar_body.hpp"
#include "playback/render/reference/exact_scene.hpp"

namespace tacto::analysis {
namespace {

constexpr std::size_t kTimedTicks = 1000;

AxisPaths stroke_across(const schema::Patch& patch, const schema::Device& device, double speed_mps) {
  constexpr double kPart = 0.49;  // of the patch, from its centre
  const double angle = patch.angle_deg * std::numbers::pi / 180;
  const double u = kPart * patch.width_m, v = kPart * patch.height_m;
  const double way_x = std::cos(angle) * u - std::sin(angle) * v,
               way_y = std::sin(angle) * u + std::cos(angle) * v;
  const double duration_s = 2 * std::hypot(u, v) / speed_mps;
  AxisPaths path;
  for (const schema::DeviceAxis& axis : device.axes) {
    if (axis.name == "z") continue;
    const double centre = axis.name == "x" ? patch.x_m : patch.y_m, way = axis.name == "x" ? way_x : way_y;
    const auto reached = [&](double at) { return std::clamp(at, axis.travel_from_m, axis.travel_to_m); };
    path.push_back({{0, duration_s}, {reached(centre - way), reached(centre + way)}});
  }
  return path;
}

// One scene that runs again and again.
class TimedKernel {
 public:
  explicit TimedKernel(const TimedScene& timed)
      : counts_(*timed.counts), view_(timed.scene.view()), live_(view_.live_words()) {
    kernel_.set(view_, timed.setup, live_.data());
    first_ = counts_.size() > kTimedTicks ? (counts_.size() - kTimedTicks) / 2 : 0;
  }
  void run() {
    for (std::size_t i = 0; i < kTimedTicks; ++i)
      kernel_.tick(counts_[first_ + i % std::min(kTimedTicks, counts_.size())].data(), true);
  }

 private:
  const CountRows& counts_;
  core::SceneView view_;
  std::vector<float> live_;
  core::SceneKernel kernel_;
  std::size_t first_ = 0;
};

}  // namespace

std::vector<AxisPaths> strokes_over(const std::vector<schema::Patch>& patches, const schema::Device& device) {
  std::vector<AxisPaths> paths;
  for (const schema::Patch& patch : patches)
    for (const double speed_mps : kTradeSpeeds_mps) paths.push_back(stroke_across(patch, device, speed_mps));
  return paths;
}

CountRows path_counts(const AxisPaths& path, const schema::Device& device, double rate_hz) {
  const auto ticks = static_cast<std::size_t>(path.front().duration_s() * rate_hz + 1e-6) + 1;
  CountRows counts(ticks, std::vector<std::int32_t>(device.axes.size()));
  auto of_axis = path.begin();
  for (std::size_t axis = 0; axis < device.axes.size(); ++axis) {
    if (device.axes[axis].name == "z") continue;
    const auto places_m = positions_along(*of_axis++, rate_hz, ticks);
    for (std::size_t i = 0; i < ticks; ++i)
      counts[i][axis] = firmware_host::encoder_count(device.axes[axis], places_m[i]);
  }
  return counts;
}

ForceRows kernel_forces(const playback::PreparedScene& scene, const core::ForceSetup& setup,
                        const CountRows& counts) {
  core::SceneKernel kernel;
  const core::SceneView view = scene.view();
  std::vector<float> live(view.live_words());
  kernel.set(view, setup, live.data());
  ForceRows forces;
  for (const auto& row : counts) {
    const core::ForceOutput output = kernel.tick(row.data(), true);
    forces.emplace_back(output.unlimited_n, output.unlimited_n + row.size());
  }
  return forces;
}

ForceRows exact_forces(const playback::PreparedScene& scene, const schema::Device& device, double rate_hz,
                       const CountRows& counts) {
  playback::ExactScene exact(scene, device, rate_hz);
  ForceRows forces;
  for (const auto& row : counts) forces.push_back(exact.tick(row).unlimited_n);
  return forces;
}

void ForceSizes::add(const std::vector<double>& force_n) {
  double square = 0;
  for (const double each : force_n) square += each * each;
  largest_n = std::max(largest_n, std::sqrt(square));
  square_sum += square;
  ++ticks;
}

double ForceSizes::rms_n() const {
  return ticks > 0 ? std::sqrt(square_sum / static_cast<double>(ticks)) : 0;
}

void add_differences(const ForceRows& forces, const ForceRows& reference, double part, ForceSizes& sizes) {
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const auto held = static_cast<std::size_t>(static_cast<double>(i) * part + 1e-6);
    std::vector<double> off = reference[i];
    for (std::size_t axis = 0; axis < off.size(); ++axis)
      off[axis] -= forces[std::min(held, forces.size() - 1)][axis];
    sizes.add(off);
  }
}

std::vector<double> tick_costs_ns(const std::vector<TimedScene>& scenes) {
  constexpr int kRunBatches = 15;
  std::vector<std::function<void()>> works;
  for (const TimedScene& scene : scenes)
    works.emplace_back([timed = std::make_shared<TimedKernel>(scene)] { timed->run(); });
  return median_costs_ns(works, kTimedTicks, kRunBatches);
}

}  // namespace tacto::analysis
