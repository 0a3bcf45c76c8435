// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/record/disk_writer.hpp"

#include <algorithm>
#include <span>

#include "firmware-host/link/wire_words.hpp"

namespace tacto::capture {
namespace {

constexpr std::size_t kMostBlocks = 200;  // four seconds in blocks of 20 ms
constexpr std::size_t kMostBytes = std::size_t{16} << 20;

std::size_t blocks_of(std::size_t codes) {
  return std::clamp<std::size_t>(kMostBytes / (codes * sizeof(std::int32_t)), 4, kMostBlocks);
}

}  // namespace

DiskWriter::DiskWriter(schema::LiveRecording& live, std::size_t codes)
    : live_(live), queue_(blocks_of(codes), codes), thread_([this] { run(); }) {}

DiskWriter::~DiskWriter() {
  end();
}

void DiskWriter::end() {
  if (!thread_.joinable()) return;
  queue_.to_fill().last = true;
  queue_.filled();
  thread_.join();
}

void DiskWriter::run() {
  for (bool last = false; !last; queue_.taken()) {
    const FrameBlock& block = queue_.to_take();
    last = block.last;
    if (failed_ || last) continue;
    if (const auto written = write(block); !written) {
      error_ = written.error();
      failed_ = true;
    }
  }
}

schema::Result<void> DiskWriter::write(const FrameBlock& block) {
  for (const schema::Gap& gap : block.events.gaps)
    if (const auto added = live_.add(gap); !added) return added;
  for (const auto& [sequence, device_s, host_s] : block.events.clock_pairs)
    if (const auto added = live_.add(schema::ClockPair{sequence, device_s, host_s}); !added) return added;
  for (const firmware_host::DeviceFault& fault : block.events.faults) {
    const schema::FaultNote note{fault.frame, firmware_host::words_of(fault.code, fault.detail).what};
    if (const auto added = live_.add(note); !added) return added;
  }
  if (const auto written = live_.write(std::span<const std::int32_t>(block.codes).first(block.used));
      !written)
    return written;
  // After the frames: `recover` removes a mark that is beyond the last frame.
  for (const schema::Mark& mark : block.marks)
    if (const auto added = live_.add(mark); !added) return added;
  return {};
}

}  // namespace tacto::capture
