// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/session_writer.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "data-schema/session_blocks.hpp"

namespace tacto::schema {
namespace {

tl::unexpected<Error> unwritable_session(const std::string& path, int error_number) {
  if (error_number == EEXIST)
    return fail(Fault::usage, "is there already, and is not overwritten", path, "choose another name");
  return fail(Fault::cannot_write, "can't be written: " + std::generic_category().message(error_number),
              path);
}

}  // namespace

SessionWriter::SessionWriter(SessionWriter&& other) noexcept
    : path_(std::move(other.path_)), descriptor_(std::exchange(other.descriptor_, -1)), size_(other.size_) {}

SessionWriter& SessionWriter::operator=(SessionWriter&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(descriptor_, other.descriptor_);
  std::swap(size_, other.size_);
  return *this;
}

SessionWriter::~SessionWriter() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Result<SessionWriter> SessionWriter::create(const std::string& path, const SessionHeader& header) {
  const auto text = session_header_text(header);
  if (!text) return forward_error(text);
  const int opened = open(path.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
  if (opened < 0) return unwritable_session(path, errno);
  SessionWriter writer(path, opened);
  flock(opened, LOCK_EX | LOCK_NB);  // held by nobody else: the file is new
  if (const auto begun = writer.append(sealed_block(BlockType::header, *text)); !begun) {
    unlink(path.c_str());
    return forward_error(begun);
  }
  return writer;
}

// Half a block would hide what comes after it.
Result<void> SessionWriter::append(const std::string& block) {
  const ssize_t done = pwrite(descriptor_, block.data(), block.size(), size_);
  if (done == static_cast<ssize_t>(block.size())) {
    size_ += done;
    return {};
  }
  const int why = done < 0 ? errno : ENOSPC;
  [[maybe_unused]] const int cut = ftruncate(descriptor_, size_);
  return unwritable_session(path_, why);
}

Result<void> SessionWriter::add(std::span<const SessionTick> ticks) {
  for (; !ticks.empty(); ticks = ticks.subspan(std::min(ticks.size(), kMostBlockTicks))) {
    const auto part = ticks.first(std::min(ticks.size(), kMostBlockTicks));
    if (const auto done = append(sealed_block(BlockType::ticks, ticks_payload(part))); !done) return done;
  }
  return {};
}

Result<void> SessionWriter::add(const SessionCommand& command) {
  return append(sealed_block(BlockType::command, command_payload(command)));
}

Result<void> SessionWriter::add(const SessionLoss& loss) {
  return append(sealed_block(BlockType::loss, loss_payload(loss)));
}

Result<void> SessionWriter::add(const SessionEvent& event) {
  return append(sealed_block(BlockType::event, event_payload(event)));
}

Result<void> SessionWriter::sync() {
  return fdatasync(descriptor_) == 0 ? Result<void>{} : unwritable_session(path_, errno);
}

Result<void> SessionWriter::close(const SessionEnd& end) {
  if (const auto done = append(sealed_block(BlockType::end, end_payload(end))); !done) return done;
  if (const auto done = sync(); !done) return done;
  ::close(std::exchange(descriptor_, -1));
  return {};
}

}  // namespace tacto::schema
