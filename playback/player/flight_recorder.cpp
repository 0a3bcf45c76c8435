// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/player/flight_recorder.hpp"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <type_traits>
#include <utility>

#include "firmware-host/core/wire/message_types.hpp"

namespace tacto::playback {
namespace {

using schema::Result;
using schema::SessionLoss;
using schema::SessionTick;

constexpr auto kWriteEvery = std::chrono::milliseconds(20);
constexpr auto kSyncEvery = std::chrono::milliseconds(100);
constexpr auto kRoomAgain = std::chrono::microseconds(200);
constexpr std::size_t kBatch = 4096;
constexpr std::int64_t kMostBlockNs = 4'000'000'000;               // a block stores times in 32 bits, ns
constexpr std::int64_t kFirstBlock = 8192;                         // bytes
constexpr std::size_t kMostSamplesWaiting = std::size_t{1} << 18;  // 1 MB; 13 s at 20 kHz
constexpr std::size_t kMostOwed = 1000;  // separate losses; later ones are only counted

// Whether a tick can be in the same block: consecutive, and within the longest time of a block.
bool follows(const SessionTick& next, const std::vector<SessionTick>& batch) {
  return batch.empty() ||
         (next.tick == batch.back().tick + 1 && next.time_ns - batch.front().time_ns < kMostBlockNs);
}

}  // namespace

FlightRecorder::FlightRecorder(schema::SessionWriter writer, FullQueue full, LiveLimits* limits)
    : writer_(std::move(writer)), path_(writer_.path()), full_(full), limits_(limits) {
  batch_.reserve(kBatch);
}

Result<std::unique_ptr<FlightRecorder>> FlightRecorder::begin(const std::string& path,
                                                              const schema::SessionHeader& header,
                                                              FullQueue full, LiveLimits* limits) {
  auto writer = schema::SessionWriter::create(path, header);
  TACTO_TRY(writer);
  return std::unique_ptr<FlightRecorder>(new FlightRecorder(std::move(*writer), full, limits));
}

Result<void> FlightRecorder::write_beginning() {
  write_notes();
  if (failure_) return tl::unexpected(*failure_);
  if (const auto room = writer_.make_room(kFirstBlock); !room) return room;
  return writer_.sync();
}

Result<void> FlightRecorder::start() {
  if (auto begun = write_beginning(); !begun) {
    begun.error().remedy = "free space there, or write the session to another place";
    return begun;
  }
  thread_ = std::thread([this] { run(); });
  return {};
}

FlightRecorder::~FlightRecorder() {
  stop();
}

void FlightRecorder::stop() {
  ending_.store(true);
  if (thread_.joinable()) thread_.join();
}

void FlightRecorder::tick(const SessionTick& tick) noexcept {
  SessionTick* place = queue_.place();
  while (place == nullptr && full_ == FullQueue::wait) {
    std::this_thread::sleep_for(kRoomAgain);
    place = queue_.place();
  }
  if (place == nullptr) {
    if (missing_++ == 0) missing_from_ = tick.tick;
    queue_lost_.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  *place = tick;
  queue_.push();
  if (missing_ > 0) record_loss();
}

// The queue has space again, so the loss can be recorded.
void FlightRecorder::record_loss() {
  const std::lock_guard lock(notes_mutex_);
  notes_.losses.push_back({missing_from_, std::exchange(missing_, 0), SessionLoss::Why::recorder});
}

void FlightRecorder::command(schema::SessionCommand command) {
  const std::lock_guard lock(notes_mutex_);
  notes_.commands.emplace_back(std::move(command));
}

void FlightRecorder::change(schema::SessionChange change) {
  const std::lock_guard lock(notes_mutex_);
  notes_.commands.emplace_back(std::move(change));
}

void FlightRecorder::loss(const SessionLoss& loss) {
  link_lost_.fetch_add(loss.count);
  const std::lock_guard lock(notes_mutex_);
  notes_.losses.push_back(loss);
}

void FlightRecorder::event(schema::SessionEvent event) {
  const std::lock_guard lock(notes_mutex_);
  notes_.events.push_back(std::move(event));
}

void FlightRecorder::measured(schema::SessionSamples samples) {
  const std::lock_guard lock(notes_mutex_);
  if (notes_.sample_count + samples.codes.size() > kMostSamplesWaiting) return;
  notes_.sample_count += samples.codes.size();
  notes_.samples.push_back(std::move(samples));
}

RecorderCounts FlightRecorder::counts() const {
  const std::lock_guard lock(notes_mutex_);
  return {written_.load(), queue_lost_.load(), disk_lost_.load(), late_.load(),
          failure_ ? schema::message(*failure_) : ""};
}

void FlightRecorder::failed(const schema::Error& error) {
  const std::lock_guard lock(notes_mutex_);
  failure_ = error;
}

void FlightRecorder::queue_loss(const SessionLoss& loss) {
  const bool goes_on =
      !unwritten_losses_.empty() && unwritten_losses_.back().why == loss.why &&
      unwritten_losses_.back().first_tick + unwritten_losses_.back().count == loss.first_tick;
  if (goes_on) {
    unwritten_losses_.back().count += loss.count;
  } else if (unwritten_losses_.size() < kMostOwed) {
    unwritten_losses_.push_back(loss);
  }
}

void FlightRecorder::write_run(std::span<const SessionTick> ticks) {
  const auto done = writer_.add(ticks);
  if (!done) {
    failed(done.error());
    if (limits_ != nullptr) limits_->lose("ticks");
    disk_lost_.fetch_add(ticks.size());
    queue_loss({ticks.front().tick, ticks.size(), SessionLoss::Why::disk});
    disk_full_ = true;
    return;
  }
  disk_full_ = false;
  written_.fetch_add(ticks.size());
  for (const SessionTick& tick : ticks) late_.fetch_add((tick.flags & wire::kTickLate) != 0);
}

// A block contains consecutive ticks.
void FlightRecorder::write_ticks(std::uint32_t most) {
  while (most > 0) {
    batch_.clear();
    for (const SessionTick* next = queue_.front(); most > 0 && next != nullptr && batch_.size() < kBatch;
         next = queue_.front()) {
      if (!follows(*next, batch_)) break;
      batch_.push_back(*next);
      queue_.pop();
      --most;
    }
    write_run(batch_);
    if (limits_ != nullptr) limits_->take(batch_);
  }
}

// A command is written before the ticks that follow it. So only ticks that were in the queue before the notes
// were read are written after these.
void FlightRecorder::write_queued() {
  const std::uint32_t here = queue_.size();
  write_notes();
  write_ticks(here);
}

void FlightRecorder::write_notes() {
  Notes notes;
  {
    const std::lock_guard lock(notes_mutex_);
    notes = std::exchange(notes_, {});
  }
  for (const SessionLoss& loss : notes.losses) queue_loss(loss);
  const auto put = [&](const auto& note) {
    constexpr bool kSteers = std::is_same_v<std::decay_t<decltype(note)>, schema::SessionCommand>;
    const auto done = writer_.add(note);
    if (!done) failed(done.error());
    if (!kSteers || limits_ == nullptr) return;
    if (!done) return limits_->lose("commands");
    if constexpr (kSteers) limits_->add_command(note);
  };
  for (const auto& command : notes.commands) std::visit(put, command);
  for (const auto& event : notes.events) put(event);
  for (const auto& samples : notes.samples) put(samples);
  if (!disk_full_) write_losses();  // the reserved space is for all losses
}

void FlightRecorder::write_losses() {
  while (!unwritten_losses_.empty()) {
    if (const auto done = writer_.add(unwritten_losses_.front()); !done) return failed(done.error());
    unwritten_losses_.erase(unwritten_losses_.begin());
  }
}

void FlightRecorder::run() {
  auto sync_due = std::chrono::steady_clock::now() + kSyncEvery;
  std::uint64_t synced = 0;
  while (!ending_.load()) {
    std::this_thread::sleep_for(kWriteEvery);
    write_queued();
    if (std::chrono::steady_clock::now() < sync_due) continue;
    sync_due = std::chrono::steady_clock::now() + kSyncEvery;
    if (written_.load() == std::exchange(synced, written_.load())) continue;
    if (const auto done = writer_.sync(); !done) failed(done.error());
  }
}

void FlightRecorder::discard() {
  stop();
  unlink(path_.c_str());
}

Result<void> FlightRecorder::close() {
  stop();
  if (missing_ > 0) record_loss();
  write_queued();
  write_losses();  // includes ticks for which there was no space just now
  if (limits_ != nullptr) limits_->end();
  return writer_.close(
      {written_.load(), queue_lost_.load() + disk_lost_.load() + link_lost_.load(), late_.load()});
}

}  // namespace tacto::playback
