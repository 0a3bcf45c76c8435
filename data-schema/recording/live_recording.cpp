// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/recording/live_recording.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cassert>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "data-schema/files/event_file.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/recording/recording_close.hpp"
#include "data-schema/recording/recording_events.hpp"
#include "data-schema/recording/recording_place.hpp"

namespace tacto::schema {
namespace {

tl::unexpected<Error> not_synced(const std::string& path, int error_number) {
  return fail(ErrorKind::cannot_write,
              "cannot be written to the disk: " + std::generic_category().message(error_number), path);
}

// Syncs files periodically on a thread of its own. A sync may take a second on a busy disk. The writer must
// not wait for it: frames that arrive meanwhile would stay in memory and be lost with the process.
class BackgroundSync {
 public:
  // The files exist, and may be renamed later. Errors: cannot_write.
  static Result<std::unique_ptr<BackgroundSync>> start(const std::vector<std::string>& paths,
                                                       double every_s) {
    std::unique_ptr<BackgroundSync> sync(new BackgroundSync(every_s));
    for (const std::string& path : paths) {
      const int opened = open(path.c_str(), O_RDONLY | O_CLOEXEC);
      if (opened < 0) return not_synced(path, errno);
      sync->files_.push_back({path, opened});
    }
    sync->thread_ = std::thread([&self = *sync] { self.run(); });
    return sync;
  }

  BackgroundSync(const BackgroundSync&) = delete;
  BackgroundSync& operator=(const BackgroundSync&) = delete;
  ~BackgroundSync() {
    {
      const std::lock_guard lock(mutex_);
      stop_ = true;
    }
    changed_.notify_one();
    if (thread_.joinable()) thread_.join();
    for (const Synced& file : files_) close(file.descriptor);
  }

  // Call it after each write. Does not wait for the disk. Errors: cannot_write, of a sync since then.
  Result<void> written() {
    const std::lock_guard lock(mutex_);
    written_ = true;
    return failure_ ? Result<void>(tl::unexpected(*failure_)) : Result<void>{};
  }

 private:
  struct Synced {
    std::string path;
    int descriptor = -1;
  };
  explicit BackgroundSync(double every_s) : every_s_(every_s) {}
  void run() {
    std::unique_lock lock(mutex_);
    while (!stop_) {
      const bool due = std::exchange(written_, false);
      lock.unlock();
      if (due) sync_all();
      lock.lock();
      changed_.wait_for(lock, std::chrono::duration<double>(every_s_), [this] { return stop_; });
    }
  }

  void sync_all() {
    for (const Synced& file : files_) {
      if (fdatasync(file.descriptor) == 0) continue;
      const int error_number = errno;
      const std::lock_guard lock(mutex_);
      failure_ = not_synced(file.path, error_number).value();
    }
  }

  const double every_s_;
  std::vector<Synced> files_;  // belong to the thread while it runs
  std::mutex mutex_;
  std::condition_variable changed_;
  bool written_ = false, stop_ = false;
  std::optional<Error> failure_;
  std::thread thread_;
};

}  // namespace

struct LiveRecording::State {
  MadeFolders folders;
  std::string stem;
  RecordingHeader header;
  EventFile events;
  WavWriter wav;
  std::unique_ptr<BackgroundSync> sync;

  Result<void> append(const std::string& line);
  Result<void> check_place() const;
};

LiveRecording::LiveRecording(std::unique_ptr<State> state) : state_(std::move(state)) {}
LiveRecording::LiveRecording(LiveRecording&&) noexcept = default;
LiveRecording& LiveRecording::operator=(LiveRecording&&) noexcept = default;
LiveRecording::~LiveRecording() = default;

Result<LiveRecording> LiveRecording::create(const std::string& name, RecordingHeader header) {
  assert(header.format == SampleFormat::pcm32);
  const std::string stem = stem_of(name, ""), wav = stem + ".wav";
  TACTO_TRY(check_stem(stem));
  TACTO_TRY(check_free(stem));
  header.wav_file = std::filesystem::path(wav).filename().string();
  header.frames = 0;
  TACTO_TRY(check_storable(header));
  const auto first = begin_line(header);
  TACTO_TRY(first);
  MadeFolders folders;
  TACTO_TRY(folders.make_for(wav));
  auto events = EventFile::create(events_path(stem));
  TACTO_TRY(events);
  auto writer = WavWriter::create_new(wav, header.sample_rate_hz, header.channels.size(), header.format);
  const auto begun = writer ? events->append(*first) : forward_error(writer);
  if (!begun) {
    TACTO_TRY(events->remove());
    return forward_error(begun);
  }
  TACTO_TRY(sync_path(folder_of(wav)));
  auto sync = BackgroundSync::start({wav, events_path(stem)}, kSyncEvery_s);
  TACTO_TRY(sync);
  auto state = std::make_unique<State>(State{std::move(folders), stem, std::move(header), std::move(*events),
                                             std::move(*writer), std::move(*sync)});
  return LiveRecording(std::move(state));
}

Result<void> LiveRecording::State::append(const std::string& line) {
  const auto appended = events.append(line);
  return appended ? sync->written() : appended;
}

Result<void> LiveRecording::write(std::span<const std::int32_t> interleaved) {
  if (const auto written = state_->wav.write(interleaved); !written) return written;
  state_->header.frames += interleaved.size() / state_->header.channels.size();
  return state_->sync->written();
}

Result<void> LiveRecording::add(const Gap& gap) {
  state_->header.gaps.push_back(gap);
  return state_->append(event_line(gap));
}

Result<void> LiveRecording::add(const Mark& mark) {
  state_->header.marks.push_back(mark);
  return state_->append(event_line(mark));
}

Result<void> LiveRecording::add(const ClockPair& pair) {
  state_->header.clock_pairs.push_back(pair);
  return state_->append(event_line(pair));
}

Result<void> LiveRecording::add(const FaultNote& fault) {
  state_->header.faults.push_back(fault);
  return state_->append(event_line(fault));
}

RecordingHeader& LiveRecording::header() {
  return state_->header;
}

std::uint64_t LiveRecording::frames() const {
  return state_->header.frames;
}

// Open files can be written even if their names change; to close the recording they have to be found.
Result<void> LiveRecording::State::check_place() const {
  const std::string wav_name = stem + ".wav", place = events.place();
  const bool at_its_path = events.is_at_its_path();
  if (at_its_path && is_file(wav_name)) return {};
  const std::string now = recording_stem_of(place);
  if (events.is_deleted() || at_its_path || (!place.empty() && !is_file(now + ".wav")))
    return fail(ErrorKind::cannot_write, "was deleted during the recording: its frames are lost", wav_name,
                "record again");
  const char* const renamed = "was renamed during the recording, or its folder was";
  if (place.empty())
    return fail(ErrorKind::cannot_write, renamed, wav_name,
                "find its .events.jsonl: 'tactograph recover' makes a recording of it and its WAV");
  return fail(
      ErrorKind::cannot_write, renamed, wav_name,
      fmt::format("its frames are in {0}.wav: 'tactograph recover {0}' makes a recording of them", now));
}

// A WAV that libsndfile could not complete is repaired from its content.
Result<Recording> LiveRecording::close() {
  state_->sync.reset();  // closing syncs by itself
  TACTO_TRY(state_->check_place());
  [[maybe_unused]] const auto closed = state_->wav.close();
  return close_recording(state_->stem, std::move(state_->header), state_->events);
}

Result<void> LiveRecording::discard() {
  state_->sync.reset();
  [[maybe_unused]] const auto closed = state_->wav.close();
  std::error_code failed;
  std::filesystem::remove(state_->stem + ".wav", failed);
  if (failed)
    return fail(ErrorKind::cannot_write, "cannot be removed: " + failed.message(), state_->stem + ".wav");
  return state_->events.remove();
}

}  // namespace tacto::schema
