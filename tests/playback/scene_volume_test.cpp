// SPDX-License-Identifier: GPL-3.0-or-later
// Volumes in the kernel: closed paths, against the double-precision interpolant, blocks that are refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <random>
#include <vector>

#include "firmware-host/core/firmware/firmware.hpp"
#include "firmware-host/core/scene/scene_kernel.hpp"
#include "firmware-host/core/scene/volume.hpp"
#include "playback/prepare/scene/volume_block.hpp"

namespace tacto::playback {
namespace {

using Place3 = std::array<double, 3>;

schema::Volume random_volume(int from, int to) {
  schema::Volume volume;
  volume.samples = {13, 11, 9};
  volume.spacing_m = {4e-4, 5e-4, 6e-4};
  std::mt19937 random(10);
  std::uniform_int_distribution<int> value(from, to);
  volume.stored.resize(13 * 11 * 9);
  for (std::int16_t& each : volume.stored) each = static_cast<std::int16_t>(value(random));
  return volume;
}

schema::Piece piece_of_volume() {
  schema::Piece piece;
  piece.shape = schema::PieceShape::volume;
  piece.stiffness_n_per_m = 500;
  piece.value_per_m = 1e6;
  return piece;
}

// The middle at count 0.
std::vector<std::uint32_t> table_words(const schema::Volume& volume, const schema::Piece& piece) {
  return volume_table(piece, volume, core::PieceTable{}, {1e-5, 1e-5, 1, 1e-5});
}

// A scene of this table alone.
std::vector<std::uint32_t> block_around(const std::vector<std::uint32_t>& table, float stiffness) {
  core::SceneHeader header;
  header.patches = header.layers = 1;
  header.numbers = core::kPieceNumbers + core::kWallStateWords;
  header.table_words = static_cast<std::uint32_t>(table.size());
  core::ScenePatch space;
  space.layers = 1;
  const core::SceneLayer layer{static_cast<std::uint16_t>(core::SceneLayerKind::volume), 0, 0};
  const float numbers[core::kPieceNumbers + core::kWallStateWords] = {stiffness};
  std::vector<std::uint32_t> words;
  const auto append = [&](const void* part, std::size_t bytes) {
    const std::size_t before = words.size();
    words.resize(before + bytes / sizeof(std::uint32_t));
    std::memcpy(words.data() + before, part, bytes);
  };
  append(&header, sizeof header);
  append(&space, sizeof space);
  append(&layer, sizeof layer);
  append(numbers, sizeof numbers);
  append(table.data(), table.size() * sizeof(std::uint32_t));
  header.check = core::scene_check(words.data(), static_cast<std::uint32_t>(words.size() * 4));
  std::memcpy(words.data(), &header, sizeof header);
  return words;
}

core::SceneFault fault_of(const std::vector<std::uint32_t>& block, core::SceneView& view) {
  return core::read_scene_block(block.data(), static_cast<std::uint32_t>(block.size() * 4), view);
}

core::VolumePlace place_at(const Place3& samples) {
  core::VolumePlace place;
  for (std::size_t i = 0; i < 3; ++i)
    place.along[i] = static_cast<std::int64_t>(std::round(samples[i] * 0x1p32));
  return place;
}

// Of a straight way in a cell the work's integrand is a polynomial of degree 5: three points of Gauss are
// exact.
struct Work {
  double net = 0, absolute = 0;

  void add(const core::VolumeTable& table, const schema::Volume& volume, const Place3& from,
           const Place3& to) {
    constexpr double kGauss[] = {-0.7745966692414834, 0, 0.7745966692414834},
                     kWeight[] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
    double work = 0;
    for (int k = 0; k < 3; ++k) {
      Place3 at;
      for (std::size_t i = 0; i < 3; ++i) at[i] = from[i] + (to[i] - from[i]) * (1 + kGauss[k]) / 2;
      const core::VolumeDepth depth = core::depth_at(table, core::values_of(table), place_at(at));
      EXPECT_GT(depth.depth_m, 0);
      const float out[] = {depth.outwards.x, depth.outwards.y, depth.outwards.z};
      for (std::size_t i = 0; i < 3; ++i)
        work += kWeight[k] * double{depth.depth_m} * double{out[i]} * (to[i] - from[i]) * volume.spacing_m[i];
    }
    net += work, absolute += std::abs(work);
  }
};

TEST(SceneVolume, AClosedPathFromFaceToFaceGainsNothing) {
  const schema::Volume volume = random_volume(100, 3000);
  const std::vector<std::uint32_t> words = table_words(volume, piece_of_volume());
  const auto& table = *reinterpret_cast<const core::VolumeTable*>(words.data());
  std::mt19937 random(3);
  std::uniform_real_distribution<double> part(0.01, 0.99);
  std::vector<Place3> corners(200);
  for (Place3& corner : corners)
    for (std::size_t i = 0; i < 3; ++i) corner[i] = part(random) * static_cast<double>(volume.samples[i] - 1);
  Work work;
  for (std::size_t n = 0; n < corners.size(); ++n) {
    const Place3 &from = corners[n], &to = corners[(n + 1) % corners.size()];
    std::vector<double> faces = {0, 1};
    for (std::size_t i = 0; i < 3; ++i)
      for (double face = std::ceil(std::min(from[i], to[i])); face < std::max(from[i], to[i]); ++face)
        faces.push_back((face - from[i]) / (to[i] - from[i]));
    std::ranges::sort(faces);
    for (std::size_t k = 1; k < faces.size(); ++k) {
      Place3 a, b;
      for (std::size_t i = 0; i < 3; ++i)
        a[i] = from[i] + faces[k - 1] * (to[i] - from[i]), b[i] = from[i] + faces[k] * (to[i] - from[i]);
      work.add(table, volume, a, b);
    }
  }
  EXPECT_GT(work.absolute, 1e-6);
  EXPECT_LT(std::abs(work.net), 1e-6 * work.absolute) << work.net / work.absolute;
}

// The kernel's error: values of 16 bits are exact, a part of a cell has 24 bits, and about 20 operations
// round.
TEST(SceneVolume, ItsDepthAndGradientAreThoseOfTheWeightsInDouble) {
  const schema::Volume volume = random_volume(-3000, 3000);
  schema::Piece piece = piece_of_volume();
  piece.iso = 123;
  const std::vector<std::uint32_t> words = table_words(volume, piece);
  const auto& table = *reinterpret_cast<const core::VolumeTable*>(words.data());
  const double steepest = steepest_per_m(volume, -1e9);
  std::mt19937 random(4);
  double largest = 0;
  for (int n = 0; n < 20000; ++n) {
    Place3 at, place_m;
    for (std::size_t i = 0; i < 3; ++i) {
      at[i] = std::uniform_real_distribution<double>(0, static_cast<double>(volume.samples[i] - 1))(random);
      place_m[i] = at[i] * volume.spacing_m[i] - volume.half_size_m()[i];
    }
    schema::VolumeValue exact;
    ASSERT_TRUE(value_at(volume, place_m, exact));
    const core::VolumeDepth depth = core::depth_at(table, core::values_of(table), place_at(at));
    EXPECT_NEAR(double{depth.depth_m}, (exact.value - piece.iso) / piece.value_per_m, 3e-6 * 6e-3);
    const float out[] = {depth.outwards.x, depth.outwards.y, depth.outwards.z};
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(double{out[i]}, -exact.slope_per_m[i] / piece.value_per_m,
                  3e-6 * steepest / piece.value_per_m);
    largest = std::max(largest, std::hypot(exact.slope_per_m[0], exact.slope_per_m[1], exact.slope_per_m[2]));
  }
  EXPECT_LE(largest, steepest);
  EXPECT_GT(largest, 0.5 * steepest);
}

// By it a wall is let go, and its next contact has its transient again.
TEST(SceneVolume, OutsideItStatesHowFar) {
  const schema::Volume volume = random_volume(-3000, 3000);
  std::vector<std::uint32_t> words = table_words(volume, piece_of_volume());
  auto& table = *reinterpret_cast<core::VolumeTable*>(words.data());
  std::mt19937 random(5);
  std::uniform_int_distribution<std::int32_t> count(-180, 180);
  int outside = 0, inside = 0;
  for (int n = 0; n < 2000; ++n) {
    const std::int32_t counts[] = {count(random), count(random), count(random)};
    const core::VolumeDepth depth =
        core::depth_at(table, core::values_of(table), core::place_in(table, counts));
    const core::VolumeTouch touch = core::touch_volume(table, counts, 500);
    EXPECT_EQ(touch.outside_m, depth.depth_m > 0 ? 0 : -depth.depth_m);
    depth.depth_m > 0 ? ++inside : ++outside;
  }
  EXPECT_GT(inside, 500);
  EXPECT_GT(outside, 500);
}

TEST(SceneVolume, BeyondTheOutermostValuesThereIsNoForce) {
  const schema::Volume volume = random_volume(1000, 1000);
  const std::vector<std::uint32_t> words = table_words(volume, piece_of_volume());
  const auto& table = *reinterpret_cast<const core::VolumeTable*>(words.data());
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const double end : {-0.001, static_cast<double>(volume.samples[axis]) - 0.999}) {
      Place3 at = {5, 5, 5};
      EXPECT_GT(core::depth_at(table, core::values_of(table), place_at(at)).depth_m, 0);
      at[axis] = end;
      EXPECT_LT(core::depth_at(table, core::values_of(table), place_at(at)).depth_m, 0);
    }
}

TEST(SceneVolume, ABlockThatWouldReadBeyondItsEndIsRefused) {
  const schema::Volume volume = random_volume(0, 100);
  const std::vector<std::uint32_t> words = table_words(volume, piece_of_volume());
  core::SceneView view;
  EXPECT_EQ(fault_of(block_around(words, 500), view), core::SceneFault::none);
  const auto changed = [&](auto change) {
    std::vector<std::uint32_t> other = words;
    change(*reinterpret_cast<core::VolumeTable*>(other.data()));
    return fault_of(block_around(other, 500), view);
  };
  EXPECT_EQ(changed([](core::VolumeTable& t) { ++t.along[2].samples; }), core::SceneFault::structure);
  EXPECT_EQ(changed([](core::VolumeTable& t) { --t.along[0].samples; }), core::SceneFault::structure);
  EXPECT_EQ(changed([](core::VolumeTable& t) { t.along[1].samples = 0xFFFFFFFF; }), core::SceneFault::value);
  EXPECT_EQ(changed([](core::VolumeTable& t) { t.along[1].samples = 1; }), core::SceneFault::value);
  EXPECT_EQ(changed([](core::VolumeTable& t) { t.along[1].per_m = NAN; }), core::SceneFault::value);
  EXPECT_EQ(changed([](core::VolumeTable& t) { t.m_per_value = 1; }), core::SceneFault::value);
  EXPECT_EQ(changed([](core::VolumeTable& t) { t.iso = INFINITY; }), core::SceneFault::value);
  EXPECT_EQ(changed([](core::VolumeTable& t) { t.piece.travel = 4; }), core::SceneFault::structure);
  EXPECT_EQ(changed([](core::VolumeTable& t) { t.piece.slide = 4; }), core::SceneFault::structure);
  EXPECT_EQ(changed([](core::VolumeTable& t) { t.carve_rest = 1; }), core::SceneFault::value);
}

// Of values that grow linearly along z the force is that of a spring of the stiffness.
TEST(SceneVolume, OnASlopeOfValuePerMetreItIsAWall) {
  schema::Volume volume = random_volume(0, 0);
  for (std::size_t z = 0; z < volume.samples[2]; ++z)
    for (std::size_t y = 0; y < volume.samples[1]; ++y)
      for (std::size_t x = 0; x < volume.samples[0]; ++x)
        volume.stored[volume.at(x, y, z)] = static_cast<std::int16_t>(600 * (4 - static_cast<int>(z)));
  const std::vector<std::uint32_t> block = block_around(table_words(volume, piece_of_volume()), 500);
  core::SceneView view;
  ASSERT_EQ(fault_of(block, view), core::SceneFault::none);
  core::ForceSetup setup;
  for (int i = 0; i < 3; ++i) setup.axes[i] = {static_cast<core::AxisAlong>(i), 1e-5F, 1e9F, 1e9F};
  setup.axis_count = 3, setup.peak_n = setup.continuous_n = 1e9F, setup.slew_n_per_s = 1e12F,
  setup.rate_hz = 1000;
  std::vector<float> live(view.live_words());
  core::SceneKernel kernel;
  kernel.set(view, setup, live.data());
  for (std::int32_t depth = -100; depth <= 200; depth += 10) {
    const std::int32_t counts[] = {17, -9, -depth};
    const core::ForceOutput output = kernel.tick(counts, true);
    EXPECT_NEAR(double{output.force_n[2]}, 500 * 1e-5 * std::max(0, depth), 1e-5);
    EXPECT_EQ(output.force_n[0], 0);
  }
}

// A piece that carves, and its block on a device without limits.
struct CarvedScene {
  std::vector<std::uint32_t> block;
  core::SceneView view;
  core::SceneKernel kernel;
  core::ForceSetup setup;
  std::vector<float> live;

  CarvedScene(const schema::Volume& volume, double force_n, double value_per_s) {
    schema::Piece piece = piece_of_volume();
    piece.iso = 0.5;
    piece.carve = {force_n, value_per_s};
    std::vector<std::uint32_t> table = table_words(volume, piece);
    EXPECT_TRUE(set_carving(piece, volume, 1000, "s", table));
    block = block_around(table, 500);
    EXPECT_EQ(fault_of(block, view), core::SceneFault::none);
    EXPECT_TRUE(view.tables_change);
    for (int i = 0; i < 3; ++i) setup.axes[i] = {static_cast<core::AxisAlong>(i), 1e-5F, 1e9F, 1e9F};
    setup.axis_count = 3, setup.peak_n = setup.continuous_n = 1e9F, setup.slew_n_per_s = 1e12F;
    setup.rate_hz = 1000;
    live.resize(view.live_words());
    kernel.set(view, setup, live.data());
  }
  std::vector<std::int16_t> values(const schema::Volume& volume) const {
    const core::SceneView now = kernel.scene_now();
    const std::int16_t* const first = values_of(core::table_of<core::VolumeTable>(now, now.layers[0]));
    return {first, first + volume.stored.size()};
  }
};

schema::Volume slope_along_z() {
  schema::Volume volume = random_volume(0, 0);
  for (std::size_t z = 0; z < volume.samples[2]; ++z)
    for (std::size_t i = 0; i < 13 * 11; ++i)
      volume.stored[z * 13 * 11 + i] = static_cast<std::int16_t>(600 * (4 - static_cast<int>(z)));
  return volume;
}

TEST(SceneVolume, TicksInACellRemoveEightTimesTheirFall) {
  const schema::Volume volume = slope_along_z();
  CarvedScene scene(volume, 0.05, 2500);  // 2.5 steps a tick: 2 and 3 by turns
  const std::int32_t deep[] = {3, 3, -100};
  constexpr int kTicks = 40;
  for (int i = 0; i < kTicks; ++i) scene.kernel.tick(deep, true);
  std::vector<std::int16_t> left = scene.values(volume);
  long removed = 0;
  std::size_t changed = 0;
  for (std::size_t i = 0; i < left.size(); ++i)
    removed += volume.stored[i] - left[i], changed += volume.stored[i] != left[i];
  EXPECT_EQ(removed, 8 * kTicks * 5 / 2);
  EXPECT_EQ(changed, 8);
  // Shallow, the force is below the threshold.
  const std::int32_t shallow[] = {160, 3, -9};
  for (int i = 0; i < kTicks; ++i) scene.kernel.tick(shallow, true);
  EXPECT_EQ(scene.values(volume), left);
  // Until the force has fallen to the threshold, and never below the smallest value.
  double last_n = 1e9;
  for (int i = 0; i < 2000; ++i) last_n = double{scene.kernel.tick(deep, true).force_n[2]};
  EXPECT_LT(last_n, 0.06);
  left = scene.values(volume);
  EXPECT_GE(*std::ranges::min_element(left), *std::ranges::min_element(volume.stored));
  // The same ticks on a kernel that was set again: the same bits.
  scene.kernel.set(scene.view, scene.setup, scene.live.data());
  EXPECT_EQ(scene.values(volume), volume.stored);
}

TEST(SceneVolume, CarvingAtAnyRateNeverGivesEnergy) {
  const schema::Volume volume = slope_along_z();
  std::mt19937 random(8);
  for (const double value_per_s : {30.0, 4e4, 3e6}) {
    CarvedScene scene(volume, 0.1, value_per_s);
    double work = 0, last_m[2] = {0, 0.0008};
    float last_n[2] = {};
    for (int i = 0; i < 20000; ++i) {
      const double z_m = 0.0008 * std::cos(0.01 * i) + 1e-5 * static_cast<double>(random() % 5);
      const std::int32_t counts[] = {static_cast<std::int32_t>(150 * std::sin(0.003 * i)), 7,
                                     static_cast<std::int32_t>(std::lround(z_m / 1e-5))};
      const core::ForceOutput output = scene.kernel.tick(counts, true);
      for (const int axis : {0, 2}) {
        const int k = axis / 2;
        work += (counts[axis] * 1e-5 - last_m[k]) * 0.5 * (double{output.force_n[axis]} + double{last_n[k]});
        last_m[k] = counts[axis] * 1e-5, last_n[k] = output.force_n[axis];
      }
    }
    EXPECT_LE(work, 1e-6) << value_per_s;
  }
}

TEST(SceneVolume, ADeviceNeedsRoomForTheValuesTwice) {
  schema::Volume volume = random_volume(0, 0);
  volume.samples = {32, 16, 16};
  volume.stored.assign(32 * 16 * 16, 1);
  const CarvedScene scene(volume, 0.05, 2500);
  std::vector<float> memory(10000);
  const auto answer_in = [&](std::size_t words) {
    core::SceneUpload upload(memory.data(), static_cast<std::uint32_t>(words));
    wire::ScenePart part{};
    part.bytes = static_cast<std::uint32_t>(scene.block.size() * 4);
    core::Reply reply{};
    for (; part.first < part.bytes; part.first += part.count) {
      part.count =
          static_cast<std::uint16_t>(std::min<std::size_t>(wire::kMaxScenePart, part.bytes - part.first));
      std::memcpy(part.data, reinterpret_cast<const std::uint8_t*>(scene.block.data()) + part.first,
                  part.count);
      reply = upload.part(part);
      if (reply.code != wire::AnswerCode::ok) break;
    }
    return reply.code;
  };
  const std::size_t needed = scene.block.size() + scene.view.live_words();
  EXPECT_EQ(answer_in(needed), wire::AnswerCode::ok);
  EXPECT_EQ(answer_in(needed - 1), wire::AnswerCode::too_large);
}

TEST(SceneVolume, TheForceOfAToolIsTheSumOverItsPoints) {
  const schema::Volume volume = random_volume(-3000, 3000);
  const schema::Piece piece = piece_of_volume();
  std::mt19937 random(5);
  std::uniform_real_distribution<double> at_m(-1e-3, 1e-3);
  std::vector<std::array<double, 3>> tool_m(300);
  for (auto& point_m : tool_m)
    for (double& each : point_m) each = at_m(random);
  tool_m[0] = {0, 0, 0};
  auto words = volume_table(piece, volume, core::PieceTable{}, {1e-5, 1e-5, 1, 1e-5}, tool_m);
  auto& table = *reinterpret_cast<core::VolumeTable*>(words.data());
  for (int n = 0; n < 50; ++n) {
    std::int32_t counts[3];
    for (std::int32_t& count : counts) count = static_cast<std::int32_t>(1e5 * at_m(random));
    const core::SpaceVector push = core::touch_volume(table, counts, 500).push_m;
    Place3 sum = {};
    double absolute = 0;
    for (const auto& point_m : tool_m) {
      schema::VolumeValue value;
      if (!value_at(
              volume,
              {counts[0] * 1e-5 + point_m[0], counts[1] * 1e-5 + point_m[1], counts[2] * 1e-5 + point_m[2]},
              value))
        continue;
      const double depth_m = std::max(0.0, value.value / 1e6);
      for (std::size_t i = 0; i < 3; ++i) {
        sum[i] -= depth_m * value.slope_per_m[i] / 1e6;
        absolute += std::abs(depth_m * value.slope_per_m[i] / 1e6);
      }
    }
    EXPECT_GT(absolute, 0);
    for (const auto& [kernel, exact] : {std::pair{push.x, sum[0]}, {push.y, sum[1]}, {push.z, sum[2]}})
      EXPECT_NEAR(double{kernel}, exact, 1e-6 * absolute);
  }
  core::SceneView view;
  EXPECT_EQ(fault_of(block_around(words, 500), view), core::SceneFault::none);
  std::vector<std::uint32_t> other = words;
  reinterpret_cast<core::VolumeTable*>(other.data())->points = 0xFFFFFFFF;
  EXPECT_EQ(fault_of(block_around(other, 500), view), core::SceneFault::structure);
}

// A tool around a ball in an empty volume, whose last blocks are not whole: as if no block were empty.
TEST(SceneVolume, PointsInEmptyBlocksDoNotMatter) {
  schema::Volume volume;
  volume.samples = {41, 34, 50}, volume.spacing_m = {4e-4, 5e-4, 6e-4};
  for (int i = 0; i < 41 * 34 * 50; ++i) {
    const double x = 0.4 * (i % 41 - 20), y = 0.5 * (i / 41 % 34 - 16.5), z = 0.6 * (i / (41 * 34) - 24.5);
    volume.stored.push_back(static_cast<std::int16_t>(1000 * (6 - std::hypot(x, y, z))));
  }
  std::mt19937 random(6);
  std::uniform_real_distribution<double> at_m(-8e-3, 8e-3);
  std::vector<std::array<double, 3>> tool_m(100);
  for (auto& point_m : tool_m)
    for (double& each : point_m) each = at_m(random);
  auto words = volume_table(piece_of_volume(), volume, core::PieceTable{}, {1e-5, 1e-5, 1, 1e-5}, tool_m);
  auto& table = *reinterpret_cast<core::VolumeTable*>(words.data());
  std::vector<std::uint32_t> full = words;
  auto* const largest = reinterpret_cast<std::int16_t*>(full.data() + full.size() - block_words_of(table));
  ASSERT_EQ(block_words_of(table), (5 * 5 * 7 + 1) / 2);
  EXPECT_GT(std::count_if(largest, largest + 5 * 5 * 7, [](std::int16_t each) { return each < -101; }), 40);
  std::fill_n(largest, 5 * 5 * 7, INT16_MAX);
  int inside = 0, away = 0;
  for (int n = 0; n < 3000; ++n) {
    std::int32_t counts[3];
    for (std::int32_t& count : counts) count = static_cast<std::int32_t>(3e5 * at_m(random));
    const core::VolumeTouch a = core::touch_volume(table, counts, 500),
                            b = core::touch_volume(*reinterpret_cast<core::VolumeTable*>(full.data()), counts,
                                                   500);
    EXPECT_EQ(std::memcmp(&a.push_m, &b.push_m, sizeof a.push_m), 0) << n;
    EXPECT_EQ(a.outside_m > core::kLetGo_m, b.outside_m > core::kLetGo_m) << n;
    inside += a.outside_m == 0, away += a.outside_m > core::kLetGo_m;
  }
  EXPECT_GT(inside, 300);
  EXPECT_GT(away, 100);
}

}  // namespace
}  // namespace tacto::playback
