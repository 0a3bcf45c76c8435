// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <limits>
#include <numbers>
#include <type_traits>
#include <utility>
#include <vector>

#include "analysis/extremes/extreme.hpp"
#include "data-schema/mesh/mesh.hpp"
#include "firmware-host/core/scene/scene_kernel.hpp"
#include "playback/prepare/scene/mesh_block.hpp"
#include "playback/prepare/scene/scene_device.hpp"
#include "playback/stability/sampled_spring.hpp"

namespace tacto::analysis {
namespace {

constexpr double kStatedLimitError = 1e-9;  // stiffness_limit()
constexpr double kStatedForceError = 3e-7;  // SceneKernel

// C = K T / B of the free device for x = B T / M, in extended precision: with e = exp(-x),
// phi = (e - 1 + x) / x^2 and q = ((1 - e) / x)^2 - phi e, in units of T^2 / M, the limit is the lesser of
// (1 - e) / q and, where phi > q, 2 (1 + e) / (phi - q) (free_limit.hpp).
long double closed_form_of_c(long double x) {
  const long double e = std::exp(-x), first = -std::expm1(-x) / x;  // (1 - e) / x
  long double phi = (1 - first) / x;
  if (x < 1e-2L) {  // 1/2 - x/6 + x^2/24 - ...
    long double term = 0.5L;
    phi = 0;
    for (int n = 3; n < 15; ++n) {
      phi += term;
      term *= -x / static_cast<long double>(n);
    }
  }
  const long double q = first * first - phi * e;
  const long double by_speed = first * x / q, by_place = phi > q ? 2 * (1 + e) / (phi - q) : INFINITY;
  return std::min(by_speed, by_place) / x;
}

// Masses of 1 g to 10 kg, rates of 100 Hz to 20 kHz, dampings of 1 mN s/m to 100 N s/m.
double limit_error() {
  double worst = 0;
  for (const double mass : {1e-3, 0.1, 10.0})
    for (const double rate_hz : {100.0, 1e3, 20e3})
      for (const double damping : {1e-3, 1.0, 100.0}) {
        const double found = playback::stiffness_limit({mass, damping, 0}, {1 / rate_hz, 0}, 0);
        const auto exact = static_cast<double>(
            closed_form_of_c(static_cast<long double>(damping) / (static_cast<long double>(mass) * rate_hz)) *
            static_cast<long double>(damping) * rate_hz);
        worst = std::max(worst, std::abs(found / exact - 1));
      }
  return worst;
}

// With B T / M = 1e-7 the limit is that of the linear term, but for some 1e-7 times the delay.
double delay_error() {
  double worst = 0;
  for (const double delay : {0.0, 0.001, 0.5, 1.0, 1.999, 5.25, 20.0}) {
    const double found = playback::stiffness_limit({1, 1e-7, 0}, {1, delay}, 0);
    worst = std::max(worst, std::abs(found * (0.5 + delay) / 1e-7 - 1));
  }
  return worst;
}

// Without limits of force.
schema::Device boundless(double step_m, double rate_hz) {
  schema::Device device = *schema::read_device("sandpaper-1990");
  for (schema::DeviceAxis& axis : device.axes) {
    axis.encoder_step_m = step_m;
    axis.peak_force_n = axis.continuous_force_n = 1e9;
  }
  device.peak_force_n = device.continuous_force_n = 1e9;
  device.slew_n_per_s = 1e15;
  device.rates_hz = {rate_hz};
  return device;
}

// The kernel of a scene with one patch.
class OnePatch {
 public:
  OnePatch(std::vector<schema::ForceLayer> layers, double step_m, double rate_hz, double x_m = 0,
           double width_m = 1)
      : device_(boundless(step_m, rate_hz)), setup_(*playback::force_setup_of(device_, rate_hz)) {
    schema::Patch patch;
    patch.name = "patch";
    patch.x_m = x_m;
    patch.width_m = patch.height_m = width_m;
    patch.layers = std::move(layers);
    schema::Scene scene;
    scene.patches = {patch};
    prepared_ = *playback::prepare_scene(scene, "extremes", device_, rate_hz);
    live_.resize(prepared_.view().live_words());
    kernel_.set(prepared_.view(), setup_, live_.data());
  }
  OnePatch(const OnePatch&) = delete;
  OnePatch& operator=(const OnePatch&) = delete;
  // Along x, before the limits.
  double force_n(std::int32_t count) {
    const std::int32_t counts[2] = {count, 0};
    return double{kernel_.tick(counts, true).unlimited_n[0]};
  }
  // All that the kernel keeps from tick to tick.
  std::vector<std::uint32_t> state() const {
    static_assert(std::is_trivially_copyable_v<core::SceneKernel> && sizeof(core::SceneKernel) % 4 == 0);
    std::vector<std::uint32_t> words(sizeof(kernel_) / 4 + live_.size());
    std::memcpy(words.data(), static_cast<const void*>(&kernel_), sizeof(kernel_));
    std::memcpy(words.data() + sizeof(kernel_) / 4, live_.data(), live_.size() * sizeof(float));
    return words;
  }

 private:
  schema::Device device_;
  core::ForceSetup setup_;
  playback::PreparedScene prepared_;
  std::vector<float> live_;
  core::SceneKernel kernel_;
};

// Springs of 1e-3 to 1e6 N/m, encoders of 1 nm to 1 mm, within 0.1 m.
double spring_error() {
  double worst = 0;
  for (const double stiffness : {1e-3, 1.0, 1e6})
    for (const double step_m : {1e-9, 1e-6, 1e-3}) {
      schema::SpringLayer spring;
      spring.stiffness_n_per_m = {stiffness};
      OnePatch scene({spring}, step_m, 1000);
      for (int i = -50; i <= 50; ++i) {
        const auto count = static_cast<std::int32_t>(std::lround(2e-3 * i / step_m));
        const double exact_n = -stiffness * count * step_m;
        worst = std::max(worst, std::abs(scene.force_n(count) - exact_n) / (stiffness * 0.1));
      }
    }
  return worst;
}

// Whole counts per tick have no grain: -B v.
double damper_error() {
  double worst = 0;
  for (const double rate_hz : {100.0, 1e3, 20e3}) {
    OnePatch scene({schema::DamperLayer{{5}, ""}}, 1e-6, rate_hz);
    const double exact_n = -5 * 3e-6 * rate_hz;
    for (int tick = 0; tick < 100; ++tick) {
      const double force_n = scene.force_n(3 * tick);
      if (tick > 20) worst = std::max(worst, std::abs(force_n / exact_n - 1));
    }
  }
  return worst;
}

schema::GroovesLayer sine_of(double period_m) {
  schema::GroovesLayer sine;
  sine.period_m = {period_m};
  sine.depth_m = {1e-4};
  sine.kappa_n = {2};
  return sine;
}

// -kappa h' of h = depth / 2 cos(2 pi x / period), from the patch's centre, at 1 count per tick.
double far_patch_error() {
  constexpr double kStep_m = 1e-6, kPeriod_m = 1e-3, kFar_m = 10;
  OnePatch scene({sine_of(kPeriod_m)}, kStep_m, 1000, kFar_m, 0.1);
  const double most_n = 2 * 1e-4 * std::numbers::pi / kPeriod_m;
  double worst = 0;
  for (int i = -2000; i < 2000; ++i) {
    const double exact_n = most_n * std::sin(2 * std::numbers::pi * i * kStep_m / kPeriod_m);
    worst = std::max(worst, std::abs(scene.force_n(10'000'000 + i) - exact_n) / most_n);
  }
  return worst;
}

// A period of 2^20 counts of 2^-30 m: 2^31 counts are whole periods, exactly.
double counter_difference() {
  constexpr double kStep_m = 0x1p-30, kPeriod_m = 0x1p-10;
  OnePatch near({sine_of(kPeriod_m)}, kStep_m, 1000, 0, 10), far({sine_of(kPeriod_m)}, kStep_m, 1000, 0, 10);
  double worst = 0, most = 0;
  for (int i = -2000; i < 2000; ++i) {
    const std::int32_t count = 700 * i;
    const auto over = static_cast<std::int32_t>(static_cast<std::uint32_t>(count) + (UINT32_C(1) << 31));
    const double one = near.force_n(count), other = far.force_n(over);
    worst = std::max(worst, std::abs(one - other));
    most = std::max(most, std::abs(one));
  }
  return most > 0.1 ? worst / most : 1;
}

// Once through all counts in steps of 7001, from -2^31 to its end and over it to 100 steps beyond the start.
double all_counts_error() {
  constexpr double kStep_m = 0x1p-30, kPeriod_m = 0x1p-10, kEach = 7001;
  constexpr std::int64_t kSteps = (std::int64_t{1} << 32) / 7001 + 100, kPeriodCounts = 1 << 20;
  OnePatch scene({sine_of(kPeriod_m), schema::DamperLayer{{1}, ""}}, kStep_m, 1000, 0, 10);
  const double slope_n = 2 * 1e-4 * std::numbers::pi / kPeriod_m, damper_n = kEach * kStep_m * 1000;
  double worst = 0;
  for (std::int64_t i = 0; i < kSteps; ++i) {
    const std::int64_t count = 7001 * i - (std::int64_t{1} << 31);
    const double phase = static_cast<double>(count % kPeriodCounts) / static_cast<double>(kPeriodCounts);
    const double exact_n = slope_n * std::sin(2 * std::numbers::pi * phase) - damper_n;
    const double force_n = scene.force_n(static_cast<std::int32_t>(static_cast<std::uint32_t>(count)));
    if (i > 20) worst = std::max(worst, std::abs(force_n - exact_n) / (slope_n + damper_n));
  }
  return worst;
}

// A hand drags a brick by a spring for 0.2 s and rests. After 2^20 ticks without a count the speed of an axis
// is 0, and the number of the tick in the kernel repeats after 2^24 - 1 ticks. If by then the whole state
// repeats, too, it does so for ever, but for two numbers of each axis: its tick, and that of its last edge,
// which follows at a constant distance; nothing reads more than their difference. What differs besides: words
// of the state, and ticks with another force.
double ticks_at_rest() {
  constexpr std::uint32_t kAfter = 1 << 21, kPeriod = (1 << 24) - 1;
  schema::BodyLayer brick;
  brick.mass_kg = {0.3}, brick.stiffness_n_per_m = {200}, brick.damping_n_s_per_m = {1};
  brick.static_friction_n = {0.5}, brick.kinetic_friction_n = {0.3};
  OnePatch scene({schema::SpringLayer{{100}, {}, {}, ""}, schema::DamperLayer{{1}, ""}, brick, sine_of(1e-3)},
                 1e-6, 1000);
  for (std::int32_t i = 0; i < 200; ++i) scene.force_n(100 * i);
  for (std::uint32_t i = 0; i < kAfter; ++i) scene.force_n(20'011);
  const double rest_n = scene.force_n(20'011);
  const std::vector<std::uint32_t> before = scene.state();
  double changed = std::abs(rest_n) > 1 ? 0 : 1;
  for (std::uint32_t i = 0; i < kPeriod; ++i) changed += scene.force_n(20'011) != rest_n;
  const std::vector<std::uint32_t> after = scene.state();
  int numbers = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (after[i] == before[i]) continue;
    if (after[i] - before[i] == kPeriod)
      ++numbers;
    else
      ++changed;
  }
  return changed + std::abs(numbers - 4);
}

// A ball of 2e6 triangles, by 1000 meridians and 1000 circles of latitude.
constexpr double kBall_m = 0.05;
schema::Mesh large_ball() {
  constexpr std::uint32_t kCircles = 1000, kMeridians = 1000, kNorth = kCircles * kMeridians;
  schema::Mesh ball;
  for (std::uint32_t i = 1; i <= kCircles; ++i)
    for (std::uint32_t j = 0; j < kMeridians; ++j) {
      const double polar = std::numbers::pi * i / (kCircles + 1),
                   azimuth = 2 * std::numbers::pi * j / kMeridians;
      ball.vertices_m.push_back({kBall_m * std::sin(polar) * std::cos(azimuth),
                                 kBall_m * std::sin(polar) * std::sin(azimuth), kBall_m * std::cos(polar)});
    }
  ball.vertices_m.push_back({0, 0, kBall_m});
  ball.vertices_m.push_back({0, 0, -kBall_m});
  for (std::uint32_t j = 0; j < kMeridians; ++j) {
    const std::uint32_t next = (j + 1) % kMeridians, last = (kCircles - 1) * kMeridians;
    ball.triangles.push_back({kNorth, j, next});
    ball.triangles.push_back({kNorth + 1, last + next, last + j});
    for (std::uint32_t i = 0; i < last; i += kMeridians) {
      ball.triangles.push_back({i + j, i + kMeridians + j, i + next});
      ball.triangles.push_back({i + next, i + kMeridians + j, i + kMeridians + next});
    }
  }
  return ball;
}

// A block of one piece: 1 N/mm, at the origin.
std::vector<std::uint32_t> block_of(const std::vector<std::uint32_t>& table) {
  core::SceneHeader header;
  header.patches = header.layers = 1;
  header.numbers = core::kPieceNumbers + core::kWallStateWords;
  header.table_words = static_cast<std::uint32_t>(table.size());
  const core::ScenePatch space{0, 0, 1, 0, 1000, 1000, 0, 1, 0};
  const core::SceneLayer layer{static_cast<std::uint16_t>(core::SceneLayerKind::mesh), 0, 0};
  std::vector<float> numbers(header.numbers);
  numbers[core::kPieceStiffness] = 1000;
  std::vector<std::uint32_t> words;
  const auto append = [&]<class T>(const T* parts, std::size_t count) {
    const auto* const from = reinterpret_cast<const std::uint32_t*>(parts);
    words.insert(words.end(), from, from + count * sizeof(T) / sizeof(std::uint32_t));
  };
  append(&header, 1);
  append(&space, 1);
  append(&layer, 1);
  append(numbers.data(), numbers.size());
  append(table.data(), table.size());
  header.check = core::scene_check(words.data(), static_cast<std::uint32_t>(words.size() * sizeof(words[0])));
  std::memcpy(words.data(), &header, sizeof header);
  return words;
}

// A hand 1 mm below the ball, coming straight from outside: re its force on the true ball.
double large_mesh_error() {
  constexpr double kStep_m = 1e-6, kDepth_m = 1e-3;
  const auto block = block_of(playback::mesh_table(large_ball(), {}));
  core::SceneView view;
  if (core::read_scene_block(block.data(), static_cast<std::uint32_t>(block.size() * sizeof(block[0])),
                             view) != core::SceneFault::none)
    return 1;
  core::ForceSetup setup;
  for (std::uint32_t i = 0; i < 3; ++i)
    setup.axes[i] = {static_cast<core::AxisAlong>(i), static_cast<float>(kStep_m), 1e9F, 1e9F};
  setup.axis_count = 3, setup.rate_hz = 1000;
  setup.peak_n = setup.continuous_n = 1e9F, setup.slew_n_per_s = 1e15F;
  std::vector<float> live(view.live_words());
  double worst = 0;
  for (int k = 0; k < 300; ++k) {
    // Evenly over the ball, from pole to pole (a golden spiral).
    const double z = 1 - 2 * (k + 0.5) / 300, azimuth = k * std::numbers::pi * (3 - std::sqrt(5.0));
    const double away[3] = {std::sqrt(1 - z * z) * std::cos(azimuth),
                            std::sqrt(1 - z * z) * std::sin(azimuth), z};
    core::SceneKernel kernel;
    kernel.set(view, setup, live.data());
    core::ForceOutput output;
    double place_m[3] = {};
    for (int tick = 0; tick < 60; ++tick) {
      std::int32_t counts[3] = {};
      for (int i = 0; i < 3; ++i) {
        counts[i] = static_cast<std::int32_t>(
            std::lround((kBall_m + std::max(-kDepth_m, kDepth_m - 1e-4 * tick)) * away[i] / kStep_m));
        place_m[i] = counts[i] * kStep_m;
      }
      output = kernel.tick(counts, true);
    }
    const double distance_m = std::hypot(place_m[0], place_m[1], place_m[2]);
    double square = 0;
    for (int i = 0; i < 3; ++i) {
      const double exact_n = 1000 * (kBall_m - distance_m) * place_m[i] / distance_m;
      square += std::pow(double{output.unlimited_n[i]} - exact_n, 2);
    }
    worst = std::max(worst, std::sqrt(square) / (1000 * (kBall_m - distance_m)));
  }
  return worst;
}

}  // namespace

std::vector<Extreme> scene_extremes() {
  // Of a triangle from its corners to its middle, 0.176 mm of 50 mm, and the bar of the ghost on a mesh.
  constexpr double kMeshError = 3.5e-3 + 2e-3;
  return {{"playback", "masses of 1 g to 10 kg at 100 Hz to 20 kHz: the largest stable stiffness",
           "the exact discretisation in closed form, in long double", limit_error(), kStatedLimitError,
           "friction of 1 mN s/m to 100 N s/m"},
          {"playback", "delays of 0 to 20 ticks: the largest stable stiffness",
           "B / (T (1/2 + delay)) for B T / M = 1e-7", delay_error(), 1e-5, "beyond 50 ticks it is refused"},
          {"firmware-host", "springs of 1e-3 to 1e6 N/m on encoders of 1 nm to 1 mm: the force", "-K x",
           spring_error(), kStatedForceError, ""},
          {"firmware-host", "a damper at 100 Hz to 20 kHz, 3 counts a tick: the force", "-B v",
           damper_error(), kStatedForceError, ""},
          {"firmware-host", "a sine of 1 mm on a patch 10 m from the origin: the force", "its derivative",
           far_patch_error(), kStatedForceError, "places are whole counts, so no digits are lost"},
          {"firmware-host", "grooves through the end of the counter, 2^31 counts",
           "the same way about 0, to the bit", counter_difference(), 0, ""},
          {"firmware-host", "a sine and a damper through all 2^32 counts of the counter: the force",
           "their closed form", all_counts_error(), kStatedForceError, "613,480 ticks of 7001 counts"},
          {"firmware-host", "1e9 ticks at rest, with spring, damper, grooves and a brick: the force",
           "the same at each tick", ticks_at_rest(), 0,
           "1.9e7 ticks, after which all state but the number of the tick repeats"},
          {"firmware-host", "a ball of 50 mm, a mesh of 2e6 triangles, 1 mm deep: the force, a vector",
           "K (R - r) away from the middle of a true ball", large_mesh_error(), kMeshError,
           "half the angle of a triangle, and 2 mrad"}};
}

}  // namespace tacto::analysis
