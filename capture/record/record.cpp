// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/record/record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <semaphore>
#include <span>
#include <thread>
#include <utility>

#include "capture/record/record_header.hpp"
#include "capture/record/store_strokes.hpp"
#include "capture/table/text_encoding.hpp"
#include "data-schema/base/creation_time.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/recording/live_recording.hpp"
#include "firmware-host/link/realtime_priority.hpp"
#include "firmware-host/link/wire_words.hpp"

namespace tacto::capture {
namespace {

using firmware_host::Device;
using schema::ErrorKind;
using schema::Result;
using Clock = std::chrono::steady_clock;

constexpr double kBlock_s = 0.02;
constexpr auto kViewEvery = std::chrono::milliseconds(100);
constexpr double kSpare_bytes = 1 << 20;  // reserved on the disk for the sidecar

double disk_left_bytes(const std::string& name) {
  std::error_code unknown;
  const auto space = std::filesystem::space(schema::existing_folder_of(name), unknown);
  return unknown ? std::numeric_limits<double>::infinity() : static_cast<double>(space.available);
}

// The number of frames to record; the largest number if no time is given.
Result<std::uint64_t> frames_requested(const RecordRequest& request, double rate_hz) {
  if (!request.time_s) return std::numeric_limits<std::uint64_t>::max();
  const double frames = std::floor(*request.time_s * rate_hz + 0.5);
  if (!(frames >= 1 && frames < 0x1p53))
    return schema::fail(ErrorKind::usage,
                        fmt::format("{:g} s is not a possible duration of a recording", *request.time_s),
                        "time", "give a time above 0, for example 2s");
  return static_cast<std::uint64_t>(frames);
}

// A sidecar is UTF-8; text in another encoding cannot be recognised from its bytes alone.
Result<void> check_words(const RecordRequest& request) {
  const std::pair<const char*, const std::string&> words[] = {{"--subject", request.subject},
                                                              {"--finger", request.finger},
                                                              {"--surface", request.surface},
                                                              {"--notes", request.notes},
                                                              {"-o", request.name}};
  for (const auto& [option, text] : words)
    if (!is_utf8(text))
      return schema::fail(ErrorKind::usage, "is not UTF-8", option,
                          "use a terminal in a UTF-8 locale, or plain letters");
  return {};
}

std::string gigabytes(double bytes) {
  return fmt::format("{:.3g} GB", bytes / 1e9);
}

// The estimate of a recording without a time is its start.
Result<void> check_room(const RecordRequest& request, const schema::RecordingHeader& header) {
  const double bytes_per_s =
      header.sample_rate_hz * static_cast<double>(header.channels.size()) * sizeof(std::int32_t);
  const double needed = request.time_s.value_or(0) * bytes_per_s + kSpare_bytes;
  const double left = disk_left_bytes(request.name);
  if (!(needed > left)) return {};  // also for a time that is no number, which is refused by itself
  const std::string what =
      request.time_s ? fmt::format("{:g} s need", *request.time_s) : "a recording needs to start";
  const double longest_s = std::floor((left - kSpare_bytes) / bytes_per_s);
  return schema::fail(
      ErrorKind::cannot_write,
      fmt::format("{} {} of disk space, but only {} are free", what, gigabytes(needed), gigabytes(left)),
      schema::existing_folder_of(request.name),
      request.time_s && longest_s >= 1
          ? fmt::format("record for at most {:.0f} s, or to another disk", longest_s)
          : "record to another disk");
}

struct FrameBlock {
  std::vector<std::int32_t> codes;  // the size of a block
  std::size_t used = 0;             // the codes that are valid
  firmware_host::StreamEvents events;
  std::vector<schema::Mark> marks;
  bool last = false;  // the last block of the recording
};

// Blocks between the capturing thread and the writing thread: a ring of preallocated blocks with one producer
// and one consumer thread. With a slow disk all blocks fill and the producer waits; the device then loses
// frames and reports them.
class BlockQueue {
 public:
  BlockQueue(std::size_t blocks, std::size_t codes) : free_(static_cast<std::ptrdiff_t>(blocks)), filled_(0) {
    ring_.resize(blocks);
    for (FrameBlock& block : ring_) block.codes.resize(codes);
  }

  // Waits for the next free block; followed by filled().
  FrameBlock& to_fill() {
    free_.acquire();
    FrameBlock& block = ring_[next_to_fill_++ % ring_.size()];
    block.used = 0;
    block.events = {};
    block.marks.clear();
    return block;
  }
  void filled() { filled_.release(); }

  // Waits for the next filled block; followed by taken().
  FrameBlock& to_take() {
    filled_.acquire();
    return ring_[next_to_take_++ % ring_.size()];
  }
  void taken() { free_.release(); }

 private:
  std::vector<FrameBlock> ring_;
  std::size_t next_to_fill_ = 0, next_to_take_ = 0;  // each is used by one thread only
  std::counting_semaphore<> free_, filled_;
};

// The thread that writes the blocks of the capturing thread to the disk; gaps and marks are written before
// the frames of their block. Only the capturing thread calls to_fill(), filled(), end() and failed(); after
// end() it may use the recording again. After a write error, which is kept, all further blocks are dropped.
class DiskWriter {
 public:
  // `live` must exist as long as this object; `codes` is the size of a block.
  DiskWriter(schema::LiveRecording& live, std::size_t codes);
  ~DiskWriter();

  FrameBlock& to_fill() { return queue_.to_fill(); }
  void filled() { queue_.filled(); }
  // Waits until all blocks are written. Later calls do nothing; the destructor calls it, too.
  void end();
  bool failed() const { return failed_; }
  // After end(), if failed().
  const schema::Error& error() const { return error_; }

 private:
  void run();
  schema::Result<void> write(const FrameBlock& block);

  schema::LiveRecording& live_;
  BlockQueue queue_;
  std::atomic<bool> failed_ = false;
  schema::Error error_;
  std::thread thread_;
};

constexpr std::size_t kMostBlocks = 200;  // four seconds in blocks of 20 ms
constexpr std::size_t kMostBytes = std::size_t{16} << 20;

std::size_t blocks_of(std::size_t codes) {
  return std::clamp<std::size_t>(kMostBytes / (codes * sizeof(std::int32_t)), 4, kMostBlocks);
}

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

// One recording: blocks from the device to the writer, and figures of them for the view.
class Capture {
 public:
  Capture(Device& device, const RecordRequest& request, const RecordHooks& hooks, schema::LiveRecording& live,
          std::uint64_t frames);
  void run();
  Result<Recorded> finish(schema::LiveRecording& live);

 private:
  void take_all();
  bool goes_on() const;
  void take_block();
  void take_events(FrameBlock& block);
  void take_marks(FrameBlock& block);
  void tell();
  double time_s() const {
    return static_cast<double>(frames_ + lost_noted_) / device_.capabilities().sample_rate_hz;
  }

  Device& device_;
  const RecordRequest& request_;
  const RecordHooks& hooks_;
  const std::size_t channels_, block_frames_;
  const std::uint64_t target_;
  LiveFigures figures_;
  DiskWriter writer_;
  std::uint64_t frames_ = 0, lost_noted_ = 0;
  bool stream_ended_ = false;
  std::optional<schema::Error> failure_;
  Clock::time_point next_view_ = Clock::now();
};

std::size_t frames_of_block(double rate_hz) {
  return std::max<std::size_t>(1, static_cast<std::size_t>(rate_hz * kBlock_s));
}

Capture::Capture(Device& device, const RecordRequest& request, const RecordHooks& hooks,
                 schema::LiveRecording& live, std::uint64_t frames)
    : device_(device),
      request_(request),
      hooks_(hooks),
      channels_(live.header().channels.size()),
      block_frames_(frames_of_block(live.header().sample_rate_hz)),
      target_(frames),
      figures_(live.header()),
      writer_(live, block_frames_ * channels_) {}

bool Capture::goes_on() const {
  if (stream_ended_ || failure_ || frames_ == target_ || writer_.failed()) return false;
  if (request_.strokes > 0 && figures_.strokes() >= request_.strokes) return false;
  return !hooks_.stop || !hooks_.stop();
}

// If a device reports only the number of losses, they are assumed to be before the block.
void Capture::take_events(FrameBlock& block) {
  block.events = device_.take_events();
  std::uint64_t noted = 0;
  for (const schema::Gap& gap : block.events.gaps) noted += gap.count;
  const std::uint64_t lost = device_.counts().lost_frames;
  if (noted == 0 && lost > lost_noted_)
    block.events.gaps.push_back({frames_, frames_ + lost, lost - lost_noted_});
  lost_noted_ = std::max(lost, lost_noted_ + noted);
}

void Capture::take_block() {
  FrameBlock& block = writer_.to_fill();
  const std::size_t frames = std::min<std::uint64_t>(block_frames_, target_ - frames_);
  const auto got = device_.read(std::span(block.codes).first(frames * channels_));
  if (!got) failure_ = got.error();
  stream_ended_ = got && *got == 0;
  take_events(block);
  block.used = got.value_or(0) * channels_;
  figures_.add(std::span<const std::int32_t>(block.codes).first(block.used));
  frames_ += got.value_or(0);
  take_marks(block);
  writer_.filled();
}

void Capture::take_marks(FrameBlock& block) {
  if (!hooks_.new_marks) return;
  for (std::string& label : hooks_.new_marks()) {
    block.marks.push_back({frames_, std::move(label)});
    if (hooks_.marked) hooks_.marked(block.marks.back(), time_s());
  }
}

void Capture::tell() {
  if (hooks_.progress && request_.time_s)
    hooks_.progress(static_cast<double>(frames_) / static_cast<double>(target_));
  if (!hooks_.view || Clock::now() < next_view_) return;
  next_view_ = Clock::now() + kViewEvery;
  LiveView view = figures_.take_view();
  view.lost_frames = lost_noted_;
  view.time_s = time_s();
  view.disk_left_bytes = static_cast<std::uint64_t>(std::min(disk_left_bytes(request_.name), 0x1p63));
  hooks_.view(view, figures_.header());
}

void Capture::run() {
  take_all();
  writer_.end();
}

// At real-time priority, so that the link's buffer is read in time. Not for a source that never blocks,
// because other threads would then not run.
void Capture::take_all() {
  std::optional<firmware_host::RealtimePriority> priority;
  if (device_.is_real_time()) priority.emplace();
  while (goes_on()) {
    take_block();
    tell();
  }
  FrameBlock& last = writer_.to_fill();  // a mark may be asked for together with the end
  take_marks(last);
  writer_.filled();
}

Result<Recorded> Capture::finish(schema::LiveRecording& live) {
  if (writer_.failed()) failure_ = writer_.error();
  const auto counts = device_.counts();
  const bool nothing = live.frames() == 0;
  if (nothing) {
    TACTO_TRY(live.discard());
    if (failure_) return tl::unexpected(*failure_);
    return schema::fail(ErrorKind::device, "the device sent no frames", device_.capabilities().uri);
  }
  schema::RecordingHeader& header = live.header();
  if (failure_) header.ended = failure_->what;
  const std::uint64_t due = stream_ended_ && request_.time_s ? target_ : 0;
  for (std::string& warning : stream_warnings(counts, due)) header.warnings.push_back(std::move(warning));
  if (failure_) header.warnings.push_back("the recording ended early: " + schema::message(*failure_));
  auto recording = live.close();
  TACTO_TRY(recording);
  if (const auto stored = store_strokes(*recording); !stored)
    recording->header.warnings.push_back("its strokes are not listed: " + schema::message(stored.error()));
  return Recorded{std::move(*recording), figures_.statistics(), counts, failure_};
}

// The warnings about the calibration are also written to the sidecar.
Result<schema::RecordingHeader> calibrated_header(const Device& device, const RecordRequest& request) {
  auto header = header_for(device.capabilities(), request);
  if (!header || !request.calibration) return header;
  auto warnings =
      apply_calibration(*header, *request.calibration, request.stale_after_s, schema::creation_time());
  TACTO_TRY(warnings);
  header->warnings.insert(header->warnings.end(), warnings->begin(), warnings->end());
  return header;
}

}  // namespace

Result<Recorded> record(Device& device, const RecordRequest& request, const RecordHooks& hooks) {
  TACTO_TRY(check_words(request));
  auto header = calibrated_header(device, request);
  TACTO_TRY(header);
  TACTO_TRY(check_room(request, *header));
  const auto frames = frames_requested(request, device.capabilities().sample_rate_hz);
  TACTO_TRY(frames);
  auto live = schema::LiveRecording::create(request.name, std::move(*header));
  TACTO_TRY(live);
  if (const auto started = device.start(); !started) {
    TACTO_TRY(live->discard());
    return schema::forward_error(started);
  }
  Capture capture(device, request, hooks, *live, *frames);
  capture.run();
  const auto stopped = device.stop();
  auto recorded = capture.finish(*live);
  if (recorded && !stopped && !recorded->ended_by) recorded->ended_by = stopped.error();
  return recorded;
}

}  // namespace tacto::capture
