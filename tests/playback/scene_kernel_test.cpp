// SPDX-License-Identifier: GPL-3.0-or-later
// The kernel of force scenes: against closed forms and double precision, its limits, its speed, and blocks
// that were cut, changed or made to harm.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstring>
#include <functional>
#include <numbers>
#include <random>

#include "data-schema/height/height_map.hpp"
#include "data-schema/texture/texture.hpp"
#include "firmware-host/core/scene/body.hpp"
#include "firmware-host/core/scene/grooves.hpp"
#include "firmware-host/core/scene/scene_kernel.hpp"
#include "playback/prepare/relief/groove_series.hpp"
#include "playback/prepare/scene/scene_device.hpp"
#include "playback/render/plane_render.hpp"
#include "playback/render/reference/exact_noise.hpp"
#include "playback/render/reference/exact_scene.hpp"
#include "playback/stability/free_limit.hpp"
#include "playback/stability/sampled_spring.hpp"
#include "spatial/dsp/fourier/fft.hpp"

namespace tacto::playback {
namespace {

using schema::Patch;
using schema::PatchCombine;

static_assert(noexcept(std::declval<core::SceneKernel&>().tick(nullptr, true)));
static_assert(noexcept(core::read_scene_block(nullptr, 0, std::declval<core::SceneView&>())));

schema::Device sandpaper() {
  return *schema::read_device("sandpaper-1990");
}

// Limits so high that none is active.
schema::Device unlimited(double encoder_step_m = 1e-5) {
  schema::Device device = sandpaper();
  for (schema::DeviceAxis& axis : device.axes) {
    axis.peak_force_n = axis.continuous_force_n = 1e9;
    axis.encoder_step_m = encoder_step_m;
  }
  device.peak_force_n = device.continuous_force_n = device.slew_n_per_s = 1e9;
  device.slew_n_per_s = 1e15;
  return device;
}

schema::ForceLayer spring(double stiffness_n_per_m, double centre_x_m = 0, double centre_y_m = 0) {
  return schema::SpringLayer{{stiffness_n_per_m}, {centre_x_m}, {centre_y_m}, ""};
}

schema::ForceLayer damper(double damping_n_s_per_m) {
  return schema::DamperLayer{{damping_n_s_per_m}, ""};
}

schema::ForceLayer body(double mass_kg, double stiffness_n_per_m, double damping_n_s_per_m,
                        double static_n = 0, double kinetic_n = 0) {
  return schema::BodyLayer{{mass_kg}, {stiffness_n_per_m}, {damping_n_s_per_m}, {static_n}, {kinetic_n}, ""};
}

schema::ForceLayer lasso(double mass_kg, double stiffness_n_per_m, double length_m,
                         double damping_n_s_per_m) {
  return schema::LassoLayer{{mass_kg}, {stiffness_n_per_m}, {length_m}, {damping_n_s_per_m}, ""};
}

schema::ForceLayer mover(double speed_mps, double damping_n_s_per_m, double direction_deg) {
  return schema::MoverLayer{{speed_mps}, {damping_n_s_per_m}, {direction_deg}, ""};
}

schema::GroovesLayer grooves(schema::GrooveProfile profile, double period_m, double depth_m, double kappa_n,
                             double direction_deg = 0, std::optional<schema::LayerNumber> filter_m = {}) {
  return {profile, {period_m}, {depth_m}, {kappa_n}, {direction_deg}, filter_m, {1.5}, ""};
}

schema::ForceLayer noise(double period_m, int octaves, double roughness, double seed, double depth_m,
                         double kappa_n) {
  return schema::NoiseLayer{
      {period_m}, {static_cast<double>(octaves)}, {roughness}, {seed}, {depth_m}, {kappa_n}, ""};
}

// Written to a file, which the layer names.
schema::ForceLayer height_map(const std::string& name, std::size_t columns, std::size_t rows, double pitch_m,
                              double kappa_n, const std::function<double(double, double)>& height_m) {
  schema::HeightMap map;
  map.columns = columns, map.rows = rows, map.pitch_m = pitch_m;
  for (std::size_t j = 0; j < rows; ++j)
    for (std::size_t i = 0; i < columns; ++i)
      map.height_m.push_back(static_cast<float>(height_m(static_cast<double>(i), static_cast<double>(j))));
  const std::string path = schema::height_map_path(testing::TempDir() + name);
  EXPECT_TRUE(schema::write_height_map(path, map, schema::Existing::replace));
  return schema::HeightMapLayer{path, {kappa_n}, "", 0};
}

// The same; `force_n` by the number of the sample.
schema::ForceLayer texture(const std::string& name, std::size_t samples, double pitch_m, double direction_deg,
                           double gain, const std::function<double(double)>& force_n) {
  schema::Texture made;
  made.signal.pitch_m = pitch_m;
  for (std::size_t i = 0; i < samples; ++i) made.signal.values.push_back(force_n(static_cast<double>(i)));
  const std::string path = testing::TempDir() + name;
  EXPECT_TRUE(schema::write_texture(path, made));
  return schema::TextureForceLayer{path, {direction_deg}, {gain}, "", 0};
}

Patch patch(const std::string& name, std::vector<schema::ForceLayer> layers) {
  Patch made;
  made.name = name;
  made.width_m = made.height_m = 0.2;
  made.layers = std::move(layers);
  return made;
}

PreparedScene prepared(std::vector<Patch> patches, const schema::Device& device = sandpaper()) {
  schema::Scene scene;
  scene.patches = std::move(patches);
  auto made = prepare_scene(scene, "s.scene.json", device, 1000);
  EXPECT_TRUE(made) << message(made.error());
  return made ? *made : PreparedScene{};
}

struct OnDevice {
  schema::Device device;
  PreparedScene scene;
  core::SceneKernel kernel;
  std::vector<float> live;

  OnDevice(const schema::Device& on, std::vector<Patch> patches)
      : device(on), scene(prepared(std::move(patches), on)), live(scene.view().live_words()) {
    kernel.set(scene.view(), *force_setup_of(device, 1000), live.data());
  }
  core::ForceOutput at(double x_m, double y_m) {
    const std::int32_t counts[2] = {
        static_cast<std::int32_t>(std::lround(x_m / device.axes[0].encoder_step_m)),
        static_cast<std::int32_t>(std::lround(y_m / device.axes[1].encoder_step_m))};
    return kernel.tick(counts, true);
  }
  // In the block.
  std::uint32_t patch_named(const std::string& name) const {
    const auto found = std::ranges::find(scene.patches, name, &Patch::name);
    return static_cast<std::uint32_t>(found - scene.patches.begin());
  }
};

TEST(SceneKernel, ASpringPullsToItsCentreInTheAxesOfThePatch) {
  Patch turned = patch("turned", {spring(100, 0.01, 0)});
  turned.x_m = 0.02;
  turned.angle_deg = 90;  // its x axis is the plane's y axis
  OnDevice on(unlimited(), {turned});
  const core::ForceOutput output = on.at(0.03, 0.02);
  EXPECT_NEAR(output.force_n[0], -100 * 0.01, 1e-6);  // the centre is at (0.02, 0.01)
  EXPECT_NEAR(output.force_n[1], -100 * 0.01, 1e-6);
}

TEST(SceneKernel, TheTopmostPatchActsAndThoseThatAdd) {
  Patch low = patch("low", {spring(1)}), high = patch("high", {spring(10)}),
        more = patch("more", {spring(100)});
  low.order = 1;
  high.order = 2;
  high.width_m = 0.1;
  more.combine = PatchCombine::add;
  for (const double order : {0.0, 3.0}) {
    more.order = order;  // above or below: it acts
    OnDevice on(unlimited(), {high, more, low});
    EXPECT_NEAR(on.at(0.04, 0).force_n[0], -110 * 0.04, 1e-5);
    EXPECT_NEAR(on.at(0.08, 0).force_n[0], -101 * 0.08, 1e-5);
    EXPECT_EQ(on.at(0.11, 0).force_n[0], 0);
  }
  low.order = 2;  // of equal orders the later patch
  OnDevice later(unlimited(), {high, low});
  EXPECT_NEAR(later.at(0.04, 0).force_n[0], -0.04, 1e-7);
  OnDevice other(unlimited(), {low, high});
  EXPECT_NEAR(other.at(0.04, 0).force_n[0], -0.4, 1e-6);
}

TEST(SceneKernel, DampersAndSurfacesNeedTheSpeed) {
  EXPECT_FALSE(prepared({patch("a", {spring(1)})}).view().needs_speed);
  EXPECT_TRUE(
      prepared({patch("a", {grooves(schema::GrooveProfile::sine, 1e-3, 1e-4, 1)})}).view().needs_speed);
  EXPECT_TRUE(prepared({patch("a", {spring(1), damper(1)})}).view().needs_speed);
}

TEST(SceneKernel, ADamperOfTwoTicksTakesTheirDifference) {
  OnDevice on(unlimited(1e-5), {patch("a", {schema::DamperLayer{{2}, "", false, true}})});
  EXPECT_FALSE(on.scene.view().needs_speed);
  const auto force_at = [&](std::int32_t x) {
    const std::int32_t counts[2] = {x, 0};
    return on.kernel.tick(counts, true).force_n[0];
  };
  EXPECT_EQ(force_at(700), 0);  // there is no tick before it
  EXPECT_EQ(force_at(700), 0);
  EXPECT_FLOAT_EQ(force_at(701), -0.02F);  // one count of 10 um in 1 ms
  EXPECT_EQ(force_at(701), 0);
  EXPECT_FLOAT_EQ(force_at(698), 0.06F);
}

// The sum of the absolute forces of the harmonics.
double largest_slope_n(const schema::GroovesLayer& layer) {
  const auto resolved = prepared({patch("a", {layer})})
                            .patches[0]
                            .layers[0]
                            .visit([](const schema::GroovesLayer& of) { return of; },
                                   [&](const auto& /*other*/) { return layer; });
  const double period_m = layer.period_m.value;
  double sum = 0;
  const auto amplitudes = groove_amplitudes(layer.profile, resolved.filter_m->value / period_m);
  for (std::size_t n = 1; n <= amplitudes.size(); ++n)
    sum += static_cast<double>(n) * std::abs(amplitudes[n - 1]);
  return layer.kappa_n.value * layer.depth_m.value * 2 * std::numbers::pi / period_m * sum;
}

TEST(SceneKernel, GroovesPushDownTheirSlopeAcrossThem) {
  Patch turned = patch("turned", {grooves(schema::GrooveProfile::sine, 2e-3, 1e-4, 1.5, 20)});
  turned.x_m = 0.0123;
  turned.y_m = -0.004;
  turned.angle_deg = 30;
  const double angle = 50 * std::numbers::pi / 180, turn = 2 * std::numbers::pi / 2e-3;
  OnDevice on(unlimited(1e-9), {turned});
  std::mt19937_64 random(50);
  std::uniform_real_distribution<double> place(-0.06, 0.06);
  double worst = 0;
  for (int i = 0; i < 1000; ++i) {
    const double x = std::round(place(random) * 1e9) * 1e-9, y = std::round(place(random) * 1e9) * 1e-9;
    on.kernel.set(on.scene.view(), *force_setup_of(on.device, 1000), on.live.data());
    const core::ForceOutput output = on.at(x, y);
    const double across = (x - 0.0123) * std::cos(angle) + (y + 0.004) * std::sin(angle);
    const double force_n = 1.5 * 0.5e-4 * turn * std::sin(turn * across);
    worst = std::max({worst, std::abs(output.force_n[0] - force_n * std::cos(angle)),
                      std::abs(output.force_n[1] - force_n * std::sin(angle))});
  }
  // Of 0.236 N: the rounding of single precision, also 40 periods from the centre and 8e7 counts from 0.
  EXPECT_LT(worst, 0.236 * 3e-7);
}

// Sliders are accepted where the block has a number, and nowhere else.
TEST(SceneKernel, NumbersOfTheBlockAreThoseThatCanHaveASlider) {
  const schema::ForceLayer layers[] = {
      schema::SpringLayer{},    schema::DamperLayer{},       schema::GroovesLayer{}, schema::NoiseLayer{},
      schema::HeightMapLayer{}, schema::TextureForceLayer{}, schema::BodyLayer{},    schema::LassoLayer{},
      schema::MoverLayer{},     schema::FieldLayer{},        schema::ForceMapLayer{}};
  for (const schema::ForceLayer& layer : layers) {
    std::vector<std::string_view> in_block = numbers_in_block(layer), changing;
    for (const schema::NamedLayerNumber& number : numbers_of(layer))
      if (number.changes) changing.push_back(number.name);
    std::ranges::sort(in_block), std::ranges::sort(changing);
    EXPECT_EQ(in_block, changing) << type_of(layer);
    EXPECT_FALSE(in_block.empty());
  }
}

TEST(SceneKernel, DepthAndKappaChangeInATickAndThePeriodIsNoNumber) {
  const schema::ForceLayer layer = grooves(schema::GrooveProfile::sine, 2e-3, 1e-4, 1.5);
  EXPECT_EQ(numbers_in_block(layer), (std::vector<std::string_view>{"depth_m", "kappa_n"}));
  OnDevice on(unlimited(), {patch("a", {layer})});
  const double at_m = 0.25 * 2e-3, full_n = 1.5 * 0.5e-4 * 2 * std::numbers::pi / 2e-3;
  EXPECT_NEAR(on.at(at_m, 0).force_n[0], full_n, 1e-6);
  on.kernel.change(0, core::kSurfaceKappa, 3, 1);
  EXPECT_NEAR(on.at(at_m, 0).force_n[0], 2 * full_n, 1e-6);
  on.kernel.change(0, core::kSurfaceDepth, 0.5e-4F, 1);
  EXPECT_NEAR(on.at(at_m, 0).force_n[0], full_n, 1e-6);
  EXPECT_TRUE(core::number_fits(on.scene.view(), 0, core::kSurfaceKappa, 1000));
  EXPECT_FALSE(core::number_fits(on.scene.view(), 0, core::kSurfaceKappa, 1001));
  EXPECT_FALSE(core::number_fits(on.scene.view(), 0, core::kSurfaceDepth, -1e-6F));
  EXPECT_FALSE(core::number_fits(on.scene.view(), 0, 2, 0));
}

// The steepest place of a smoothed step has 0.242 depth / sigma^2, so margin^2 below the limit.
TEST(PreparedScene, TheAutomaticFilterHoldsTheStiffnessLimit) {
  schema::Device device = sandpaper();
  device.axes[1].viscous_n_s_per_m = 0.5;  // the weaker axis counts
  const double limit = free_stiffness_limit(0.1, 0.5, 1e-3, 0);
  for (const auto profile : {schema::GrooveProfile::square, schema::GrooveProfile::triangle}) {
    schema::GroovesLayer layer = grooves(profile, 5e-3, 0, 2);
    layer.depth_m = {1e-4, schema::SliderRange{0, 3e-4}};  // the upper end counts
    const PreparedScene scene = prepared({patch("a", {layer})}, device);
    EXPECT_EQ(scene.stiffness_limit_n_per_m, limit);
    const double margin = profile == schema::GrooveProfile::square ? 1.5 * 1.5 : 1.5;
    // 3 %: the neighbouring step or kink, half a period away.
    EXPECT_NEAR(local_stiffness_n_per_m(scene.patches[0].layers[0]), limit / margin, 0.03 * limit);
  }
  const schema::Hand hand{"mine", 0.8, 3, 400, "test", "", "", ""};
  EXPECT_EQ(stiffness_limit_of(device, 1000, hand), stiffness_limit({0.9, 3.5, 400}, {1e-3, 0}, 0));
  device.axes[0].viscous_n_s_per_m = 0;
  schema::Scene scene;
  scene.patches = {patch("a", {grooves(schema::GrooveProfile::square, 5e-3, 1e-4, 2)})};
  EXPECT_EQ(prepare_scene(scene, "s", device, 1000).error().where, "s#/patches/0/layers/0/filter_m");
}

// Power of forces over a second of 1 kHz: at the multiples of `base_hz`, a whole number, and elsewhere.
struct Powers {
  double harmonics = 0, rest = 0, at_400_hz = 0;
};

Powers powers_of(const std::vector<double>& force_n, double base_hz) {
  Powers powers;
  const std::size_t n = force_n.size();
  for (std::size_t bin = 1; bin < n / 2; ++bin) {
    std::complex<double> sum;
    for (std::size_t i = 0; i < n; ++i)
      sum += force_n[i] * std::polar(1.0, -2 * std::numbers::pi * static_cast<double>(bin * i % n) /
                                              static_cast<double>(n));
    const double hz = 1000 * static_cast<double>(bin) / static_cast<double>(n), of = hz / base_hz;
    const double power = std::norm(sum);
    (std::abs(of - std::round(of)) * base_hz < 1e-6 ? powers.harmonics : powers.rest) += power;
    if (std::abs(hz - 400) < 1e-6) powers.at_400_hz = power;
  }
  return powers;
}

TEST(SceneKernel, NoFrequencyAboveHalfTheRateIsPlayed) {
  const schema::ForceLayer layer =
      grooves(schema::GrooveProfile::square, 5e-4, 1e-5, 1, 0, schema::LayerNumber{2e-5});
  double worst_db = -300;
  for (const double speed_mps : {0.0105, 0.03, 0.051, 0.0855, 0.1315, 0.1815, 0.2105, 0.237, 0.3, 0.5}) {
    Patch wide = patch("a", {layer});
    wide.width_m = 2;
    OnDevice on(unlimited(1e-9), {wide});
    std::vector<double> force_n;
    for (int tick = -100; tick < 1000; ++tick) {
      const float force = on.at(speed_mps * 1e-3 * tick + 1.234e-6, 0).force_n[0];
      if (tick >= 0) force_n.push_back(double{force});
    }
    const Powers powers = powers_of(force_n, speed_mps / 5e-4);
    if (speed_mps > 0.25) {
      EXPECT_EQ(powers.harmonics + powers.rest, 0) << speed_mps;
      continue;
    }
    worst_db = std::max(worst_db, 10 * std::log10(powers.rest / powers.harmonics));
  }
  std::printf("  square grooves at steady speeds: what is no harmonic is at most %.1f dB\n", worst_db);
  EXPECT_LT(worst_db, -65);
  // Without the fade, 600 Hz alias to 400 Hz.
  std::vector<float> amplitudes;
  for (const double amplitude : groove_amplitudes(schema::GrooveProfile::square, 0.04))
    amplitudes.push_back(static_cast<float>(amplitude));
  const core::Grooves series{amplitudes.data(), static_cast<std::uint32_t>(amplitudes.size())};
  std::vector<double> aliased;
  for (int tick = 0; tick < 1000; ++tick)
    aliased.push_back(
        double{core::groove_at(series, static_cast<std::uint32_t>(std::fmod(0.6 * tick, 1.0) * 0x1p32), 0)
                   .by_phase});
  const Powers powers = powers_of(aliased, 600);
  EXPECT_GT(powers.at_400_hz, 0.3 * (powers.harmonics + powers.rest));
}

// Against the heights in double precision, by central differences; of single precision 2e-6 per octave.
TEST(SceneKernel, NoisePushesDownItsSlope) {
  Patch turned = patch("turned", {noise(3e-3, 4, 0.6, 7, 2e-4, 1.5)});
  turned.x_m = 0.0123;
  turned.angle_deg = -35;
  OnDevice on(unlimited(1e-9), {turned});
  const core::NoiseTable table = core::shuffled_noise(7);
  const double c = std::cos(-35 * std::numbers::pi / 180), s = std::sin(-35 * std::numbers::pi / 180);
  const auto height_m = [&](double x_m, double y_m) {
    const double u = (c * (x_m - 0.0123) + s * y_m) / 3e-3, v = (c * y_m - s * (x_m - 0.0123)) / 3e-3;
    double sum = 0, weights = 0;
    for (int i = 0; i < 4; ++i) {
      sum += std::pow(0.6, i) * exact_noise(table, std::exp2(i) * u, std::exp2(i) * v, 0);
      weights += std::pow(0.6, i);
    }
    return 2e-4 * 0.5 * sum / weights;
  };
  std::mt19937_64 random(51);
  std::uniform_real_distribution<double> place(-0.06, 0.06);
  double worst = 0, largest = 0;
  for (int i = 0; i < 2000; ++i) {
    const double x = std::round(place(random) * 1e9) * 1e-9, y = std::round(place(random) * 1e9) * 1e-9;
    on.kernel.set(on.scene.view(), *force_setup_of(on.device, 1000), on.live.data());
    const core::ForceOutput output = on.at(x, y);
    const double h = 1e-8, by_x = (height_m(x + h, y) - height_m(x - h, y)) / (2 * h),
                 by_y = (height_m(x, y + h) - height_m(x, y - h)) / (2 * h);
    worst =
        std::max({worst, std::abs(output.force_n[0] + 1.5 * by_x), std::abs(output.force_n[1] + 1.5 * by_y)});
    largest = std::max(largest, 1.5 * std::hypot(by_x, by_y));
  }
  std::printf("  noise of four octaves: within %.2g N, of %.2g N\n", worst, largest);
  EXPECT_GT(largest, 0.05);
  EXPECT_LT(worst, 2e-6 * 1.5 * 2e-4 * 0.5 / 3e-3 * (1 + 1.2 + 1.44 + 1.728) / (1 + 0.6 + 0.36 + 0.216) * 2);
}

// The octave whose frequencies pass half the rate is not played; at rest all are.
TEST(SceneKernel, OctavesEndWithTheSpeed) {
  const auto power = [&](int octaves, double speed_mps) {
    Patch wide = patch("a", {noise(4e-3, octaves, 1, 0, 1e-4, 1)});
    wide.width_m = 10;
    OnDevice on(unlimited(1e-7), {wide});
    double sum = 0;
    for (int tick = -50; tick < 4000; ++tick) {
      const core::ForceOutput output = on.at(speed_mps * 1e-3 * tick - 1, 1e-3);
      // The amplitudes are 1 / (2 octaves).
      if (tick >= 0) sum += std::pow(double{output.force_n[1]} * octaves, 2) / 4000;
    }
    return sum;
  };
  // 0.3 m/s: 0.15 cycles per tick of the lowest octave, 0.3, 0.6 of the third.
  EXPECT_NEAR(power(3, 0.3), power(2, 0.3), 1e-5 * power(2, 0.3));
  EXPECT_GT(power(3, 0.1), 2 * power(2, 0.1));
  EXPECT_EQ(power(1, 1.01), 0);
}

// Layers, patches and numbers at random, a hand that wanders, rests and jumps: the differences are those of
// single precision. The bound is relative to the sum of the absolute forces of one layer of each patch.
// The reference has the patches where the file puts them. Every second scene of the kernel begins with other
// places and another order, and is moved and raised to them.
TEST(SceneKernel, SinglePrecisionIsTheReference) {
  std::mt19937_64 random(1990);
  const auto draw = [&](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  };
  double worst = 0;
  for (int scene = 0; scene < 30; ++scene) {
    std::vector<Patch> patches;
    double scale = 0;
    for (int i = 0; i < 4; ++i) {
      const double k = draw(0, 3000), b = draw(0, 10);
      patches.push_back(
          patch("p" + std::to_string(i), {spring(k, draw(-0.05, 0.05), draw(-0.05, 0.05)), damper(b),
                                          schema::DamperLayer{{b}, "", false, true}}));
      const auto profile = static_cast<schema::GrooveProfile>(i % 3);
      const schema::GroovesLayer wave =
          grooves(profile, draw(5e-4, 5e-3), draw(0, 1e-3), draw(0, 3), draw(-360, 360));
      patches.back().layers.push_back(wave);
      scale += largest_slope_n(wave);
      const double cell_m = draw(1e-3, 1e-2), depth_m = draw(0, 1e-3), kappa_n = draw(0, 1);
      patches.back().layers.push_back(noise(cell_m, 1 + i, 0.5, i, depth_m, kappa_n));
      scale += kappa_n * depth_m / cell_m * 2;  // the slope of an octave is within 4 per cell
      const double pitch_m = draw(5e-4, 5e-3), white_m = draw(0, 3e-5);
      patches.back().layers.push_back(height_map("map" + std::to_string(i), 40, 30, pitch_m, kappa_n,
                                                 [&](double, double) { return draw(-white_m, white_m); }));
      scale += kappa_n * white_m / pitch_m * 6;  // coefficients of white heights are within 3 of them
      const double gain = draw(-2, 2), white_n = draw(0, 0.5);
      patches.back().layers.push_back(texture("texture" + std::to_string(i), 600, 1e-4, draw(-360, 360), gain,
                                              [&](double) { return draw(-white_n, white_n); }));
      scale += std::abs(gain) * white_n * 3;  // as of the height maps
      patches.back().x_m = draw(-0.05, 0.05);
      patches.back().angle_deg = draw(-360, 360);
      patches.back().order = draw(-1, 1);
      patches.back().combine = i % 2 == 0 ? PatchCombine::add : PatchCombine::topmost;
      scale += k * 0.2 + 2 * b * 1;  // at most 0.2 m and about 1 m/s
    }
    const PreparedScene placed = prepared(patches, unlimited());
    std::vector<std::array<std::int32_t, 2>> ways;
    for (Patch& from : patches) {
      const auto way = [&] { return scene % 2 == 0 ? 0 : static_cast<std::int32_t>(draw(-2000, 2000)); };
      ways.push_back({way(), way()});
      from.x_m -= 1e-5 * ways.back()[0];
      from.y_m -= 1e-5 * ways.back()[1];
      if (scene % 2 != 0) from.order = draw(-1, 1);
    }
    OnDevice on(unlimited(), patches);
    ExactScene exact(placed, on.device, 1000);
    for (std::size_t i = 0; i < patches.size() && scene % 2 != 0; ++i)
      on.kernel.move(on.patch_named(patches[i].name), {ways[i][0], ways[i][1]}, 1);
    for (auto patch = placed.patches.rbegin(); patch != placed.patches.rend() && scene % 2 != 0; ++patch)
      on.kernel.raise(on.patch_named(patch->name));
    std::vector<std::int32_t> counts(2);
    double speed[2] = {};
    for (int tick = 0; tick < 3000; ++tick) {
      for (int i = 0; i < 2; ++i) {
        speed[i] = 0.99 * speed[i] + (tick % 1000 < 700 ? draw(-3, 3) : 0);  // counts per tick
        counts[i] = std::clamp(counts[i] + static_cast<int>(speed[i]), -10000, 10000);
      }
      const core::ForceOutput output = on.kernel.tick(counts.data(), true);
      const ExactScene::Output reference = exact.tick(counts);
      for (std::size_t i = 0; i < 2; ++i)
        worst = std::max(worst, std::abs(output.force_n[i] - reference.force_n[i]) / scale);
    }
  }
  std::printf("  scene kernel: within %.2g of the sum of the forces of all layers\n", worst);
  EXPECT_LT(worst, 3e-7);
}

// A hand that is led along x and y, and its forces beside those of double precision.
struct LedHand {
  OnDevice on;
  ExactScene exact;
  double worst_n = 0, largest_n = 0;

  explicit LedHand(const Patch& patch) : on(unlimited(1e-7), {patch}), exact(on.scene, on.device, 1000) {}
  core::ForceOutput tick(double x_m, double y_m) {
    const std::vector<std::int32_t> counts = {static_cast<std::int32_t>(std::lround(x_m * 1e7)),
                                              static_cast<std::int32_t>(std::lround(y_m * 1e7))};
    const core::ForceOutput output = on.kernel.tick(counts.data(), true);
    const ExactScene::Output reference = exact.tick(counts);
    for (std::size_t i = 0; i < 2; ++i) {
      worst_n = std::max(worst_n, std::abs(double{output.force_n[i]} - reference.force_n[i]));
      largest_n = std::max(largest_n, std::abs(reference.force_n[i]));
    }
    return output;
  }
  const core::BodyState& state(std::size_t numbers) const {
    return *reinterpret_cast<const core::BodyState*>(on.live.data() + numbers);
  }
};

TEST(SceneKernel, AFreeBodysMomentumIsTheImpulseOfItsForce) {
  LedHand hand(patch("a", {body(0.3, 200, 1)}));
  double impulse[2] = {}, worst = 0, largest = 0;
  for (int tick = 0; tick < 60000; ++tick) {
    const double t = 1e-3 * tick;
    const auto output =
        hand.tick(0.02 * std::sin(4.4 * t) + 0.01 * std::sin(8.2 * t + 1), 0.02 * std::cos(3.1 * t));
    const core::BodyState& state = hand.state(4);
    const double momentum[2] = {0.3 * (double{state.speed_mps.x} + double{state.speed_rest_mps.x}),
                                0.3 * (double{state.speed_mps.y} + double{state.speed_rest_mps.y})};
    for (int i = 0; i < 2; ++i) {
      impulse[i] -= 1e-3 * double{output.unlimited_n[i]};
      worst = std::max(worst, std::abs(momentum[i] - impulse[i]));
      largest = std::max(largest, std::abs(momentum[i]));
    }
  }
  std::printf("  a body over 60 s: momentum within %.2g of the impulse\n", worst / largest);
  EXPECT_GT(largest, 0.01);
  EXPECT_LT(worst, 1e-6 * largest);
  // The hand's place has 24 bits: 200 N/m times 0.03 m times 2^-24, and the resonance of the body.
  EXPECT_LT(hand.worst_n, 3e-5 * hand.largest_n);
}

// At rest up to the static friction, then a constant kinetic one, which is near enough that it does not stick
// again.
TEST(SceneKernel, DryFrictionHoldsABodyAndThenBrakesIt) {
  LedHand hand(patch("a", {body(0.2, 400, 4, 1.55, 1.5)}));
  double moved_from_m = 0;
  for (int tick = 0; tick < 1000; ++tick) {
    const double x_m = 1e-5 * tick;
    hand.tick(x_m, 0);
    if (moved_from_m == 0 && hand.state(4).speed_mps.x != 0) moved_from_m = x_m;
  }
  // 400 N/m x + 4 N s/m 0.01 m/s = 1.55 N, to the step of the path.
  EXPECT_NEAR(moved_from_m, (1.55 - 0.04) / 400, 2e-5);
  float steady_n = 0;
  for (int tick = 1000; tick < 5000; ++tick) steady_n = hand.tick(1e-5 * tick, 0).force_n[0];
  EXPECT_NEAR(steady_n, -1.5F, 0.02F);  // drawn at the speed of the hand
  for (int tick = 0; tick < 3000; ++tick) hand.tick(0.05, 0);
  EXPECT_EQ(hand.state(4).speed_mps.x, 0);
  EXPECT_EQ(hand.state(4).speed_mps.y, 0);
  const float rests_at_m = hand.state(4).place_m.x;
  for (int tick = 0; tick < 1000; ++tick) hand.tick(0.05, 0);
  EXPECT_EQ(hand.state(4).place_m.x, rests_at_m);
  // The place has 24 bits: 400 N/m times 0.05 m times 2^-24 are 1.2e-6 N.
  EXPECT_LT(hand.worst_n, 5e-6);
}

TEST(SceneKernel, ALassoOnlyPulls) {
  Patch turned = patch("a", {lasso(0.1, 300, 0.01, 0.5)});
  turned.angle_deg = 30;
  LedHand hand(turned);
  double pulls = 0, slack = 0;
  for (int tick = 0; tick < 20000; ++tick) {
    const double t = 1e-3 * tick, x_m = 0.02 * std::sin(9 * t), y_m = 0.02 * std::cos(7 * t) - 0.02;
    const core::BodyState before = hand.state(2);
    const core::ForceOutput output = hand.tick(x_m, y_m);
    if (tick == 0) continue;
    // From the hand to the mass, in the plane.
    const double c = std::cos(std::numbers::pi / 6), s = 0.5;
    const double way[2] = {c * double{before.place_m.x} - s * double{before.place_m.y} - x_m,
                           s * double{before.place_m.x} + c * double{before.place_m.y} - y_m};
    const double distance = std::hypot(way[0], way[1]), tension = std::max(0.0, 300 * (distance - 0.01));
    (tension > 0 ? pulls : slack) += 1;
    for (int i = 0; i < 2; ++i)
      ASSERT_NEAR(output.force_n[i], tension * way[i] / distance, 300 * 2e-7) << tick;  // rounding of counts
  }
  EXPECT_GT(pulls, 1000);
  EXPECT_GT(slack, 1000);
  EXPECT_LT(hand.worst_n, 3e-4 * hand.largest_n);  // a swing through slack and taut enlarges rounding
}

TEST(SceneKernel, AMoverDragsTheHand) {
  Patch turned = patch("a", {mover(0.2, 5, 30)});
  turned.angle_deg = 20;
  LedHand hand(turned);
  core::ForceOutput output;
  for (int tick = 0; tick < 100; ++tick) output = hand.tick(0, 0);
  const double along = 50 * std::numbers::pi / 180;
  EXPECT_NEAR(output.force_n[0], 5 * 0.2 * std::cos(along), 1e-6);
  EXPECT_NEAR(output.force_n[1], 5 * 0.2 * std::sin(along), 1e-6);
  for (int tick = 0; tick < 200; ++tick)
    output = hand.tick(2e-4 * std::cos(along) * tick, 2e-4 * std::sin(along) * tick);
  EXPECT_NEAR(output.force_n[0], 0, 0.05);  // one count per tick is 5e-4 N
  EXPECT_LT(hand.worst_n, 1e-5);
}

// The hand leaves its patch and comes back: the body is where the hand enters, at rest. The same again after
// set(), to the bit.
TEST(SceneKernel, ABodyIsTakenUpWhereTheHandEnters) {
  Patch small = patch("a", {body(0.2, 400, 4)});
  small.width_m = 0.02;
  std::vector<float> first;
  OnDevice on(unlimited(), {small});
  const auto& state = *reinterpret_cast<const core::BodyState*>(on.live.data() + 4);
  for (int run = 0; run < 2; ++run) {
    on.kernel.set(on.scene.view(), *force_setup_of(on.device, 1000), on.live.data());
    std::vector<float> forces;
    for (const double x_m : {0.0, 0.005, 0.009, 0.02, 0.02}) forces.push_back(on.at(x_m, 0).force_n[0]);
    EXPECT_LT(forces[2], -1);  // drawn after the hand
    EXPECT_EQ(forces[4], 0);   // outside
    EXPECT_GT(state.place_m.x, 0);
    forces.push_back(on.at(-0.009, 0).force_n[0]);
    // One tick of damping at 29 m/s: 116 N T^2 / 2 m = 0.29 mm.
    EXPECT_NEAR(state.place_m.x, -0.009F, 3.5e-4F);
    if (run == 0) first = forces;
    EXPECT_EQ(forces, first);
  }
}

// Of n ticks, after k of them: k / n of the way, rounded towards its beginning.
std::int32_t part_of(std::int32_t from, std::int32_t to, int k, int n) {
  const std::int64_t way = std::int64_t{to} - from, part = std::abs(way) * std::min(k, n) / n;
  return from + static_cast<std::int32_t>(way < 0 ? -part : part);
}

// The patch of the block at n - m, to the bit, while it moves and after it: so slowly that all is played
// whole.
TEST(SceneKernel, AMovingPatchHasTheForcesOfItsOldPlace) {
  Patch turned = patch(
      "a", {spring(100, 0.001), grooves(schema::GrooveProfile::sine, 4e-3, 1e-4, 1, 20),
            noise(5e-3, 2, 0.5, 3, 1e-4, 1), height_map("moved", 40, 30, 1e-3, 1, [](double x, double y) {
              return 1e-4 * std::sin(0.3 * x) * std::cos(0.2 * y);
            })});
  turned.angle_deg = 25;
  OnDevice on(unlimited(), {turned}), still(unlimited(), {turned});
  struct Event {
    int tick, ramp;
    std::int32_t to[2];
  };
  constexpr Event kEvents[] = {
      {0, 10, {407, -93}}, {20, 50, {-31, 1000}}, {40, 15, {150, 500}}, {60, 0, {140, 510}}};
  std::int32_t from[2] = {}, at[2] = {};
  const Event* last = nullptr;
  for (int tick = 0; tick < 80; ++tick) {
    for (const Event& event : kEvents) {
      if (event.tick != tick) continue;
      on.kernel.move(0, event.to, static_cast<float>(event.ramp));
      std::copy_n(at, 2, from);
      last = &event;
    }
    std::int32_t relative[2];
    const std::int32_t hand[2] = {1234, -777};
    for (int i = 0; i < 2; ++i) {
      at[i] = part_of(from[i], last->to[i], tick - last->tick + 1, std::max(last->ramp, 1));
      relative[i] = hand[i] - at[i];
    }
    const core::ForceOutput moved = on.kernel.tick(hand, true), there = still.kernel.tick(relative, true);
    EXPECT_EQ(moved.force_n[0], there.force_n[0]) << tick;
    EXPECT_EQ(moved.force_n[1], there.force_n[1]) << tick;
  }
}

// 10 periods in 10 ticks: nothing of the surface can be played until the patch rests. The hand rests.
TEST(SceneKernel, WhileItMovesASurfaceIsPlayedAtTheRelativeSpeed) {
  OnDevice on(unlimited(), {patch("a", {grooves(schema::GrooveProfile::sine, 1e-3, 1e-4, 1), damper(10)})});
  const double there_n = -on.at(0.0102, 0).force_n[0];  // 0.2 periods; the force is odd
  on.kernel.set(on.scene.view(), *force_setup_of(on.device, 1000), on.live.data());
  EXPECT_EQ(on.at(0, 0).force_n[0], 0);
  on.kernel.move(0, {1020, 0}, 10);
  for (int tick = 1; tick < 10; ++tick) EXPECT_EQ(on.at(0, 0).force_n[0], 0) << tick;
  EXPECT_NEAR(on.at(0, 0).force_n[0], there_n, 1e-6);
  EXPECT_GT(std::abs(there_n), 0.2);
}

// The 17th of 16 moves that are not complete.
TEST(SceneKernel, AFurtherMoveEndsTheOldest) {
  std::vector<Patch> patches;
  for (int i = 0; i < 17; ++i) {
    patches.push_back(patch("p" + std::to_string(i), {spring(1)}));
    patches.back().combine = PatchCombine::add;
  }
  OnDevice on(unlimited(), patches);
  for (std::uint32_t i = 0; i < 17; ++i) on.kernel.move(i, {1000, 0}, 100);
  // The first one is complete, 1 N/m x 0.01 m; 16 made 10 of 1000 counts.
  EXPECT_NEAR(on.at(0, 0).force_n[0], 0.01 + 16 * 1e-4, 1e-7);
}

// A surface of 0.5 mm at 1 kHz and steady speeds: all that is no harmonic below half the rate is an image of
// the spline or was folded by the rate. The harmonic m n falls into bin m n of 512. `first_n`: its first
// harmonic.
void expect_only_harmonics(const char* name, schema::ForceLayer layer, double first_n) {
  constexpr std::size_t kTicks = 512;
  const double period_m = 5e-4;
  OnDevice on(unlimited(1e-9), {patch("a", {std::move(layer)})});
  const double whole = std::pow(first_n * kTicks / 2, 2);  // its power in a bin
  spatial::RealFft fft(kTicks);
  for (const std::size_t m : {11U, 21U, 31U, 51U, 77U, 103U, 151U, 205U, 301U, 511U}) {
    const double step_m = period_m * static_cast<double>(m) / kTicks;
    on.kernel.set(on.scene.view(), *force_setup_of(on.device, 1000), on.live.data());
    std::vector<double> force(kTicks);
    for (int tick = -50; tick < static_cast<int>(kTicks); ++tick) {
      const core::ForceOutput output = on.at(step_m * (tick - 230.3), 0);
      if (tick >= 0) force[static_cast<std::size_t>(tick)] = double{output.force_n[0]};
    }
    std::vector<std::complex<double>> spectrum(fft.bins());
    fft.forward(force, spectrum);
    double harmonics = 0, others = 0;
    for (std::size_t bin = 0; bin < spectrum.size(); ++bin)
      (bin % m == 0 && bin > 0 ? harmonics : others) += std::norm(spectrum[bin]);
    const double others_db = 10 * std::log10(others / std::max(harmonics, whole));
    std::printf("  %s at %.3g mm/s: %.1f dB is no harmonic\n", name, 1e6 * step_m, others_db);
    EXPECT_LT(others_db, -65) << name << ' ' << m;
    // The first harmonic is whole up to 0.8 x 0.354 of the rate.
    if (100 * m < 28 * kTicks) EXPECT_GT(harmonics, 0.98 * whole) << name << ' ' << m;
  }
}

// Square grooves; at its ends the map continues evenly as the same grooves.
TEST(SceneKernel, AHeightMapAtSteadySpeedHasOnlyHarmonics) {
  const double top_m = 5e-5, first_n = 4 / std::numbers::pi * top_m * 2 * std::numbers::pi / 5e-4;
  expect_only_harmonics(
      "square grooves",
      height_map("square", 52 * 280, 1, 5e-4 / 52, 1,
                 [&](double x, double) { return std::fmod(x + 13, 52) < 26 ? top_m : -top_m; }),
      first_n);
}

TEST(SceneKernel, ATextureAtSteadySpeedHasOnlyHarmonics) {
  expect_only_harmonics("a square texture",
                        texture("square", 52 * 400, 5e-4 / 52, 0, 1,
                                [](double i) { return std::fmod(i, 52) < 26 ? 0.2 : -0.2; }),
                        4 / std::numbers::pi * 0.2);
}

// 40 mm of a sine of 2 mm. Its fade at the ends is 1 mm.
TEST(SceneKernel, ATextureIsItsForceAlongItsDirection) {
  const double turn = 2 * std::numbers::pi / 2e-3, half_m = 0.5 * 3999 * 1e-5;
  Patch turned =
      patch("turned",
            {texture("sine", 4000, 1e-5, 20, -2, [&](double i) { return 0.5 * std::sin(turn * i * 1e-5); })});
  turned.x_m = 0.0123;
  turned.y_m = -0.004;
  turned.angle_deg = 30;
  const double c = std::cos(50 * std::numbers::pi / 180), s = std::sin(50 * std::numbers::pi / 180);
  OnDevice on(unlimited(1e-9), {turned});
  std::mt19937_64 random(51);
  std::uniform_real_distribution<double> place(-0.05, 0.05);
  double worst = 0;
  int inside = 0, outside = 0;
  for (int i = 0; i < 3000; ++i) {
    const double x = std::round(place(random) * 1e9) * 1e-9, y = std::round(place(random) * 1e9) * 1e-9;
    on.kernel.set(on.scene.view(), *force_setup_of(on.device, 1000), on.live.data());
    const core::ForceOutput output = on.at(x, y);
    const double along = (x - 0.0123) * c + (y + 0.004) * s;
    if (std::abs(along) > half_m + 3e-5) {
      EXPECT_EQ(output.force_n[0], 0);
      EXPECT_EQ(output.force_n[1], 0);
      ++outside;
    }
    if (std::abs(along) > half_m - 1.1e-3) continue;
    const double force_n = -2 * 0.5 * std::sin(turn * (along + half_m));
    worst = std::max(
        {worst, std::abs(output.force_n[0] - force_n * c), std::abs(output.force_n[1] - force_n * s)});
    ++inside;
  }
  EXPECT_GT(inside, 500);
  EXPECT_GT(outside, 500);
  // Of 1 N: single precision of heights of 0.16 mm, 7e-12 m twice on a pitch of 1e-5 m, times the gain of 2.
  std::printf("  a sine as a texture: within %.2g of its amplitude\n", worst);
  EXPECT_LT(worst, 4e-6);
}

// 10 m/s across it: nothing of it changes.
TEST(SceneKernel, ATextureIsWholeForAHandThatMovesAcrossIt) {
  Patch line = patch("line", {texture("fine", 400, 1e-5, 90, 1,
                                      [](double i) { return std::sin(2 * std::numbers::pi * i / 20); })});
  OnDevice on(unlimited(), {line});
  const float rests_n = on.at(0, 5.5e-4).force_n[1];
  EXPECT_GT(std::abs(rests_n), 0.5F);
  for (int tick = 1; tick < 10; ++tick) EXPECT_EQ(on.at(0.01 * tick, 5.5e-4).force_n[1], rests_n) << tick;
  float moved_n = 0;
  for (int tick = 0; tick < 10; ++tick)
    moved_n = on.at(0, 1e-3 * tick - 4.5e-3).force_n[1];  // 5 periods per tick
  EXPECT_EQ(moved_n, 0);
}

TEST(SceneKernel, TheLimitsOfTheReferenceAreTheKernels) {
  OnDevice on(sandpaper(), {patch("stiff", {spring(3000), damper(20)})});
  ExactScene exact(on.scene, on.device, 1000);
  std::uint32_t flags = 0;
  double worst = 0;
  for (int tick = 0; tick < 4000; ++tick) {
    const std::vector<std::int32_t> counts = {
        static_cast<std::int32_t>(std::lround(1000 * std::sin(0.01 * tick))),
        static_cast<std::int32_t>(std::lround(700 * std::sin(0.37 * tick)))};
    const core::ForceOutput output = on.kernel.tick(counts.data(), true);
    const auto reference = exact.tick(counts);
    flags |= output.flags;
    for (std::size_t i = 0; i < 2; ++i)
      worst = std::max(worst, std::abs(output.force_n[i] - reference.force_n[i]));
  }
  EXPECT_EQ(flags, wire::kTickAmplitudeLimited | wire::kTickSlewLimited | wire::kTickEnergyLimited);
  std::printf("  with all limits active: within %.2g N\n", worst);
  EXPECT_LT(worst, 2e-4);  // of 20 N: rounding in the mean square over 1000 ticks
}

// Whatever the hand and the scene do: each axis, the vector, the change, and after 2 s the RMS.
TEST(SceneKernel, NoForceIsBeyondALimit) {
  schema::Device device = sandpaper();
  device.axes[1].peak_force_n = 12;
  device.peak_force_n = 16;
  device.slew_n_per_s = 3000;
  std::mt19937_64 random(3);
  std::uniform_int_distribution<std::int32_t> anywhere(-10000, 10000);
  OnDevice on(device, {patch("a", {spring(1e6), damper(1e4)})});
  float last[2] = {};
  for (int tick = 0; tick < 20000; ++tick) {
    const std::int32_t hold = tick % 20;
    static std::int32_t counts[2];
    if (hold == 0)
      for (std::int32_t& count : counts) count = anywhere(random);
    const core::ForceOutput output = on.kernel.tick(counts, tick % 5000 < 4900);
    for (int i = 0; i < 2; ++i) {
      ASSERT_LE(std::abs(output.force_n[i]), i == 0 ? 20 : 12);
      ASSERT_LE(std::abs(output.force_n[i] - last[i]),
                3 * (1 + 1e-5));  // rounding of 20 N in single precision
      last[i] = output.force_n[i];
    }
    ASSERT_LE(std::hypot(output.force_n[0], output.force_n[1]), 16 * (1 + 0x1p-22));
  }
}

TEST(SceneKernel, TheRmsIsTheContinuousForceAfterItsWindow) {
  OnDevice on(sandpaper(), {patch("a", {spring(1000)})});
  double square = 0;
  for (int tick = 0; tick < 5000; ++tick) {
    const core::ForceOutput output = on.at(0.015, 0.01);  // 15 and 10 N; continuous 5 N
    if (tick >= 4000) square += std::pow(std::hypot(output.force_n[0], output.force_n[1]), 2) / 1000;
  }
  EXPECT_NEAR(std::sqrt(square), 5, 0.1);  // 2 %, as of EnergyLimiter
}

TEST(SceneKernel, WithoutRaiseTheForceFallsToZeroAndRests) {
  schema::Device device = unlimited();
  OnDevice on(device, {patch("a", {spring(100)})});
  core::ForceSetup setup = *force_setup_of(device, 1000);
  setup.onset_s = setup.release_s = 0.01F;
  on.kernel.set(on.scene.view(), setup, on.live.data());
  const std::int32_t counts[2] = {1000, 0};
  float last = 0;
  for (int tick = 0; tick < 12; ++tick) {
    const float force_n = on.kernel.tick(counts, true).force_n[0];
    EXPECT_LE(force_n, last);
    last = force_n;
  }
  EXPECT_NEAR(last, -1, 1e-6);
  EXPECT_FALSE(on.kernel.at_rest());
  for (int tick = 0; tick < 11; ++tick) last = on.kernel.tick(counts, false).force_n[0];
  EXPECT_EQ(last, 0);
  EXPECT_TRUE(on.kernel.at_rest());
}

// The speed of a hand at constant speed: its error is below 1 count / (ticks of 15 edges), as stated.
TEST(EdgeSpeed, AtConstantSpeedTheGrainIsBelowItsBound) {
  for (const double per_tick : {0.013, 0.11, 0.37, 0.7, 1.3, 2.61, 7.7, 200.123}) {
    core::EdgeSpeed speed;
    speed.rest();
    const double bound = std::min(1.0, per_tick) / 15;
    double worst = 0;
    for (int tick = 0; tick < 20000; ++tick) {
      const float found = speed.track(static_cast<std::int32_t>(std::floor(per_tick * tick)));
      if (per_tick * tick > 40 && tick > 40) worst = std::max(worst, std::abs(found - per_tick));
    }
    EXPECT_LE(worst, bound * (1 + 1e-6)) << per_tick;
  }
}

TEST(EdgeSpeed, ABorderThatIsCrossedTwiceIsNoMotion) {
  core::EdgeSpeed speed;
  speed.rest();
  for (int tick = 0; tick < 100; ++tick) {
    const float found = speed.track(tick / 3 % 2);
    if (tick > 5) EXPECT_EQ(found, 0) << tick;
  }
}

// From rest and back to it: the old time of rest does not count, and without edges the speed falls as 1 / t.
TEST(EdgeSpeed, AMotionThatBeginsAndEnds) {
  core::EdgeSpeed speed;
  speed.rest();
  for (int tick = 0; tick < 1000; ++tick) EXPECT_EQ(speed.track(7), 0);
  EXPECT_EQ(speed.track(12), 5);
  EXPECT_EQ(speed.track(17), 5);
  for (int since = 1; since < 50; ++since) EXPECT_LE(speed.track(17), 1.0F / static_cast<float>(since));
  EXPECT_GT(speed.track(17), 0);
}

// A slow hand that was beside a border at the start, or after a rest longer than the longest window: one edge
// is no speed yet, two of them are one count in 100 ticks.
TEST(EdgeSpeed, TheFirstEdgeAfterARestIsNoSpeed) {
  for (const std::uint32_t rest : {1U, 7U, core::kLongestSpeedTicks + 3}) {
    core::EdgeSpeed speed;
    speed.rest();
    for (std::uint32_t tick = 0; tick < rest; ++tick) ASSERT_EQ(speed.track(3), 0);
    for (int tick = 0; tick < 100; ++tick) ASSERT_EQ(speed.track(4), 0) << rest << ' ' << tick;
    EXPECT_FLOAT_EQ(speed.track(5), 0.01F) << rest;
  }
}

// A hand that accelerates: the mean of the window lags by half of it, and the window shortens.
TEST(EdgeSpeed, AnAccelerationShortensTheWindow) {
  core::EdgeSpeed speed;
  speed.rest();
  const double a = 2;  // counts per tick^2: a line over n ticks differs by a n^2 / 8, so n is 2 at most
  for (int tick = 0; tick < 500; ++tick) {
    const float found = speed.track(static_cast<std::int32_t>(std::floor(a / 2 * tick * tick)));
    if (tick > 10) EXPECT_NEAR(found, a * tick, a * 1.5 + 1);
  }
}

PreparedScene block_of_all() {
  Patch bodies = patch("c", {body(0.2, 400, 4, 2, 1), lasso(0.1, 300, 0.01, 0.5), mover(1, 2, 3)});
  bodies.combine = PatchCombine::add;
  return prepared({patch("a", {spring(5, 0.01), grooves(schema::GrooveProfile::square, 1e-3, 1e-4, 1),
                               damper(2), noise(1e-3, 3, 0.5, 1, 1e-4, 1)}),
                   patch("b", {damper(1)}), bodies});
}

// Coefficients and sizes of a height map.
TEST(SceneBlock, AHarmfulHeightMapIsRefused) {
  const PreparedScene scene = prepared(
      {patch("a", {height_map("small", 6, 4, 1e-3, 1, [](double x, double y) { return 1e-4 * x * y; })})});
  const auto bytes = static_cast<std::uint32_t>(scene.bytes());
  const core::SceneView view = scene.view();
  const std::size_t table = static_cast<std::size_t>(view.tables - scene.words.data());
  const auto fault = [&](std::size_t word, std::uint32_t value) {
    auto words = scene.words;
    words[table + word] = value;
    words[3] = core::scene_check(words.data(), bytes);
    core::SceneView read;
    return core::read_scene_block(words.data(), bytes, read);
  };
  EXPECT_EQ(fault(1, 0), core::SceneFault::structure);  // levels
  EXPECT_EQ(fault(1, 0xFFFFFFFF), core::SceneFault::structure);
  EXPECT_EQ(fault(4 + 18, 7), core::SceneFault::structure);  // columns
  EXPECT_EQ(fault(4 + 18, 0x80000000), core::SceneFault::structure);
  EXPECT_EQ(fault(4 + 19, 0), core::SceneFault::structure);                     // rows
  EXPECT_EQ(fault(4 + 20, 1), core::SceneFault::structure);                     // first coefficient
  EXPECT_EQ(fault(4 + 16, 0x7F800000), core::SceneFault::value);                // samples per metre
  EXPECT_EQ(fault(2, 0x3F000000), core::SceneFault::value);                     // cosine
  EXPECT_EQ(fault(0, 0x7FC00000), core::SceneFault::value);                     // highest frequency
  EXPECT_EQ(fault(view.table_words - 1, 0x41300000), core::SceneFault::value);  // a coefficient of 11 m
  EXPECT_EQ(fault(view.table_words - 1, 0x3F800000), core::SceneFault::none);
}

TEST(SceneBlock, ACutOrChangedBlockIsRefused) {
  const PreparedScene scene = block_of_all();
  core::SceneView view;
  const auto bytes = static_cast<std::uint32_t>(scene.bytes());
  EXPECT_EQ(core::read_scene_block(scene.words.data(), bytes, view), core::SceneFault::none);
  EXPECT_EQ(view.patch_count, 3U);
  EXPECT_EQ(view.layer_count, 8U);
  for (std::uint32_t size = 0; size < bytes; ++size)
    EXPECT_NE(core::read_scene_block(scene.words.data(), size, view), core::SceneFault::none) << size;
  for (std::uint32_t bit = 0; bit < 8 * bytes; ++bit) {
    auto words = scene.words;
    words[bit / 32] ^= UINT32_C(1) << (bit % 32);
    EXPECT_NE(core::read_scene_block(words.data(), bytes, view), core::SceneFault::none) << bit;
  }
}

// With a right check: each 32-bit word replaced by values that harm. What is accepted gives finite forces
// within the limits.
TEST(SceneBlock, AHarmfulBlockIsRefusedOrLimited) {
  const PreparedScene scene = block_of_all();
  const auto bytes = static_cast<std::uint32_t>(scene.bytes());
  const core::ForceSetup setup = *force_setup_of(sandpaper(), 1000);
  std::size_t refused = 0, accepted = 0;
  for (std::size_t word = 0; word < scene.words.size(); ++word)
    for (const std::uint32_t value : {0x7FC00000U, 0x40U, 0x7F800000U, 0xFF7FFFFFU, 0x7F7FFFFFU, 0xFFFFFFFFU,
                                      0x00010001U, 0U, 1U, 0x00020000U, 0x3F800000U, 0x49742400U}) {
      auto words = scene.words;
      words[word] = value;
      words[3] = core::scene_check(words.data(), bytes);
      core::SceneView view;
      if (core::read_scene_block(words.data(), bytes, view) != core::SceneFault::none) {
        ++refused;
        continue;
      }
      ++accepted;
      core::SceneKernel kernel;
      std::vector<float> live(view.live_words());
      kernel.set(view, setup, live.data());
      for (const std::int32_t count : {0, INT32_MAX, INT32_MIN, 1000, -1000}) {
        const std::int32_t counts[2] = {count, -(count / 2)};
        const core::ForceOutput output = kernel.tick(counts, true);
        EXPECT_TRUE(output.sound);
        EXPECT_LE(std::hypot(output.force_n[0], output.force_n[1]), 20 * (1 + 0x1p-22));
      }
    }
  EXPECT_GT(refused, 100U);
  EXPECT_GT(accepted, 10U);
}

TEST(PreparedScene, ASceneOfATrayIsRefused) {
  const schema::Scene scene;
  EXPECT_EQ(prepare_scene(scene, "s", sandpaper(), 1000).error().kind, schema::ErrorKind::unsuitable);
}

TEST(SceneOnDevice, WhatTheDeviceCannotGiveIsSaid) {
  schema::Device device = sandpaper();
  const auto notes = [&](const Patch& of) {
    return limits_of_device(prepared({of}), device, *force_setup_of(device, 1000));
  };
  EXPECT_TRUE(notes(patch("a", {spring(100)})).empty());
  Patch half = patch("a", {damper(1)});
  half.x_m = 0.1;  // from 0 to 0.2 m; the travel ends at 0.1 m
  ASSERT_EQ(notes(half).size(), 1U);
  EXPECT_NE(notes(half)[0].find(" 49.5 %"), std::string::npos) << notes(half)[0];  // 50 of 101 columns
  half.x_m = 1;
  ASSERT_EQ(notes(half).size(), 1U);
  // |force| > 20 N outside a circle of 0.1 m: 1 - pi / 4 of the square, 21.46 %.
  const auto stiff = notes(patch("a", {spring(200)}));
  ASSERT_EQ(stiff.size(), 1U);
  EXPECT_NE(stiff[0].find(" 21.4 %"), std::string::npos) << stiff[0];
  device.axes.pop_back();
  EXPECT_EQ(notes(patch("a", {spring(100)})).size(), 1U);  // no axis y
  device.axes[0].name = "z";
  EXPECT_EQ(force_setup_of(device, std::nullopt).error().kind, schema::ErrorKind::unsuitable);
  EXPECT_EQ(force_setup_of(sandpaper(), 333.0).error().where, "--rate");
}

TEST(PlaneRender, ForcesAlongAPathOfOneAxis) {
  schema::Device device = unlimited();
  device.axes.pop_back();
  const PreparedScene scene = prepared({patch("a", {spring(100), damper(2)})});
  const FingerPath path{{0, 1}, {-0.05, 0.05}};  // 0.1 m/s: 10 counts per tick of 1 ms
  const auto run = render_plane(scene, device, 1000, {path});
  ASSERT_TRUE(run) << message(run.error());
  ASSERT_EQ(run->time_s.size(), 1001U);
  for (std::size_t i = 20; i < run->time_s.size(); ++i)
    EXPECT_NEAR(run->axes[0].force_n[i], -100 * (-0.05 + 1e-4 * static_cast<double>(i)) - 2 * 0.1, 1e-4) << i;
  EXPECT_LT(run->largest_rounding_n, 1e-5);
  const auto beyond = render_plane(scene, device, 1000, {FingerPath{{0, 1}, {0, 0.2}}});
  ASSERT_FALSE(beyond);
  EXPECT_EQ(beyond.error().where, "path");
}

}  // namespace
}  // namespace tacto::playback
