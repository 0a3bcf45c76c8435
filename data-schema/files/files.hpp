// SPDX-License-Identifier: GPL-3.0-or-later
// Files that appear whole or not at all, and their checksums.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/files/made_folders.hpp"

namespace tacto::schema {

struct PendingName;

/// Checks that a file exists and may be read. Errors: not_found, saying whether it is absent, a folder or not
/// permitted.
Result<void> check_readable(const std::string& path);

/// Whether `path` names a file (not a folder).
bool is_file(const std::string& path);

/// What is in a folder and in those below it.
struct FilesBelow {
  std::vector<std::string> files;  ///< all but folders, sorted by path
  std::vector<Error> unreadable;   ///< folders below it whose files are not in `files`
};

/// Lists a folder and those below it, except hidden names; links to folders are not followed. Errors:
/// not_found, if the folder itself cannot be read.
Result<FilesBelow> files_below(const std::string& folder);

/// The path without links and "..", as far as its folders exist: one for all spellings of a file.
std::string canonical_path(const std::string& path);

/// Whether both paths name one file, which need not exist: a, ./a, x/../a, and paths through links.
bool same_file(const std::string& a, const std::string& b);

/// Checks that a file may be changed: renaming a new file over it would succeed even if it is read-only.
/// Errors: cannot_write.
Result<void> check_changeable(const std::string& path);

/// The whole file. Only regular files are opened, here and below: reading a pipe would wait. Errors:
/// not_found (absent, a folder, a pipe or device, no permission).
Result<std::string> read_file(const std::string& path);

/// Lower-case hexadecimal SHA-256 of a file, or of text in memory. Errors: not_found.
Result<std::string> sha256_of_file(const std::string& path);
std::string sha256_of(std::string_view text);

/// Checks that a file's SHA-256 is the one in a sidecar. Errors: malformed; not_found.
Result<void> check_sum(const std::string& path, const std::string& sha256);

/// What to do with existing files that have the names of outputs. In verbs: keep, with --force replace.
enum class Existing { replace, keep };

/// Checks whether an output may have the name `path`, before any work is done. Errors: usage, if a file has
/// it already and is to be kept.
Result<void> check_output_free(const std::string& path, Existing existing);

/// The same for a sound file, which never replaces the data of a recording or texture: a file with a sidecar
/// NAME.json, or with the events of a recording that was not closed. Errors: usage.
Result<void> check_wav_free(const std::string& path, Existing existing);

/// The same for an output that replaces only its own kind: a table or page that `ours` recognises by its
/// first line, of a script the line after the interpreter's; an empty file is always replaced. Errors: usage,
/// if a file has the name and is to be kept, or has other content, which would be lost.
Result<void> check_table_free(const std::string& path, Existing existing,
                              const std::function<bool(std::string_view beginning)>& ours);

/// Removes all pending files of this process, and folders that it made and that are empty. For the handler of
/// a signal that ends it: async-signal-safe.
void remove_pending_files() noexcept;

/// Whether a commit syncs its files to disk, or the caller does it, for many commits at once.
enum class Sync { now, by_caller };

/// A set of files that are written beside their final names and renamed together at commit(). Missing folders
/// are made. After a failure all folders are as before; the destructor removes leftovers.
class PendingFiles {
 public:
  PendingFiles() = default;
  PendingFiles(const PendingFiles&) = delete;
  PendingFiles& operator=(const PendingFiles&) = delete;
  ~PendingFiles();

  /// The temporary path to write what will be `path`, in the same folder; an empty file until it is written.
  /// Errors: cannot_write, where the folder cannot be made or is read-only, or where `path` is a folder.
  Result<std::string> add(const std::string& path);
  /// add() and the content at once.
  Result<void> write(const std::string& path, std::string_view content);
  /// Syncs all to disk, unless the caller does it, then renames them in the order in which they were added.
  /// Errors: cannot_write; usage, if existing files are to be kept and a name is taken, also if it was taken
  /// a moment ago: then none of them appears.
  Result<void> commit(Existing existing = Existing::replace, Sync sync = Sync::now);

 private:
  struct Pending {
    std::string temporary, path;
    PendingName* name;
  };
  Result<void> sync_all() const;
  MadeFolders folders_;
  std::vector<Pending> pending_;
};

/// Whether files may be named after `stem`. Errors: usage, for a name that is empty, a folder, "." or "..",
/// or holds control characters.
Result<void> check_stem(const std::string& stem);

/// The stem of a stored file: "oak" and "oak.texture.json" and "oak.texture.wav" all have the stem "oak" for
/// the suffix ".texture". For plain recordings the suffix is empty.
std::string stem_of(const std::string& name, std::string_view suffix);

}  // namespace tacto::schema
