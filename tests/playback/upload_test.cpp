// SPDX-License-Identifier: GPL-3.0-or-later
// The emulated device closes the loop with the uploaded data: each of its ticks equals the in-process
// kernel's to the bit.
#include "playback/prepare/upload.hpp"

#include <gtest/gtest.h>

#include "firmware-host/core/wire/crc32c.hpp"
#include "firmware-host/sim/device/sim_device.hpp"
#include "made_textures.hpp"
#include "tests/playback/rayleigh_law.hpp"

namespace tacto::playback {
namespace {

using firmware_host::Client;

schema::Transducer uploaded_transducer() {
  return *schema::read_transducer("wiertlewski2011");
}

schema::Texture two_sines() {
  return texture_of(0.02, [](double x) {
    return 0.02 * (std::sin(kTwoPi * 1.3e3 * x) + 0.7 * std::sin(kTwoPi * 41e3 * x));
  });
}

PrepareOptions device_options(double rate_hz) {
  PrepareOptions options;
  options.rate_hz = rate_hz;
  options.ends = Ends::mirror;
  options.energy_rms_v = 0.3;
  options.energy_window_s = 0.1;
  return options;
}

std::unique_ptr<firmware_host::SimDevice> sim_device() {
  auto device = firmware_host::make_sim_device("sim:", "surface=C,speed=80mm/s,seed=1");
  return device ? std::move(*device) : nullptr;
}

void take_ticks(Client& client, std::size_t up_to, std::vector<wire::Tick>& ticks) {
  while (ticks.size() < up_to && client.heartbeat()) {
    EXPECT_TRUE(client.receive(0.02));
    for (const wire::Ticks& block : client.take_ticks())
      ticks.insert(ticks.end(), block.ticks, block.ticks + block.count);
  }
}

/// Ticks of a second of playback; `meanwhile` is called halfway.
std::vector<wire::Tick> play_a_second(
    Client& client, double rate_hz, const std::function<void()>& meanwhile = [] {}) {
  EXPECT_TRUE(
      client.command(wire::Arm{wire::DriveSource::profile, static_cast<std::uint32_t>(1e3 * rate_hz)}));
  EXPECT_TRUE(client.command(wire::Play{}));
  std::vector<wire::Tick> ticks;
  take_ticks(client, static_cast<std::size_t>(rate_hz / 2), ticks);
  meanwhile();
  take_ticks(client, static_cast<std::size_t>(rate_hz), ticks);
  return ticks;
}

class Uploaded : public testing::TestWithParam<double> {};

TEST_P(Uploaded, TheDevicesDriveIsTheKernelsToTheBit) {
  schema::Transducer bender = uploaded_transducer();
  bender.hysteresis = rayleigh(0.16, bender.drive_limit_v, 20);
  const auto prepared = prepare(two_sines(), bender, device_options(GetParam()));
  ASSERT_TRUE(prepared) << message(prepared.error());
  EXPECT_GT(prepared->scale.levels, 4);
  EXPECT_EQ(prepared->play_operators.count, wire::kMaxPlays);
  const auto device = sim_device();
  ASSERT_TRUE(device);
  const auto sent = upload(device->client(), *prepared);
  ASSERT_TRUE(sent) << message(sent.error());
  const auto ticks = play_a_second(device->client(), GetParam());
  core::TickKernel kernel;
  kernel.set(prepared->setup());
  double energy = 0;
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    const bool raise = (ticks[i].flags & wire::kTickPlaying) != 0;
    const auto output = kernel.tick({ticks[i].encoder, prepared->gain_m_per_n, raise, core::kNoForce});
    ASSERT_EQ(output.drive_v, ticks[i].drive_v) << i;
    energy += output.drive_v * output.drive_v;
  }
  EXPECT_GT(std::sqrt(energy / static_cast<double>(ticks.size())), 0.05)
      << "a drive of nothing proves nothing";
}

// The device's gain remains that of the first texture: the uploaded samples are scaled to it.
TEST_P(Uploaded, AChangeIsTheKernelsToTheBit) {
  PrepareOptions options = device_options(GetParam());
  const auto one = prepare(two_sines(), uploaded_transducer(), options);
  options.gain_m_per_n = 0.7e-3, options.ends = Ends::loop;
  auto two = prepare(sine_texture(0.013, 3e3, 0.03), uploaded_transducer(), options);
  ASSERT_TRUE(one && two);
  const auto device = sim_device();
  ASSERT_TRUE(upload(device->client(), *one));
  const auto ticks = play_a_second(device->client(), GetParam(), [&] {
    const auto changed = upload_change(device->client(), *two, one->gain_m_per_n, 0.2);
    EXPECT_TRUE(changed) << message(changed.error());
  });
  for (float& sample : two->samples)
    sample = static_cast<float>(double{two->gain_m_per_n} / one->gain_m_per_n * sample);
  core::TickKernel kernel;
  kernel.set(one->setup());
  bool changed = false;
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    if (!changed && ticks[i].flags >> wire::kTickSteeredShift == 2)
      kernel.change(two->setup().texture, 0.2F), changed = true;
    const bool raise = (ticks[i].flags & wire::kTickPlaying) != 0;
    const auto output = kernel.tick({ticks[i].encoder, one->gain_m_per_n, raise, core::kNoForce});
    ASSERT_EQ(output.drive_v, ticks[i].drive_v) << i;
  }
  EXPECT_TRUE(changed);
  EXPECT_FALSE(kernel.changing());
}

INSTANTIATE_TEST_SUITE_P(Rates, Uploaded, testing::Values(2e3, 10e3));

TEST(Upload, ATextureTooLargeIsRefusedWithBothSizes) {
  const auto small = texture_of(0.02, [](double x) { return 0.01 * std::sin(kTwoPi * 2e3 * x); });
  auto prepared = prepare(small, uploaded_transducer(), device_options(2e3));
  ASSERT_TRUE(prepared);
  const auto device = sim_device();
  ASSERT_TRUE(upload(device->client(), *prepared));
  const std::uint32_t room = device->client().description().welcome.profile_samples;
  prepared->samples.resize(room + 1);
  const auto sent = upload(device->client(), *prepared);
  ASSERT_FALSE(sent);
  EXPECT_NE(message(sent.error()).find(std::to_string(prepared->samples.size())), std::string::npos);
  EXPECT_NE(message(sent.error()).find(std::to_string(room)), std::string::npos);
}

// Between upload and arming a new profile removes levels, taps and everything else: a host of protocol 1.0
// plays as before.
TEST(Upload, ANewProfileStartsWithoutTheSettingsOfTheLast) {
  const auto prepared = prepare(two_sines(), uploaded_transducer(), device_options(2e3));
  const auto device = sim_device();
  Client& client = device->client();
  ASSERT_TRUE(upload(client, *prepared));
  ASSERT_TRUE(client.command(wire::ProfileBegin{512, 0, 0, UINT64_C(1) << 32, wire::ProfileEnds::loop}));
  wire::ProfileChunk chunk{0, 512, {}};
  std::fill_n(chunk.values, 512, 0.25F);
  ASSERT_TRUE(client.command(chunk));
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(chunk.values);
  ASSERT_TRUE(client.command(wire::ProfileEnd{wire::crc32c(bytes, sizeof chunk.values)}));
  ASSERT_TRUE(client.command(wire::Gain{1}));
  EXPECT_EQ(play_a_second(client, 2e3).back().drive_v, 0.25F);
}

TEST(Upload, LevelsThatDoNotAddUpAreRefused) {
  const auto device = sim_device();
  Client& client = device->client();
  EXPECT_FALSE(client.command(wire::ProfileLevels{2, wire::Interpolation::hermite, 0, 64}));
  ASSERT_TRUE(client.command(wire::ProfileBegin{160, 0, 0, UINT64_C(1) << 32, wire::ProfileEnds::loop}));
  EXPECT_TRUE(client.command(wire::ProfileLevels{3, wire::Interpolation::hermite, 0, 64}));
  EXPECT_FALSE(client.command(wire::ProfileLevels{3, wire::Interpolation::hermite, 0, 65}));
  EXPECT_FALSE(client.command(wire::ProfileLevels{0, wire::Interpolation::hermite, 0, 64}));
  EXPECT_FALSE(client.command(wire::ProfileLevels{17, wire::Interpolation::hermite, 0, 64}));
  EXPECT_FALSE(client.command(wire::ProfileLevels{3, static_cast<wire::Interpolation>(4), 0, 64}));
}

}  // namespace
}  // namespace tacto::playback
