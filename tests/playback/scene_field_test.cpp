// SPDX-License-Identifier: GPL-3.0-or-later
// Fields of atoms: the kernel against closed forms and double precision, their stiffness, and what is
// refused.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <random>

#include "data-schema/files/files.hpp"
#include "firmware-host/core/scene/scene_kernel.hpp"
#include "playback/prepare/scene/field_section.hpp"
#include "playback/prepare/scene/field_stiffness.hpp"
#include "playback/prepare/scene/scene_device.hpp"
#include "playback/render/reference/exact_scene.hpp"
#include "tests/playback/unlimited_device.hpp"

namespace tacto::playback {
namespace {

using schema::Atom;

constexpr double kLengthScale = 1e7, kForceScale = 1e10, kSigma = 3e-10, kEpsilon = 1e-21;
constexpr double kForce_n = kForceScale * kEpsilon / kSigma;   // the unit of force on the hand
constexpr double kBenchSigma = kLengthScale * kSigma;          // 3 mm
constexpr double kStiffness_n_per_m = kForce_n / kBenchSigma;  // epsilon / sigma^2 on the bench
const double kZero = std::pow(2.0, 1.0 / 6);                   // of the force, in sigma
constexpr std::uint32_t kAtomsAt = sizeof(core::SceneHeader) / 4 + sizeof(core::ScenePatch) / 4 +
                                   sizeof(core::SceneLayer) / 4 + 2;  // words of a scene of one field

// Written to a file, which the layer names.
schema::FieldLayer field(const std::string& name, const std::vector<Atom>& atoms) {
  std::string text = "x_m,y_m,z_m,sigma_m,epsilon_j,charge_c\n";
  for (const Atom& a : atoms)
    text += fmt::format("{},{},{},{},{},{}\n", a.x_m, a.y_m, a.z_m, a.sigma_m, a.epsilon_j, a.charge_c);
  schema::FieldLayer layer;
  layer.file = testing::TempDir() + name + ".csv";
  layer.length_scale = {kLengthScale};
  layer.force_scale = {kForceScale};
  schema::PendingFiles files;
  EXPECT_TRUE(files.write(layer.file, text));
  EXPECT_TRUE(files.commit(schema::Existing::replace));
  return layer;
}

schema::Patch patch_of(const schema::FieldLayer& layer, double size_m = 0.03) {
  schema::Patch patch;
  patch.name = "docking";
  patch.width_m = patch.height_m = size_m;
  patch.layers = {layer};
  return patch;
}

schema::Result<PreparedScene> try_prepare(const schema::Patch& patch, const schema::Device& device) {
  schema::Scene scene;
  scene.patches = {patch};
  return prepare_scene(scene, "s.scene.json", device, 1000);
}

struct FieldOnDevice {
  schema::Device device;
  PreparedScene scene;
  core::SceneKernel kernel;
  std::vector<float> live;

  explicit FieldOnDevice(const schema::Patch& patch, double encoder_step_m = 1e-8)
      : device(unlimited_device(encoder_step_m)),
        scene(*try_prepare(patch, device)),
        live(scene.view().live_words()) {
    kernel.set(scene.view(), *force_setup_of(device, 1000), live.data());
  }
  core::ForceOutput at(double x_m, double y_m) {
    const double step_m = device.axes[0].encoder_step_m;
    const std::int32_t counts[2] = {static_cast<std::int32_t>(std::lround(x_m / step_m)),
                                    static_cast<std::int32_t>(std::lround(y_m / step_m))};
    return kernel.tick(counts, true);
  }
};

const Atom kOne{0, 0, 0, kSigma, kEpsilon, 0};

// 24 epsilon / r (2 (sigma / r)^12 - (sigma / r)^6): 24 epsilon / sigma at sigma, the largest; zero at
// 2^(1/6) sigma; the largest attraction of 2.3964 epsilon / sigma at (26 / 7)^(1/6) sigma.
TEST(SceneField, OneAtomIsLennardJonesAndZeroWhereItsPotentialIsLeast) {
  FieldOnDevice on(patch_of(field("one", {kOne})));
  const auto force = [&](double in_sigma) { return double{on.at(in_sigma * kBenchSigma, 0).force_n[0]}; };
  constexpr double kRounding = 40 * 0x1p-24;  // s^7 has 35 of them
  EXPECT_NEAR(force(1) / kForce_n, 24, 24 * kRounding);
  EXPECT_NEAR(force(std::pow(26.0 / 7, 1.0 / 6)) / kForce_n, -2.3964, 1e-4);
  // Of the largest: rounding, and half a count of 10 nm at 57.146 epsilon / sigma^2.
  EXPECT_NEAR(force(kZero) / kForce_n, 0, 1e-6 * 24 + 57.2 * 0.5e-8 / kBenchSigma);
  EXPECT_NEAR(force(0.5) / kForce_n, 12, 12 * kRounding) << "in its core it falls linearly";
  EXPECT_EQ(force(0), 0);
}

// At its zero on a count: 1e-6 of the largest force.
TEST(SceneField, ItsZeroIsExactToAMillionthOfItsLargestForce) {
  const double step_m = kZero * kBenchSigma / 100000;
  FieldOnDevice on(patch_of(field("zero", {kOne})), step_m);
  const double largest = double{on.at(kBenchSigma, 0).force_n[0]};
  EXPECT_LT(std::abs(double{on.at(100000 * step_m, 0).force_n[0]}), 1e-6 * largest);
  const double slope =
      (double{on.at(99900 * step_m, 0).force_n[0]} - on.at(100100 * step_m, 0).force_n[0]) / (200 * step_m);
  // Central differences over 0.1 %: 6e-5 of it by the third derivative; rounding 1e-4.
  EXPECT_NEAR(slope / kStiffness_n_per_m, 57.146, 0.02);
}

// 26 core^-14 - 7 core^-8, times 24 epsilon / sigma^2: 57.146 with a core that ends where the force is zero.
TEST(SceneField, ItsLargestStiffnessIsThatOfTheBorderOfTheCore) {
  schema::FieldLayer layer = field("stiff", {kOne});
  const auto stiffness = [&](double core) {
    layer.core = {core};
    const auto scene = try_prepare(patch_of(layer), unlimited_device(1e-5));
    return local_stiffness_n_per_m(scene->patches[0].layers[0]) / kStiffness_n_per_m;
  };
  EXPECT_NEAR(stiffness(1), 456, 456e-6);
  EXPECT_NEAR(stiffness(kZero), 57.146, 1e-3);
  layer.force_scale = {kForceScale, schema::SliderRange{0, 2 * kForceScale}};  // the upper end counts
  EXPECT_NEAR(stiffness(1), 2 * 456, 1e-3);
}

// The largest eigenvalue, absolute, of -dF/dplace at a place, by central differences of the force in double
// precision, outside of the borders of the cores.
double numerical_stiffness(const FieldSection& section, double x_m, double y_m, double z_m) {
  constexpr double kStep_m = 1e-8;
  const auto force = [&](double x, double y) {
    double along_x = 0, along_y = 0;
    for (const SectionAtom& atom : section.atoms) {
      const double dx = x - atom.x_m, dy = y - atom.y_m, dz = z_m - atom.z_m,
                   r = std::max(std::sqrt(dx * dx + dy * dy + dz * dz) / atom.sigma_m, section.core);
      const double g = atom.lennard_jones_n_per_m * (2 * std::pow(r, -14) - std::pow(r, -8)) +
                       atom.coulomb_n_per_m * std::pow(r, -3);
      along_x += g * dx, along_y += g * dy;
    }
    return std::pair(along_x, along_y);
  };
  const auto right = force(x_m + kStep_m, y_m), left = force(x_m - kStep_m, y_m),
             up = force(x_m, y_m + kStep_m), down = force(x_m, y_m - kStep_m);
  const double xx = (right.first - left.first) / (2 * kStep_m),
               yy = (up.second - down.second) / (2 * kStep_m),
               xy = (right.second - left.second + up.first - down.first) / (4 * kStep_m);
  return std::abs(xx + yy) / 2 + std::hypot((xx - yy) / 2, xy);
}

// The largest of random places in the section, half of them at the border of a core.
double sampled_stiffness(const FieldSection& section, const schema::LayerNumber& z_m, double half_m,
                         std::mt19937_64& random) {
  std::uniform_real_distribution<double> part(-1, 1);
  const double middle_m = (least_value(z_m) + largest_value(z_m)) / 2,
               range_m = largest_value(z_m) - middle_m;
  double most = 0;
  for (int i = 0; i < 20000; ++i) {
    double x_m = half_m * part(random), y_m = half_m * part(random),
           at_z_m = middle_m + range_m * part(random);
    if (i % 2 == 0) {
      const SectionAtom& atom = section.atoms[static_cast<std::size_t>(i / 2) % section.atoms.size()];
      at_z_m = std::clamp(atom.z_m, least_value(z_m), largest_value(z_m));
      const double core_m = section.core * atom.sigma_m, dz = at_z_m - atom.z_m,
                   in_plane_m = std::sqrt(std::max(core_m * core_m - dz * dz, 0.0)) + 2e-8,
                   angle = std::numbers::pi * part(random);
      x_m = atom.x_m + in_plane_m * std::cos(angle), y_m = atom.y_m + in_plane_m * std::sin(angle);
    }
    if (std::abs(x_m) > half_m || std::abs(y_m) > half_m) continue;
    most = std::max(most, numerical_stiffness(section, x_m, y_m, at_z_m));
  }
  return most;
}

TEST(SceneField, ItsStiffnessIsABoundOfAllPlacesAndSections) {
  std::mt19937_64 random(31);
  std::uniform_real_distribution<double> part(-1, 1);
  double loosest = 0;
  for (int run = 0; run < 24; ++run) {
    const double core = std::array{0.9, 1.0, 1.12}[static_cast<std::size_t>(run) % 3];
    const int count = 1 + run * 29 / 23;
    FieldSection section{{}, core, 0};
    for (int i = 0; i < count; ++i)
      section.atoms.push_back({0.012 * part(random), 0.012 * part(random), 0.005 * part(random),
                               0.003 * (1 + 0.3 * part(random)), 1 + 0.5 * part(random),
                               run % 4 == 3 ? part(random) : 0});
    schema::LayerNumber z_m{0.001};
    if (run % 2 == 1) z_m.slider = schema::SliderRange{-0.004, 0.004};
    schema::Patch patch;
    patch.width_m = patch.height_m = 0.03;
    const double bound = stiffest_n_per_m(section, z_m, patch),
                 sampled = sampled_stiffness(section, z_m, 0.015, random);
    // Central differences over 2e-8 m of lengths of 2 mm: 1e-8 of it by the third derivative, and rounding.
    EXPECT_GE(bound, sampled * (1 - 1e-6)) << run;
    loosest = std::max(loosest, bound / sampled);
  }
  EXPECT_LT(loosest, 2) << "of the places that were sampled";
}

// Its stiffest ring is at the place where d^2 has the part z^2, between places of a grid: 28277 N/m by
// NumPy on a grid of 10 um.
TEST(SceneField, ARingAroundAnAtomIsNotMissed) {
  schema::FieldLayer layer = field("ring", {kOne, {1e-9, 0.5e-9, -2e-10, 3.2e-10, 5e-22, 0}});
  layer.length_scale = {2e6};
  layer.force_scale = {1.6e12};
  layer.z_m = {0.000672};
  layer.core = {0.9};
  const auto scene = try_prepare(patch_of(layer), unlimited_device(1e-5));
  ASSERT_TRUE(scene);
  const double stiffness = local_stiffness_n_per_m(scene->patches[0].layers[0]);
  EXPECT_GE(stiffness, 28277);
  EXPECT_LE(stiffness, 1.03 * 28277);
}

// Two charges of one elementary charge 1 nm apart: 230.7078 pN.
TEST(SceneField, ChargesRepelByCoulomb) {
  schema::FieldLayer layer = field("charge", {{0, 0, 0, kSigma, 0, 1.602176634e-19}});
  layer.probe_charge_c = {1.602176634e-19};
  FieldOnDevice on(patch_of(layer));
  EXPECT_NEAR(on.at(0, 0.01).force_n[1], kForceScale * 230.7078e-12, 2e-6 * kForceScale * 230.7078e-12);
  layer.probe_charge_c = {-1.602176634e-19};
  FieldOnDevice opposite(patch_of(layer));
  EXPECT_NEAR(opposite.at(0.01, 0).force_n[0], -kForceScale * 230.7078e-12, 1e-5);
}

std::vector<Atom> many_atoms(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> part(-1, 1);
  std::vector<Atom> atoms;
  for (std::size_t i = 0; i < count; ++i)
    atoms.push_back({2e-9 * part(random), 2e-9 * part(random), 1e-9 * part(random),
                     kSigma * (1 + 0.2 * part(random)), kEpsilon * (1 + 0.5 * part(random)),
                     1e-20 * part(random)});
  return atoms;
}

// On a turned patch far from the origin, with its section in motion.
TEST(SceneField, SinglePrecisionIsTheReference) {
  const std::vector<Atom> atoms = many_atoms(300, 9);
  schema::FieldLayer layer = field("many", atoms);
  layer.probe_charge_c = {1.6e-19};
  schema::Patch patch = patch_of(layer, 0.04);
  patch.x_m = 0.05, patch.y_m = -0.03, patch.angle_deg = 33;
  std::mt19937_64 random(10);
  std::uniform_real_distribution<double> part(-1, 1);
  for (const double z_m : {0.0, 0.004}) {
    layer.z_m = {z_m};
    patch.layers = {layer};
    FieldOnDevice on(patch);
    ExactScene exact(on.scene, on.device, 1000);
    const FieldSection section = field_section(layer, atoms, patch);
    double worst = 0, largest = 0;
    for (int i = 0; i < 2000; ++i) {
      const double x_m = 0.05 + 0.014 * part(random), y_m = -0.03 + 0.014 * part(random);
      const std::vector<std::int32_t> counts = {static_cast<std::int32_t>(std::lround(x_m / 1e-8)),
                                                static_cast<std::int32_t>(std::lround(y_m / 1e-8))};
      const core::ForceOutput output = on.kernel.tick(counts.data(), true);
      const ExactScene::Output reference = exact.tick(counts);
      for (std::size_t axis = 0; axis < 2; ++axis) {
        worst = std::max(worst, std::abs(output.unlimited_n[axis] - reference.unlimited_n[axis]));
        largest = std::max(largest, std::abs(reference.unlimited_n[axis]));
      }
    }
    std::printf("  field of 300 atoms: within %.2g N of %.3g N; bound %.2g N\n", worst, largest,
                kForceScale * field_rounding_n(section, patch, z_m, z_m));
    EXPECT_LT(worst, 3e-6 * largest);  // single precision: 35 roundings of s^7, most of them cancel
    EXPECT_LT(worst, kForceScale * field_rounding_n(section, patch, z_m, z_m));
  }
}

// The force is the gradient of a potential: no work along a closed path, also through cores.
TEST(SceneField, AClosedPathGivesNoWork) {
  FieldOnDevice on(patch_of(field("path", many_atoms(40, 3)), 0.06));
  constexpr int kPlaces = 20000;
  const auto place = [](int i) {
    const double angle = 2 * std::numbers::pi * i / kPlaces;
    return std::pair(0.012 * std::cos(angle), 0.010 * std::sin(angle));
  };
  double work = 0, sum = 0;
  for (int i = 0; i < kPlaces; ++i) {
    const auto [x0, y0] = place(i);
    const auto [x1, y1] = place(i + 1);
    const core::ForceOutput output = on.at((x0 + x1) / 2, (y0 + y1) / 2);
    const double part = double{output.force_n[0]} * (x1 - x0) + double{output.force_n[1]} * (y1 - y0);
    work += part, sum += std::abs(part);
  }
  EXPECT_LT(std::abs(work), 1e-5 * sum);  // the midpoint rule, and counts of 10 nm
}

TEST(SceneField, ItsScaleAndSectionChangeInATickAndItNeedsNoSpeed) {
  const schema::FieldLayer layer = field("live", {kOne});
  EXPECT_EQ(numbers_in_block(layer), (std::vector<std::string_view>{"force_scale", "z_m"}));
  FieldOnDevice on(patch_of(layer));
  EXPECT_FALSE(on.scene.view().needs_speed);
  const double before = double{on.at(kBenchSigma, 0).force_n[0]};
  on.kernel.change(0, core::kFieldScale, static_cast<float>(2 * kForceScale), 1);
  EXPECT_NEAR(on.at(kBenchSigma, 0).force_n[0], 2 * before, 1e-6 * before);
  on.kernel.change(0, core::kFieldZ, static_cast<float>(kBenchSigma), 1);  // now sqrt(2) sigma away
  const double ratio = std::pow(0.5, 3);
  EXPECT_NEAR(on.at(kBenchSigma, 0).force_n[0] / kForce_n, 2 * 24 / 2.0 * (2 * ratio * ratio - ratio), 1e-4);
  EXPECT_FALSE(core::number_fits(on.scene.view(), 0, core::kFieldScale, -1));
  EXPECT_FALSE(core::number_fits(on.scene.view(), 0, core::kFieldZ, 11));
  EXPECT_FALSE(core::number_fits(on.scene.view(), 0, 2, 0));
}

TEST(SceneField, AHarmfulTableIsRefused) {
  const auto prepared = try_prepare(patch_of(field("harm", {kOne, kOne})), unlimited_device(1e-5));
  ASSERT_TRUE(prepared);
  const auto fault = [&](std::uint32_t word, std::uint32_t value) {
    auto words = prepared->words;
    words[kAtomsAt + word] = value;
    const auto bytes = static_cast<std::uint32_t>(words.size() * 4);
    words[3] = core::scene_check(words.data(), bytes);
    core::SceneView view;
    return core::read_scene_block(words.data(), bytes, view);
  };
  constexpr std::uint32_t kUnits = 16, kCore = 17, kCount = 18, kZ = 21, kSigmaWord = 22, kForceWord = 23;
  constexpr std::uint32_t kNan = 0x7FC00000, kZeroWord = 0, kMinus = 0xBF800000, kLarge = 0x7F000000;
  using core::SceneFault;
  EXPECT_EQ(fault(kCount, 2), SceneFault::none);
  for (const std::uint32_t count : {0U, 1U, 3U, 4097U, UINT32_MAX})
    EXPECT_EQ(fault(kCount, count), SceneFault::structure) << count;
  for (const std::uint32_t word : {kUnits, kCore, kZ, kSigmaWord, kForceWord})
    for (const std::uint32_t value : {kNan, kLarge}) EXPECT_EQ(fault(word, value), SceneFault::value) << word;
  EXPECT_EQ(fault(kCore, kZeroWord), SceneFault::value);
  EXPECT_EQ(fault(kSigmaWord, kZeroWord), SceneFault::value);
  EXPECT_EQ(fault(kForceWord, kMinus), SceneFault::value);
}

TEST(SceneField, AtomsThatDoNotFitThePatchAreRefused) {
  schema::FieldLayer layer = field("small", {kOne});
  layer.length_scale = {1e3};  // 0.3 um on a patch of 30 mm
  const auto small = try_prepare(patch_of(layer), unlimited_device(1e-5));
  ASSERT_FALSE(small);
  EXPECT_EQ(small.error().kind, schema::ErrorKind::unsuitable);
  EXPECT_EQ(small.error().where, layer.file);
  layer = field("high", {{0, 0, 1e-6, kSigma, kEpsilon, 0}});
  const auto high = try_prepare(patch_of(layer), unlimited_device(1e-5));
  ASSERT_FALSE(high);
  EXPECT_EQ(high.error().kind, schema::ErrorKind::unsuitable);
  layer.file = testing::TempDir() + "no-atoms.csv";
  EXPECT_EQ(try_prepare(patch_of(layer), unlimited_device(1e-5)).error().kind, schema::ErrorKind::not_found);
}

}  // namespace
}  // namespace tacto::playback
