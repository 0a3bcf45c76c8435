// SPDX-License-Identifier: GPL-3.0-or-later
// Sessions of 60 s in space on the emulated arm, over each kind of piece and layer: computed again they are
// the same to the bit, carved voxels too, and no tick allocates.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <fstream>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "data-schema/height/height_map.hpp"
#include "data-schema/mesh/mesh.hpp"
#include "data-schema/scene/scene.hpp"
#include "data-schema/session/session_reader.hpp"
#include "data-schema/texture/texture.hpp"
#include "data-schema/volume/volume.hpp"
#include "firmware-host/core/kernel/tick_kernel.hpp"
#include "firmware-host/core/scene/scene_kernel.hpp"
#include "firmware-host/core/scene/volume.hpp"
#include "firmware-host/core/wire/message_types.hpp"
#include "firmware-host/sim/planar/planar_device.hpp"
#include "playback/player/force_program.hpp"
#include "playback/player/play.hpp"
#include "playback/player/player.hpp"
#include "playback/prepare/scene/scene_device.hpp"
#include "playback/session/session_replay.hpp"
#include "tests/data-schema/temporary_folder.hpp"
#include "tests/firmware-host/allocation_hook.hpp"

namespace tacto::playback {
namespace {

using schema::Piece;
using schema::PieceShape;

constexpr double kSession_s = 60, kVoxel_m = 8e-4;
constexpr int kVoxels = 25;  // along each axis

Piece solid(const std::string& name, PieceShape shape, double x_m, double y_m, double z_m) {
  Piece piece;
  piece.name = name, piece.shape = shape;
  piece.x_m = x_m, piece.y_m = y_m, piece.z_m = z_m;
  piece.stiffness_n_per_m = 1000, piece.damping_n_s_per_m = 2;
  return piece;
}

Piece rough(Piece piece) {
  piece.static_friction = 0.5, piece.kinetic_friction = 0.3, piece.viscous_n_s_per_m = 0.5;
  return piece;
}

// The hand comes down on a place, rubs along y and x, and goes up again: 2 s.
struct Visit {
  double x_m, y_m, z_m;
};
void append_visit(const Visit& at, double& time_s, std::ofstream& out) {
  constexpr double kUp_m = 0.02, kDeep_m = 1e-3, kRub_m = 3e-3;
  const std::array<double, 3> ways[] = {{0, 0, kUp_m},         {0, 0, 5e-4},          {0, 0, -kDeep_m},
                                        {0, kRub_m, -kDeep_m}, {kRub_m, 0, -kDeep_m}, {0, 0, -2 * kDeep_m},
                                        {0, 0, 2e-3},          {0, 0, kUp_m}};
  for (const auto& way : ways) {
    out << fmt::format("{:.3f},{},{},{}\n", time_s, at.x_m + way[0], at.y_m + way[1], at.z_m + way[2]);
    time_s += 0.25;
  }
}

class SpaceSession : public testing::Test {
 protected:
  void SetUp() override {
    schema::HeightMap map;
    map.columns = map.rows = 41, map.pitch_m = 5e-4;
    for (int i = 0; i < 41 * 41; ++i)
      map.height_m.push_back(static_cast<float>(3e-4 * std::sin(0.6 * (i % 41)) * std::cos(0.5 * (i / 41))));
    ASSERT_TRUE(
        schema::write_height_map(schema::height_map_path(folder_ / "hills"), map, schema::Existing::keep));
    schema::Texture texture;
    texture.signal = {1e-5, 0, std::vector<double>(2000)};
    for (std::size_t i = 0; i < 2000; ++i)
      texture.signal.values[i] = 0.1 * std::sin(0.08 * static_cast<double>(i));
    ASSERT_TRUE(schema::write_texture(folder_ / "oak", texture));
    schema::Mesh mesh;
    for (int i = 0; i < 8; ++i)
      mesh.vertices_m.push_back({i & 1 ? 0.01 : -0.01, i & 2 ? 0.01 : -0.01, i & 4 ? 0 : -0.01});
    mesh.triangles = {{4, 5, 7}, {4, 7, 6}, {0, 3, 1}, {0, 2, 3}, {0, 1, 5}, {0, 5, 4},
                      {2, 7, 3}, {2, 6, 7}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    ASSERT_TRUE(schema::write_mesh(schema::mesh_path(folder_ / "part"), mesh, schema::Existing::keep));
    schema::Volume ball;
    ball.samples = {kVoxels, kVoxels, kVoxels}, ball.spacing_m = {kVoxel_m, kVoxel_m, kVoxel_m};
    for (int i = 0; i < kVoxels * kVoxels * kVoxels; ++i) {
      const double x = i % kVoxels - 12, y = i / kVoxels % kVoxels - 12, z = i / (kVoxels * kVoxels) - 12;
      ball.stored.push_back(static_cast<std::int16_t>(1000 * (8 - kVoxel_m * 1e3 * std::hypot(x, y, z))));
    }
    ASSERT_TRUE(schema::write_volume(schema::volume_path(folder_ / "bone"), ball, schema::Existing::keep));
  }
  Piece bone(double x_m, double y_m, double z_m) const {
    Piece piece = rough(solid("bone", PieceShape::volume, x_m, y_m, z_m));
    piece.volume = "bone", piece.value_per_m = 1e6, piece.stiffness_n_per_m = 500;
    piece.carve = {0.5, 500};
    return piece;
  }
  // Plays it, replays it, and ticks a kernel with the counts of the session.
  void expect_same_without_allocation(schema::Scene scene, const std::vector<Visit>& visits) {
    ASSERT_TRUE(schema::write_scene(folder_ / "room", scene));
    std::ofstream path(folder_ / "path.csv");
    path << "time_s,x_m,y_m,z_m\n";
    double time_s = 0;
    while (time_s <= kSession_s)
      for (const Visit& visit : visits) append_visit(visit, time_s, path);
    path.close();
    ForcePlayOptions options;
    options.program.file = folder_ / "room";
    options.program.onset_s = 0;
    options.device_uri = "sim:arm";
    options.session = folder_ / "played.session";
    options.path = folder_ / "path.csv";
    options.time_s = kSession_s;
    const auto outcome = play_forces_once(options, [] { return false; });
    ASSERT_TRUE(outcome) << schema::message(outcome.error());
    EXPECT_TRUE(outcome->status.fault.empty()) << outcome->status.fault;
    std::vector<std::int16_t> carved;
    const auto replayed = replay_session(
        options.session, {}, {}, {}, [&](const core::SceneKernel& kernel) { carved = carved_in(kernel); });
    ASSERT_TRUE(replayed) << schema::message(replayed.error());
    EXPECT_TRUE(replayed->same());
    EXPECT_EQ(replayed->lost, 0U);
    EXPECT_GE(replayed->ticks, static_cast<std::uint64_t>(1000 * kSession_s));
    EXPECT_FALSE(carved.empty());
    tick_again(options, scene.pieces.size(), carved);
  }
  static std::vector<std::int16_t> carved_in(const core::SceneKernel& kernel) {
    const core::SceneView now = kernel.scene_now();
    for (std::uint32_t i = 0; i < now.layer_count; ++i) {
      if (now.layers[i].kind != static_cast<std::uint16_t>(core::SceneLayerKind::volume)) continue;
      const std::int16_t* const values =
          core::values_of(core::table_of<core::VolumeTable>(now, now.layers[i]));
      return {values, values + kVoxels * kVoxels * kVoxels};
    }
    return {};
  }
  std::vector<schema::SessionTick> ticks_of(const std::string& session) const {
    auto reader = schema::SessionReader::open(session);
    std::vector<schema::SessionTick> all;
    while (auto block = reader->next())
      if (const auto* const some = std::get_if<std::vector<schema::SessionTick>>(&*block))
        all.insert(all.end(), some->begin(), some->end());
    return all;
  }
  void tick_again(const ForcePlayOptions& options, std::size_t pieces,
                  const std::vector<std::int16_t>& carved) {
    const schema::Device arm = *schema::read_device("arm");
    const auto read = schema::read_scene(options.program.file);
    ASSERT_TRUE(read) << schema::message(read.error());
    const auto prepared = prepare_scene(*read, schema::scene_path(options.program.file), arm, 1000);
    ASSERT_TRUE(prepared) << schema::message(prepared.error());
    core::ForceSetup setup = *force_setup_of(arm, 1000);
    setup.onset_s = 0;
    setup.rate_hz = core::rate_of(1'000'000);  // as the wire gives it: half a unit of rounding from 1000
    const core::SceneView view = prepared->view();
    std::vector<float> live(view.live_words());
    core::SceneKernel kernel;
    kernel.set(view, setup, live.data());
    const std::vector<schema::SessionTick> ticks = ticks_of(options.session);
    std::vector<std::size_t> touched(view.layer_count);
    std::uint64_t other_forces = 0;
    const long before = tests::allocations_here();
    for (const schema::SessionTick& tick : ticks) {
      const core::ForceOutput output =
          kernel.tick(tick.counts.data(), (tick.flags & wire::kTickPlaying) != 0);
      for (std::size_t i = 0; i < 3; ++i)
        other_forces +=
            std::bit_cast<std::uint32_t>(output.force_n[i]) != std::bit_cast<std::uint32_t>(tick.force_n[i]);
      for (std::uint32_t i = 0; i < view.layer_count; ++i) {
        const auto kind = static_cast<core::SceneLayerKind>(view.layers[i].kind);
        const float* const number = live.data() + view.layers[i].first_number;
        touched[i] +=
            reinterpret_cast<const core::WallState*>(number + core::changeable_numbers_of(kind))->touched > 0;
      }
    }
    EXPECT_EQ(tests::allocations_here(), before);
    EXPECT_EQ(other_forces, 0U);
    EXPECT_EQ(carved_in(kernel), carved);
    const schema::Volume whole = *schema::read_volume(folder_ / "bone");
    EXPECT_NE(whole.stored, carved);
    ASSERT_EQ(touched.size(), pieces);
    for (std::size_t i = 0; i < pieces; ++i) EXPECT_GT(touched[i], 500U) << read->pieces[i].name;
  }

  tests::TemporaryFolder folder_;
};

TEST_F(SpaceSession, OfTheGhostOnEachKindOfPiece) {
  Piece floor = rough(solid("floor", PieceShape::plane, 0, 0, -0.03));
  floor.relief = schema::PieceRelief{"hills", {{{1, 0, 0}, {0, 1, 0}}}};
  Piece wall = solid("wall", PieceShape::plane, -0.06, 0, 0);
  wall.direction = {1, 0, 0};
  wall.arrest_mass_kg = 0.1;
  wall.integral_n_per_m_s = 1000, wall.integral_bound_n = 2, wall.integral_leak_per_s = 1;
  Piece slope = rough(solid("slope", PieceShape::plane, 0.06, 0, 0));
  slope.direction = {-1, 0, 0};
  slope.relief = schema::PieceRelief{"hills", {{{0, 1, 0}, {0, 0, 1}}}, true};
  Piece wood = rough(solid("wood", PieceShape::plane, 0, -0.06, 0));
  wood.direction = {0, 1, 0};
  wood.texture = schema::PieceTexture{schema::PieceTextureType::recording, "oak"};
  Piece plate = solid("plate", PieceShape::plane, 0, 0.06, 0);
  plate.direction = {0, -1, 0}, plate.thickness_m = 1e-3;
  Piece ball = rough(solid("ball", PieceShape::sphere, -0.03, -0.03, -0.012));
  ball.radius_m = 0.012;
  ball.texture = schema::PieceTexture{schema::PieceTextureType::bump, "hills"};
  Piece button = solid("button", PieceShape::cylinder, -0.03, 0, -0.008);
  button.direction = {0, 1, 0}, button.radius_m = 0.008;
  button.travel = {{5e-4, 2}, {5e-4, 0.5}, {1.5e-3, 1.5}};
  Piece egg = solid("egg", PieceShape::quadric, -0.03, 0.03, -0.01);
  egg.coefficients = {1e4, 2e4, 1e4, 0, 0, 0, 0, 0, 0, -1};
  egg.transient = schema::ContactTransient{32, 50, 92};
  Piece part = rough(solid("part", PieceShape::mesh, 0, -0.03, 0));
  part.mesh = "part";
  part.hand_surface = schema::HandSurface{0.3, 5, 500, 20, 2e4};
  Piece knob = solid("knob", PieceShape::sphere, 0, 0.03, -0.01);
  knob.radius_m = 0.01, knob.static_friction = 0.8, knob.kinetic_friction = 0.6;
  knob.slide = schema::PieceSlide{{1, 0, 0}, -0.01, 0.01, 0.05, 2, 0.05, 0.1, 4e-3};
  Piece pipe = solid("pipe", PieceShape::cylinder, 0.03, -0.03, -0.01);
  pipe.direction = {1, 0, 0}, pipe.radius_m = 0.01;
  pipe.texture =
      schema::PieceTexture{schema::PieceTextureType::sine, "", {{{1, 0, 0}, {0, 1, 0}}}, {2e-3, 3e-3}, 0.3};
  schema::Scene scene;
  scene.pieces = {floor,  wall, slope, wood, plate, ball,
                  button, egg,  part,  knob, pipe,  bone(0.03, 0.03, -0.008)};
  std::vector<Visit> visits = {{0.015, 0.01, -0.03}};
  for (const Piece& piece : scene.pieces)
    if (piece.shape != PieceShape::plane) visits.push_back({piece.x_m, piece.y_m, 0});
  // Rubbed by a hand that goes down beside them, half a millimetre in them.
  visits.insert(visits.end(), {{-0.0605, 0.01, 0}, {0.0605, 0.01, 0}, {0.01, -0.0605, 0}, {0.01, 0.0605, 0}});
  expect_same_without_allocation(scene, visits);
}

TEST_F(SpaceSession, OfPiecesThatAddUp) {
  Piece floor = rough(solid("floor", PieceShape::plane, 0, 0, -0.01));
  Piece ball = rough(solid("ball", PieceShape::sphere, -0.03, -0.03, -0.012));
  ball.radius_m = 0.012;
  Piece pipe = solid("pipe", PieceShape::cylinder, -0.03, 0, -0.008);
  pipe.direction = {0, 1, 0}, pipe.radius_m = 0.008;
  Piece egg = solid("egg", PieceShape::quadric, -0.03, 0.03, -0.01);
  egg.coefficients = {1e4, 2e4, 1e4, 0, 0, 0, 0, 0, 0, -1};
  schema::Scene scene;
  scene.contact = schema::PieceContact::add;
  scene.pieces = {floor, ball, pipe, egg, bone(0.03, 0.03, -0.008)};
  expect_same_without_allocation(
      scene, {{-0.03, -0.03, 0}, {-0.03, 0, 0}, {-0.03, 0.03, 0}, {0.03, 0.03, 0}, {0.03, 0, -0.01}});
}

TEST_F(SpaceSession, OfAToolThatCarves) {
  schema::Scene scene;
  scene.pieces = {bone(0, 0, -0.008)};
  for (int i = 0; i < 200; ++i) {
    const double z = 1 - (2 * i + 1.0) / 200, r = std::sqrt(1 - z * z),
                 turn = std::numbers::phi * 2 * std::numbers::pi * i;
    scene.tool_m.push_back({3e-3 * r * std::cos(turn), 3e-3 * r * std::sin(turn), 3e-3 * z});
  }
  expect_same_without_allocation(scene, {{0, 0, 3e-3}, {2e-3, 1e-3, 3e-3}});
}

// One tick without a place, 2 mm deep in a floor.
TEST_F(SpaceSession, AHandWhosePlaceIsNoNumberEndsTheForceWithin20Ms) {
  schema::Scene scene;
  scene.pieces = {solid("floor", PieceShape::plane, 0, 0, 0)};
  ASSERT_TRUE(schema::write_scene(folder_ / "floor", scene));
  auto device = firmware_host::make_planar_device("sim:arm", "");
  ASSERT_TRUE(device) << schema::message(device.error());
  (*device)->board().set_script([](double time_s) {
    return std::vector{0.0, 0.0, std::abs(time_s - 0.5) < 5e-4 ? std::nan("") : -2e-3};
  });
  firmware_host::Client& client = *(*device)->conversation();
  auto program = make_force_program({folder_ / "floor", std::nullopt, 0}, (*device)->board().device(),
                                    std::nullopt, *client.description().axes);
  ASSERT_TRUE(program) << schema::message(program.error());
  PlayerOptions options;
  options.full_queue = FullQueue::wait;
  const auto player = Player::make(client, "sim:arm", options);
  ASSERT_TRUE(player) << schema::message(player.error());
  ASSERT_TRUE((*player)->load(std::move(*program)));
  const std::string session = folder_ / "lost.session";
  ASSERT_TRUE((*player)->arm(session));
  ASSERT_TRUE((*player)->play());
  while ((*player)->armed_s() < 0.7) ASSERT_TRUE((*player)->step(0.01));
  EXPECT_EQ((*player)->state(), PlayerState::fault);
  EXPECT_FALSE((*player)->status().fault.empty());
  ASSERT_TRUE((*player)->disarm());
  const std::vector<schema::SessionTick> ticks = ticks_of(session);
  const auto lost = std::ranges::find_if(
      ticks, [](const auto& tick) { return tick.counts[2] == std::numeric_limits<std::int32_t>::min(); });
  ASSERT_GT(ticks.end() - lost, 100);
  ASSERT_GT(lost - ticks.begin(), 100);
  EXPECT_NEAR(double{(lost - 1)->force_n[2]}, 2, 1e-5);
  for (auto tick = lost; tick != ticks.end(); ++tick) {
    EXPECT_LE(tick->force_n[2], (lost - 1)->force_n[2]) << tick - lost;
    if (tick - lost >= 20) {
      EXPECT_EQ(tick->force_n[2], 0) << tick - lost;
    }
  }
  EXPECT_NE(lost->flags & wire::kTickFault, 0U);
}

}  // namespace
}  // namespace tacto::playback
