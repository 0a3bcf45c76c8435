// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/files/files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <system_error>
#include <vector>

#include "data-schema/base/sha256.hpp"
#include "data-schema/files/event_file.hpp"
#include "data-schema/files/leftover_files.hpp"
#include "data-schema/files/pending_names.hpp"

namespace tacto::schema {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kManyFiles = 16;
constexpr std::size_t kLongestBeginning = 256;

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using OpenFile = std::unique_ptr<std::FILE, CloseFile>;

std::string reason(int error_number) {
  return std::generic_category().message(error_number);
}

tl::unexpected<Error> unreadable(const std::string& path, int error_number) {
  if (error_number == ENOENT)
    return fail(ErrorKind::not_found, "there is no such file", path, "check its name and its folder");
  return fail(ErrorKind::not_found, "cannot be read: " + reason(error_number), path);
}

// A pipe, a terminal or a device may never end: it is not opened.
Result<void> check_regular(const std::string& path) {
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  if (fs::is_directory(status)) return fail(ErrorKind::not_found, "is a folder, not a file", path);
  if (fs::exists(status) && !fs::is_regular_file(status))
    return fail(ErrorKind::not_found, "is not a regular file", path, "write it to a file first");
  return {};
}

// Also does not wait if one takes the name in between.
Result<OpenFile> opened(const std::string& path) {
  TACTO_TRY(check_regular(path));
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (descriptor < 0) return unreadable(path, errno);
  OpenFile file(fdopen(descriptor, "rb"));
  if (file) return file;
  const int why = errno;
  close(descriptor);
  return unreadable(path, why);
}

// Passes the file to `take` in parts.
template <class Take>
Result<void> for_each_piece(const std::string& path, Take take) {
  const auto file = opened(path);
  TACTO_TRY(file);
  std::vector<char> piece(std::size_t{1} << 17);  // stays in the cache
  for (std::size_t got = 1; got > 0;) {
    got = std::fread(piece.data(), 1, piece.size(), file->get());
    take(std::string_view(piece.data(), got));
  }
  if (std::ferror(file->get()) != 0) return unreadable(path, errno);
  return {};
}

tl::unexpected<Error> unwritable(const std::string& path, int error_number) {
  return fail(ErrorKind::cannot_write, "cannot be written: " + reason(error_number), path);
}

Result<void> check_target(const fs::path& path) {
  std::error_code ignored;
  if (path.filename().empty() || fs::is_directory(path, ignored))
    return fail(ErrorKind::cannot_write, "is a folder, not a file", path.string());
  return {};
}

Result<void> write_all(const std::string& temporary, const std::string& path, std::string_view content) {
  std::FILE* const file = std::fopen(temporary.c_str(), "wbe");
  if (file == nullptr) return unwritable(path, errno);
  const bool whole = std::fwrite(content.data(), 1, content.size(), file) == content.size();
  const int error_number = errno;
  if (std::fclose(file) != 0) return unwritable(path, errno);
  return whole ? Result<void>{} : unwritable(path, error_number);
}

Result<void> sync(const std::string& temporary, const std::string& path) {
  const int file = open(temporary.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return unwritable(path, errno);
  const int failed = fsync(file) == 0 ? 0 : errno;
  close(file);
  return failed == 0 ? Result<void>{} : unwritable(path, failed);
}

tl::unexpected<Error> taken(const std::string& path) {
  return fail(ErrorKind::usage, "exists already, and is not overwritten", path,
              "choose another name, or replace it with --force");
}

// Some file systems cannot refuse to replace; there the name is checked before.
Result<void> move(const std::string& temporary, const std::string& path, Existing existing) {
  const unsigned flags = existing == Existing::keep ? RENAME_NOREPLACE : 0;
  int failed = renameat2(AT_FDCWD, temporary.c_str(), AT_FDCWD, path.c_str(), flags) == 0 ? 0 : errno;
  if (failed == EINVAL || failed == ENOSYS) {
    std::error_code ignored;
    const bool kept = existing == Existing::keep && fs::exists(path, ignored);
    failed = kept ? EEXIST : std::rename(temporary.c_str(), path.c_str()) == 0 ? 0 : errno;
  }
  if (failed == EEXIST) return taken(path);
  return failed == 0 ? Result<void>{} : unwritable(path, failed);
}

// Syncs a whole file system at once: for many files that is much faster than syncing each.
Result<void> sync_folder(const std::string& temporary, const std::string& path) {
  const int file = open(temporary.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return unwritable(path, errno);
  const int failed = syncfs(file) == 0 ? 0 : errno;
  close(file);
  return failed == 0 ? Result<void>{} : unwritable(path, failed);
}

}  // namespace

Result<void> check_readable(const std::string& path) {
  const auto file = opened(path);
  return file ? Result<void>{} : forward_error(file);
}

// A path that cannot be resolved is compared as text.
std::string canonical_path(const std::string& path) {
  std::error_code failed;
  const fs::path absolute = fs::absolute(path, failed);
  const fs::path resolved = fs::weakly_canonical(absolute, failed);
  return (failed ? absolute.lexically_normal() : resolved).string();
}

bool same_file(const std::string& a, const std::string& b) {
  return canonical_path(a) == canonical_path(b);
}

Result<FilesBelow> files_below(const std::string& folder) {
  const auto closed = [](const std::string& path, const std::error_code& why) {
    return Error{ErrorKind::not_found, "the folder cannot be read: " + why.message(), path,
                 "check its name and its permissions"};
  };
  FilesBelow below;
  std::error_code failed, ignored;
  fs::recursive_directory_iterator at(folder, failed);
  for (; !failed && at != fs::recursive_directory_iterator(); at.increment(failed)) {
    const bool hidden = at->path().filename().string().starts_with(".");
    if (!hidden && !at->is_directory(ignored)) below.files.push_back(at->path().string());
    std::error_code refused;  // otherwise the iteration would end there, without the rest
    if (!hidden && at->is_directory(ignored) && !at->is_symlink(ignored))
      fs::directory_iterator(at->path(), refused);
    if (refused) below.unreadable.push_back(closed(at->path().string(), refused));
    if (hidden || refused) at.disable_recursion_pending();
  }
  if (failed) return tl::unexpected(closed(folder, failed));
  std::ranges::sort(below.files);
  return below;
}

bool is_file(const std::string& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

Result<std::string> read_file(const std::string& path) {
  std::string text;
  const auto done = for_each_piece(path, [&](std::string_view piece) { text += piece; });
  return done ? Result<std::string>(std::move(text)) : forward_error(done);
}

Result<std::string> sha256_of_file(const std::string& path) {
  Sha256 sum;
  const auto done = for_each_piece(path, [&](std::string_view piece) { sum.add(piece); });
  return done ? Result<std::string>(sum.hexadecimal()) : forward_error(done);
}

std::string sha256_of(std::string_view text) {
  Sha256 sum;
  sum.add(text);
  return sum.hexadecimal();
}

// A link without a target has the name, too.
Result<void> check_output_free(const std::string& path, Existing existing) {
  std::error_code ignored;
  const bool there = fs::exists(fs::symlink_status(path, ignored));
  return there && existing == Existing::keep ? taken(path) : Result<void>{};
}

Result<void> check_wav_free(const std::string& path, Existing existing) {
  std::error_code ignored;
  for (const char* ending : {".json", ".events.jsonl"})
    if (fs::exists(fs::path(path).replace_extension(ending), ignored))
      return fail(ErrorKind::usage, "this name belongs to a recording or texture", path,
                  "choose another name");
  return check_output_free(path, existing);
}

Result<void> check_table_free(const std::string& path, Existing existing,
                              const std::function<bool(std::string_view beginning)>& ours) {
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return check_output_free(path, existing);
  const auto file = opened(path);
  TACTO_TRY(file);
  std::string line(kLongestBeginning, '\0');
  line.resize(std::fread(line.data(), 1, line.size(), file->get()));
  const bool empty = line.empty();
  if (line.starts_with("#!")) line.erase(0, line.find('\n') + 1);  // of a script
  if (empty || ours(line.substr(0, line.find('\n')))) return check_output_free(path, existing);
  return fail(ErrorKind::usage, "has other contents and is not overwritten", path,
              "choose another name, or remove it first");
}

void remove_pending_files() noexcept {
  pending_names().remove_all();
}

Result<void> check_sum(const std::string& path, const std::string& sha256) {
  const auto is = sha256_of_file(path);
  TACTO_TRY(is);
  if (*is == sha256) return {};
  return fail(ErrorKind::malformed, "does not match its sidecar: its SHA-256 differs", path,
              "restore the right file, or make it again; 'tactograph validate' lists the faults");
}

PendingFiles::~PendingFiles() {
  for (const Pending& file : pending_) {
    std::remove(file.temporary.c_str());
    pending_names().forget(file.name);
  }
}

Result<std::string> PendingFiles::add(const std::string& path) {
  TACTO_TRY(check_target(path));
  TACTO_TRY(folders_.make_for(path));
  remove_leftovers_of_file(path);
  const std::string temporary = temporary_name_for(path);
  PendingName* const name = pending_names().keep(temporary);
  pending_.push_back({temporary, path, name});
  auto begun = write_all(temporary, path, "");
  if (!begun && existing_folder_of(path) != folder_of(path)) {  // another output's failure removed it again
    TACTO_TRY(folders_.make_for(path));
    begun = write_all(temporary, path, "");
  }
  TACTO_TRY(begun);
  return temporary;
}

Result<void> PendingFiles::write(const std::string& path, std::string_view content) {
  const auto temporary = add(path);
  return temporary ? write_all(*temporary, path, content) : forward_error(temporary);
}

Result<void> PendingFiles::sync_all() const {
  std::string folder_synced;
  for (const Pending& file : pending_) {
    const std::string folder = fs::path(file.path).parent_path().string() + "/";
    if (folder == folder_synced) continue;
    const bool many = pending_.size() > kManyFiles;
    auto synced = many ? sync_folder(file.temporary, file.path) : sync(file.temporary, file.path);
    if (!synced) return synced;
    if (many) folder_synced = folder;
  }
  return {};
}

Result<void> PendingFiles::commit(Existing existing, Sync sync) {
  if (sync == Sync::now) TACTO_TRY(sync_all());
  std::vector<std::string> appeared;
  while (!pending_.empty()) {
    const Pending& file = pending_.front();
    if (auto moved = move(file.temporary, file.path, existing); !moved) {
      if (existing == Existing::keep)
        for (const std::string& path : appeared) std::remove(path.c_str());
      return moved;
    }
    appeared.push_back(file.path);
    pending_names().forget(file.name);
    pending_.erase(pending_.begin());
  }
  return {};
}

Result<void> check_changeable(const std::string& path) {
  constexpr auto kAnyWrite = fs::perms::owner_write | fs::perms::group_write | fs::perms::others_write;
  std::error_code failed;
  const auto status = fs::status(path, failed);
  const bool read_only = !failed && (status.permissions() & kAnyWrite) == fs::perms::none;
  if (!read_only && access(path.c_str(), W_OK) == 0) return {};
  return fail(ErrorKind::cannot_write, read_only ? "is read-only" : "must not be written (no permission)",
              path, "change its permissions (chmod u+w), or use a copy");
}

Result<void> check_stem(const std::string& stem) {
  const std::string name = fs::path(stem).filename().string();
  std::error_code ignored;
  if (name.empty() || name == "." || name == ".." || fs::is_directory(stem, ignored))
    return fail(ErrorKind::usage, fmt::format("'{}' is not a file name", stem), {},
                "give one, for example FOLDER/NAME");
  if (std::ranges::any_of(name, [](char c) { return c >= 0 && c < ' '; }))
    return fail(ErrorKind::usage, "the name of the output contains control characters", {},
                "choose another name");
  return {};
}

std::string stem_of(const std::string& name, std::string_view suffix) {
  for (const std::string_view extension : {".json", ".wav", ""}) {
    const std::string ending = std::string(suffix) + std::string(extension);
    if (name.size() > ending.size() && name.ends_with(ending))
      return name.substr(0, name.size() - ending.size());
  }
  return name;
}

}  // namespace tacto::schema
