// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/session/session_writer.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "data-schema/session/session_blocks.hpp"

namespace tacto::schema {
namespace {

constexpr std::int64_t kFreeOfTicks = 4096, kFreeOfNotes = 2048, kFreeOfLosses = 256;
constexpr std::int64_t kAhead = 65536;  // room is reserved in such steps

tl::unexpected<Error> unwritable_session(const std::string& path, int error_number) {
  if (error_number == EEXIST)
    return fail(ErrorKind::usage, "exists already, and is not overwritten", path, "choose another name");
  return fail(ErrorKind::cannot_write, "cannot be written: " + std::generic_category().message(error_number),
              path);
}

}  // namespace

SessionWriter::SessionWriter(SessionWriter&& other) noexcept
    : path_(std::move(other.path_)),
      folders_(std::move(other.folders_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      size_(other.size_),
      held_(other.held_) {}

SessionWriter& SessionWriter::operator=(SessionWriter&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(folders_, other.folders_);
  std::swap(descriptor_, other.descriptor_);
  std::swap(size_, other.size_);
  std::swap(held_, other.held_);
  return *this;
}

SessionWriter::~SessionWriter() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Result<SessionWriter> SessionWriter::create(const std::string& path, const SessionHeader& header) {
  const auto text = session_header_text(header);
  TACTO_TRY(text);
  MadeFolders folders;
  TACTO_TRY(folders.make_for(path));
  const int opened = open(path.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
  if (opened < 0) return unwritable_session(path, errno);
  SessionWriter writer(path, opened);
  writer.folders_ = std::move(folders);
  flock(opened, LOCK_EX | LOCK_NB);  // no other process has the lock: the file is new
  if (const auto begun = writer.append(sealed_block(BlockType::header, *text), kFreeOfTicks); !begun) {
    unlink(path.c_str());
    return forward_error(begun);
  }
  return writer;
}

Result<void> SessionWriter::make_room(std::int64_t bytes) {
  const std::int64_t needed = size_ + bytes;
  rlimit most{};
  if (getrlimit(RLIMIT_FSIZE, &most) == 0 && static_cast<rlim_t>(needed) > most.rlim_cur)
    return unwritable_session(path_, EFBIG);
  if (needed <= held_) return {};
  for (const std::int64_t ahead : {kAhead, std::int64_t{0}}) {
    if (fallocate(descriptor_, FALLOC_FL_KEEP_SIZE, size_, bytes + ahead) == 0)
      return held_ = needed + ahead, Result<void>{};
    if (errno != ENOSPC && errno != EDQUOT) return {};
  }
  return unwritable_session(path_, errno);
}

// An incomplete block would hide the following ones.
Result<void> SessionWriter::append(const std::string& block, std::int64_t to_keep_free) {
  const auto size = static_cast<std::int64_t>(block.size());
  if (const auto room = make_room(size + to_keep_free); !room) return room;
  const ssize_t done = pwrite(descriptor_, block.data(), block.size(), size_);
  if (done == static_cast<ssize_t>(block.size())) {
    size_ += done;
    return {};
  }
  const int why = done < 0 ? errno : ENOSPC;
  if (done > 0 && ftruncate(descriptor_, size_) == 0) held_ = 0;
  return unwritable_session(path_, why);
}

Result<void> SessionWriter::add(std::span<const SessionTick> ticks) {
  for (; !ticks.empty(); ticks = ticks.subspan(std::min(ticks.size(), kMostBlockTicks))) {
    const auto part = ticks.first(std::min(ticks.size(), kMostBlockTicks));
    const std::string block = part.front().axes > 0
                                  ? sealed_block(BlockType::axis_ticks, axis_ticks_payload(part))
                                  : sealed_block(BlockType::ticks, ticks_payload(part));
    if (const auto done = append(block, kFreeOfTicks); !done) return done;
  }
  return {};
}

Result<void> SessionWriter::add(const SessionSamples& samples) {
  const std::span<const std::int32_t> codes(samples.codes);
  if (codes.empty()) return {};
  const auto payload = samples_payload(samples.first_frame, samples.time_ns, codes);
  return append(sealed_block(BlockType::samples, payload), kFreeOfTicks);
}

Result<void> SessionWriter::add(const SessionCommand& command) {
  return append(sealed_block(BlockType::command, command_payload(command)), kFreeOfNotes);
}

Result<void> SessionWriter::add(const SessionLoss& loss) {
  return append(sealed_block(BlockType::loss, loss_payload(loss)), kFreeOfLosses);
}

Result<void> SessionWriter::add(const SessionEvent& event) {
  return append(sealed_block(BlockType::event, event_payload(event)), kFreeOfNotes);
}

Result<void> SessionWriter::add(const SessionChange& change) {
  const auto payload = change_payload(change);
  TACTO_TRY(payload);
  return append(sealed_block(BlockType::change, *payload), kFreeOfNotes);
}

Result<void> SessionWriter::sync() {
  return fdatasync(descriptor_) == 0 ? Result<void>{} : unwritable_session(path_, errno);
}

Result<void> SessionWriter::close(const SessionEnd& end) {
  if (const auto done = append(sealed_block(BlockType::end, end_payload(end)), 0); !done) return done;
  [[maybe_unused]] const int given_back = ftruncate(descriptor_, size_);  // the reserved room
  if (const auto done = sync(); !done) return done;
  ::close(std::exchange(descriptor_, -1));
  return {};
}

}  // namespace tacto::schema
