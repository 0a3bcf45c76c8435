// SPDX-License-Identifier: GPL-3.0-or-later
// The kernel's bits and its cost, and the cost of the complete firmware: it plays a profile through eight
// sections while it streams samples and ticks.
#include "firmware-host/core/firmware/firmware.hpp"
#include "firmware-host/core/wire/crc32c.hpp"
#include "tests/firmware-host/cortex_m4/board.hpp"
#include "tests/firmware-host/kernel_workload.hpp"
#include "tests/firmware-host/pieces_workload.hpp"
#include "tests/firmware-host/volume_workload.hpp"

namespace tacto::cortex_m4 {
namespace {

constexpr uint32_t kRate = 20'000'000;
constexpr uint32_t kFirmwareTicks = 4000, kChangeTicks = 1000;

struct Cost {
  uint32_t ticks = 0, total = 0, most = 0;
  void add(uint32_t counts) {
    ++ticks;
    total += counts;
    if (counts > most) most = counts;
  }
};

tests::KernelWorkload workload;

tests::TextureWorkload texture;

tests::SceneWorkload scene;
tests::PiecesWorkload pieces;
tests::VolumeWorkload volumes;

template <class Workload>
uint32_t count_ticks(Workload& ticked, const char* fingerprint_name, const char* counts_name,
                     const char* most_name) {
  tests::DriveFingerprint fingerprint;
  Cost cost;
  for (uint32_t i = 0; i < tests::kWorkloadTicks; ++i) {
    const uint32_t before = counter();
    const float drive_v = ticked.tick();
    cost.add(counted(before, counter()));
    fingerprint.add(drive_v);
  }
  say(fingerprint_name, fingerprint.value());
  say(counts_name, cost.total);
  say(most_name, cost.most);
  return fingerprint.value();
}

bool count_kernel() {
  say("kernel_ticks", tests::kWorkloadTicks);
  const uint32_t sections =
      count_ticks(workload, "kernel_fingerprint", "kernel_counts", "kernel_most_counts");
  const uint32_t levels =
      count_ticks(texture, "texture_fingerprint", "texture_counts", "texture_most_counts");
  const uint32_t patches = count_ticks(scene, "scene_fingerprint", "scene_counts", "scene_most_counts");
  const uint32_t solids = count_ticks(pieces, "pieces_fingerprint", "pieces_counts", "pieces_most_counts");
  const uint32_t voxels = count_ticks(volumes, "volume_fingerprint", "volume_counts", "volume_most_counts");
  return sections == tests::kWorkloadFingerprint && levels == tests::kTextureFingerprint &&
         patches == tests::kSceneFingerprint && solids == tests::kPiecesFingerprint &&
         voxels == tests::kVolumeFingerprint;
}

// During a change of texture both are read; its first tick also starts the change.
void count_change() {
  Cost cost;
  for (uint32_t i = 0; i < kChangeTicks; ++i) {
    const uint32_t before = counter();
    if (i == 0) texture.change(0.05F);
    texture.tick();
    cost.add(counted(before, counter()));
  }
  say("change_ticks", cost.ticks);
  say("change_counts", cost.total);
  say("change_most_counts", cost.most);
}

// The board's side of the hardware layer, in memory.
struct Link {
  uint8_t from_host[12000];
  size_t size = 0, taken = 0;
  uint32_t sequence = 0, sent = 0;
  int32_t encoder = 0;
  uint64_t clock = 0;
  float drive_v = 0;

  template <class Message>
  void say_to_device(const Message& message) {
    size += wire::encode_frame(message, sequence++, from_host + size, sizeof from_host - size);
  }
};
Link link;
float profile_memory[1024];
wire::Channel channels[4];

core::Hal hal() {
  core::Hal hal;
  hal.board = &link;
  hal.read_encoder = [](void*) noexcept { return link.encoder; };
  hal.read_channels = [](void*, int32_t* codes) noexcept {
    for (int i = 0; i < 4; ++i) codes[i] = link.encoder << i;
    return true;
  };
  hal.write_drive = [](void*, float volts) noexcept { link.drive_v = volts; };
  hal.enable_closed = [](void*) noexcept { return true; };
  hal.clock = [](void*) noexcept { return link.clock; };
  hal.set_rate = [](void*, uint32_t) noexcept {};
  hal.receive = [](void*, uint8_t* bytes, size_t capacity) noexcept {
    const size_t left = link.size - link.taken, size = left < capacity ? left : capacity;
    for (size_t i = 0; i < size; ++i) bytes[i] = link.from_host[link.taken + i];
    link.taken += size;
    return size;
  };
  hal.send = [](void*, const uint8_t*, size_t size) noexcept {
    link.sent += size;
    return size;
  };
  hal.restart = [](void*) noexcept {};
  return hal;
}

core::Board board() {
  core::Board board;
  board.about.features = wire::kFeatureDrive;
  board.about.clock_hz = 168'000'000;
  board.about.least_rate_millihertz = 1'000'000;
  board.about.most_rate_millihertz = kRate;
  board.about.drive_limit_v = 5;
  board.about.slew_limit_v_per_s = 15708;
  board.channels = channels;
  board.channel_count = 4;
  board.profile_memory = profile_memory;
  board.profile_samples = 1024;
  return board;
}

wire::ProfileChunk chunk;
core::Firmware firmware(board(), hal());

uint32_t check_of_profile() {
  return wire::crc32c(reinterpret_cast<const uint8_t*>(chunk.values), 4 * wire::kMaxChunk);
}

void begin_playing() {
  link.say_to_device(wire::Hello{});
  link.say_to_device(wire::Limits{5, 15708, 0.01F, 0.01F, 1000, 100});
  link.say_to_device(wire::ProfileBegin{wire::kMaxChunk, 0, 0, UINT64_C(1) << 29, wire::ProfileEnds::loop});
  chunk.count = wire::kMaxChunk;
  for (uint32_t i = 0; i < wire::kMaxChunk; ++i) chunk.values[i] = static_cast<float>(i % 37) * 0.05F;
  link.say_to_device(chunk);
  link.say_to_device(wire::ProfileEnd{check_of_profile()});
  wire::Filters filters;
  filters.count = 8;
  for (wire::Section& section : filters.sections) section = {1, 0.1F, 0.05F, -0.2F, 0.1F};
  link.say_to_device(filters);
  link.say_to_device(wire::Arm{wire::DriveSource::profile, kRate});
  link.say_to_device(wire::StreamStart{kRate, 32});
  link.say_to_device(wire::Play{});
  firmware.poll();
}

bool count_firmware() {
  begin_playing();
  Cost tick, poll;
  for (uint32_t i = 0; i < kFirmwareTicks; ++i) {
    link.clock += 8400;
    link.encoder += 3;
    const uint32_t before = counter();
    firmware.tick();
    const uint32_t between = counter();
    firmware.poll();
    tick.add(counted(before, between));
    poll.add(counted(between, counter()));
  }
  say("firmware_ticks", tick.ticks);
  say("firmware_tick_counts", tick.total);
  say("firmware_tick_most_counts", tick.most);
  say("firmware_poll_counts", poll.total);
  say("firmware_sent_bytes", link.sent);
  say("firmware_bytes", sizeof(core::Firmware));
  return firmware.drive_state() == wire::DriveState::playing && link.drive_v != 0;
}

}  // namespace

void run() {
  calibrate();
  const bool same_bits = count_kernel();
  count_change();
  const bool played = count_firmware();
  say("deepest_stack_bytes", deepest_stack());
  say(same_bits ? "same bits\n" : "other bits than the host\n");
  say(played ? "played\n" : "did not play\n");
  end(same_bits && played);
}

}  // namespace tacto::cortex_m4
