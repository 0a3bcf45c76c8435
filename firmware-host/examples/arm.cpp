// SPDX-License-Identifier: Apache-2.0
// An arm of three axes behind its vendor's SDK, as a device of tactograph on a pseudo-terminal: the core
// speaks the wire (WIRE.md) and computes the forces; this program has only to read places and write forces.
// Replace the class VendorArm by calls of the SDK: forces and places are Cartesian, the joints are the SDK's
// affair.
//   arm_example &   # prints its port
//   tactograph play room.scene.json -d tty:/dev/pts/3 --time 10s -o touched
#include <fcntl.h>
#include <stdlib.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <vector>

#include "firmware-host/core/firmware/firmware.hpp"

namespace {

using namespace tacto::core;
namespace wire = tacto::wire;

constexpr double kStep_m = 1e-5;  // of the SDK's places, or finer
constexpr std::uint32_t kRate_hz = 1000, kClock_hz = 1'000'000;

// In place of an SDK: 0.15 kg on a spring of 200 N/m to the middle, let go 20 mm above it.
class VendorArm {
 public:
  void read(double (&place_m)[3]) const { std::memcpy(place_m, place_m_, sizeof place_m_); }
  void write(const double (&force_n)[3]) {
    for (int i = 0; i < 3; ++i) {
      speed_mps_[i] += (force_n[i] - 200 * place_m_[i] - 2 * speed_mps_[i]) / 0.15 / kRate_hz;
      place_m_[i] += speed_mps_[i] / kRate_hz;
    }
  }

 private:
  double place_m_[3] = {0, 0, 0.02}, speed_mps_[3] = {};
};

struct ArmBoard {
  VendorArm arm;
  int port = -1;
  std::uint32_t rate_millihertz = 0;
};

ArmBoard& board_of(void* board) noexcept {
  return *static_cast<ArmBoard*>(board);
}

std::uint64_t clock_of(void* /*board*/) noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<std::uint64_t>(now.tv_sec) * kClock_hz + static_cast<std::uint64_t>(now.tv_nsec) / 1000;
}

// A place that is no number is the least count: the firmware answers this jump with a fault, and the force is
// 0.
void read_axes(void* board, std::int32_t* counts) noexcept {
  double place_m[3];
  board_of(board).arm.read(place_m);
  for (int i = 0; i < 3; ++i) {
    const double count = std::nearbyint(place_m[i] / kStep_m);
    counts[i] = std::abs(count) < 1e9 ? static_cast<std::int32_t>(count) : INT32_MIN;
  }
}

std::int32_t height(void* board) noexcept {
  std::int32_t counts[3];
  read_axes(board, counts);
  return counts[2];
}

void write_forces(void* board, const float* force_n) noexcept {
  board_of(board).arm.write({force_n[0], force_n[1], force_n[2]});
}

Hal hal_of(ArmBoard& board) {
  Hal hal;
  hal.board = &board;
  hal.read_encoder = [](void* b) noexcept { return height(b); };
  hal.read_channels = [](void* b, std::int32_t* codes) noexcept {
    codes[0] = height(b);
    return true;
  };
  hal.write_drive = [](void* /*board*/, float /*volts*/) noexcept {};
  hal.read_axes = read_axes;
  hal.write_forces = write_forces;
  hal.enable_closed = [](void* /*board*/) noexcept { return true; };  // the SDK's dead man's switch
  hal.clock = clock_of;
  hal.set_rate = [](void* b, std::uint32_t rate) noexcept { board_of(b).rate_millihertz = rate; };
  hal.receive = [](void* b, std::uint8_t* bytes, std::size_t room) noexcept {
    const ssize_t got = ::read(board_of(b).port, bytes, room);
    return got > 0 ? static_cast<std::size_t>(got) : std::size_t{0};
  };
  hal.send = [](void* b, const std::uint8_t* bytes, std::size_t size) noexcept {
    const ssize_t sent = ::write(board_of(b).port, bytes, size);
    return sent > 0 ? static_cast<std::size_t>(sent) : std::size_t{0};
  };
  hal.restart = [](void* b) noexcept { board_of(b).rate_millihertz = 0; };
  return hal;
}

int open_port() {
  const int port = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
  if (port < 0 || grantpt(port) != 0 || unlockpt(port) != 0) return -1;
  const int host_end =
      open(ptsname(port), O_RDWR | O_NOCTTY);  // stays open: the port exists between two hosts
  termios raw{};
  if (host_end < 0 || tcgetattr(host_end, &raw) != 0) return -1;
  cfmakeraw(&raw);
  return tcsetattr(host_end, TCSANOW, &raw) == 0 ? port : -1;
}

}  // namespace

int main() {
  ArmBoard board;
  board.port = open_port();
  if (board.port < 0) return 1;
  wire::Axes axes;  // of the arm's data sheet
  axes.count = 3;
  axes.peak_n = 10, axes.continuous_n = 3, axes.slew_n_per_s = 20000;
  for (std::uint8_t i = 0; i < 3; ++i)
    axes.axes[i] = {static_cast<wire::AxisAlong>(i), {}, 10, 3, static_cast<float>(kStep_m), -0.1, 0.1};
  wire::Channel z;  // a device has at least one channel that `record` can read
  std::strcpy(z.name, "z");
  std::strcpy(z.quantity, "position");
  std::strcpy(z.unit, "m");
  std::strcpy(z.source, "SDK");
  z.scale = kStep_m;
  z.range_min = z.range_max = z.native_rate_hz = std::nan("");
  std::vector<float> memory(1U << 16);
  Board about;
  std::strcpy(about.about.name, "example arm");
  std::strcpy(about.about.serial, "1");
  std::strcpy(about.about.firmware, "example");
  about.about.clock_hz = kClock_hz;
  about.about.default_rate_millihertz = about.about.least_rate_millihertz = about.about.most_rate_millihertz =
      1000 * kRate_hz;
  about.profile_memory = memory.data(), about.profile_samples = static_cast<std::uint32_t>(memory.size());
  about.channels = &z, about.channel_count = 1;
  about.axes = &axes;
  Firmware firmware(about, hal_of(board));
  std::printf("tty:%s\n", ptsname(board.port));
  std::fflush(stdout);
  timespec next{};
  clock_gettime(CLOCK_MONOTONIC, &next);
  while (true) {
    if (board.rate_millihertz > 0) firmware.tick();
    firmware.poll();
    next.tv_nsec += 1'000'000'000 / kRate_hz;
    if (next.tv_nsec >= 1'000'000'000) next.tv_nsec -= 1'000'000'000, ++next.tv_sec;
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &next, nullptr);
  }
}
