// SPDX-License-Identifier: GPL-3.0-or-later
// usage: tick_lateness RATE_HZ SECONDS PRIORITY. Prints how late the daemon's clock wakes, and the duration
// of a tick of the kernel after that sleep, as one line of JSON in seconds.
#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>

#include "firmware-host/link/awake_cores.hpp"
#include "firmware-host/link/realtime_priority.hpp"
#include "firmware-host/link/tick_clock.hpp"
#include "playback/host-loop/time_histogram.hpp"
#include "tests/firmware-host/kernel_workload.hpp"

namespace tacto::playback {
namespace {

using firmware_host::TickClock;

struct Lateness {
  TimeHistogram late, work;
  std::uint64_t missed = 0;
  bool real_time = false, awake = false;
};

void measure(double rate_hz, double seconds, int priority, Lateness& into) {
  static tests::TextureWorkload kernel;
  const firmware_host::RealtimePriority real_time(priority);
  const firmware_host::AwakeCores awake;
  into.real_time = real_time.granted();
  into.awake = awake.granted();
  TickClock clock;
  clock.begin(rate_hz);
  float sum = 0;
  for (auto left = static_cast<std::int64_t>(rate_hz * seconds); left > 0; --left) {
    into.late.add(clock.wait(into.missed));
    const std::int64_t began_ns = TickClock::now_ns();
    sum += kernel.tick();
    into.work.add(TickClock::now_ns() - began_ns);
  }
  if (sum == 1e30F) std::puts("");  // uses the result, so that the compiler does not remove the ticks
}

}  // namespace
}  // namespace tacto::playback

int main(int count, char** words) {
  if (count != 4) return 2;
  tacto::playback::Lateness measured;
  tacto::playback::measure(std::atof(words[1]), std::atof(words[2]), std::atoi(words[3]), measured);
  fmt::print(
      R"({{"p50_s": {}, "p99_s": {}, "p999_s": {}, "work_p50_s": {}, "work_p99_s": {}, "missed": {}, "real_time": {}, "awake": {}}})"
      "\n",
      measured.late.quantile_s(0.5), measured.late.quantile_s(0.99), measured.late.quantile_s(0.999),
      measured.work.quantile_s(0.5), measured.work.quantile_s(0.99), measured.missed, measured.real_time,
      measured.awake);
  return 0;
}
