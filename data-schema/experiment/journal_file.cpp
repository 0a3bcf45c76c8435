// SPDX-License-Identifier: GPL-3.0-or-later
#include <filesystem>
#include <system_error>

#include "data-schema/experiment/journal.hpp"
#include "data-schema/files/files.hpp"

namespace tacto::schema {
namespace {

constexpr std::string_view kJournalEnding = ".trials.jsonl";

}  // namespace

std::string run_stem(const std::string& run) {
  return run.ends_with(kJournalEnding) ? run.substr(0, run.size() - kJournalEnding.size()) : run;
}

std::string journal_path(const std::string& run) {
  return run_stem(run) + std::string(kJournalEnding);
}

Result<JournalFile> JournalFile::create(const std::string& path) {
  if (is_file(path))
    return fail(ErrorKind::usage, "exists already: this participant has begun", path,
                "continue with 'experiment resume', or choose another --participant");
  auto file = EventFile::create(path);
  TACTO_TRY(file);
  TACTO_TRY(sync_path(folder_of(path)));
  return JournalFile(std::move(*file), path, 0);
}

Result<JournalFile> JournalFile::resume(const std::string& path, Journal& journal) {
  TACTO_TRY(check_readable(path));
  auto file = EventFile::lock(path);
  if (!file && file.error().kind == ErrorKind::unsuitable)
    return fail(ErrorKind::unsuitable, "another process runs this participant", path, "end it first");
  TACTO_TRY(file);
  auto read = read_journal(path);
  TACTO_TRY(read);
  std::error_code failed;
  std::filesystem::resize_file(path, read->sound_bytes, failed);
  if (failed) return fail(ErrorKind::cannot_write, "cannot be shortened: " + failed.message(), path);
  journal = std::move(*read);
  return JournalFile(std::move(*file), path, journal.entries.size());
}

Result<void> JournalFile::append(const JournalEntry& entry) {
  TACTO_TRY(file_.append(journal_line(entry, lines_ + 1)));
  ++lines_;
  return sync_path(path_);
}

}  // namespace tacto::schema
