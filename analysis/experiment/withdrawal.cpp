// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/experiment/withdrawal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <optional>
#include <set>
#include <sstream>
#include <string_view>

#include "data-schema/base/creation_time.hpp"
#include "data-schema/experiment/journal.hpp"
#include "data-schema/experiment/protocol.hpp"
#include "data-schema/files/event_file.hpp"
#include "data-schema/files/files.hpp"

namespace tacto::analysis {

using schema::ErrorKind;
using schema::fail;
using schema::Result;
namespace fs = std::filesystem;

namespace {

std::string withdrawn_path(const std::string& stem) {
  return stem + ".withdrawn.txt";
}

std::string outputs_path(const std::string& stem) {
  return stem + ".outputs.txt";
}

std::vector<std::string> lines_of(const std::string& path) {
  std::vector<std::string> lines;
  std::istringstream text(schema::is_file(path) ? schema::read_file(path).value_or("") : "");
  for (std::string line; std::getline(text, line);)
    if (!line.empty()) lines.push_back(line);
  return lines;
}

Result<void> write_lines(const std::string& path, const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  schema::PendingFiles pending;
  TACTO_TRY(pending.write(path, text));
  return pending.commit();
}

fs::path folder_of_study(const std::string& stem) {
  return fs::path(schema::canonical_path(stem)).parent_path();
}

// The path without links and "..", but with the file's own name, also if this is a link.
fs::path placed(const fs::path& path) {
  return fs::path(schema::canonical_path(path.parent_path().empty() ? "." : path.parent_path().string())) /
         path.filename();
}

bool is_below(const fs::path& path, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

bool is_there(const fs::path& path) {
  std::error_code failed;
  return fs::exists(fs::symlink_status(path, failed));
}

// Of a link only itself.
void add_all(const fs::path& path, std::vector<std::string>& files) {
  std::error_code failed;
  if (!is_there(path)) return;
  if (fs::is_symlink(fs::symlink_status(path, failed)) || !fs::is_directory(path, failed)) {
    files.push_back(path.string());
    return;
  }
  for (const auto& entry : fs::recursive_directory_iterator(path, failed))
    if (entry.is_symlink(failed) || !entry.is_directory(failed)) files.push_back(entry.path().string());
}

void add_logged(Withdrawal& withdrawal) {
  const fs::path folder = folder_of_study(withdrawal.stem);
  for (const std::string& line : lines_of(outputs_path(withdrawal.stem))) {
    const fs::path path = placed(folder / line);
    std::error_code failed;
    if (!is_there(path) || fs::is_directory(fs::symlink_status(path, failed))) continue;
    (is_below(path, folder) ? withdrawal.files : withdrawal.outside).push_back(path.string());
  }
}

// Without the link, the answers behind it would be left where they are hard to find.
Result<void> check_no_links(const std::vector<std::string>& files) {
  for (const std::string& file : files) {
    std::error_code failed;
    if (!fs::is_symlink(fs::symlink_status(file, failed))) continue;
    return fail(ErrorKind::unsuitable, "is a symbolic link to " + schema::canonical_path(file), file,
                "delete what it names and the link yourself, or move it here, then withdraw again");
  }
  return {};
}

// Neither a letter nor a digit is beside it.
bool has_word(std::string_view text, std::string_view word) {
  const auto is_part = [&](std::size_t i) {
    return i < text.size() && std::isalnum(static_cast<unsigned char>(text[i])) != 0;
  };
  for (auto at = text.find(word); at != std::string_view::npos; at = text.find(word, at + 1))
    if ((at == 0 || !is_part(at - 1)) && !is_part(at + word.size())) return true;
  return false;
}

// Searches a study's folder for names and tables with the code of a participant.
class CodeSearch {
 public:
  explicit CodeSearch(const Withdrawal& withdrawal)
      : folder_(folder_of_study(withdrawal.stem)),
        code_(withdrawal.participant),
        names_{"sub-" + code_, fs::path(withdrawal.stem).filename().string() + "-" + code_},
        known_{placed(schema::protocol_path(withdrawal.stem)), placed(schema::key_path(withdrawal.stem))} {
    for (const std::string& file : withdrawal.files)
      if (is_there(file)) known_.insert(placed(file));
  }

  Leftovers search() {
    Leftovers left;
    std::error_code failed;
    const fs::recursive_directory_iterator end;
    fs::recursive_directory_iterator at(folder_, fs::directory_options::skip_permission_denied, failed);
    for (std::size_t entries = 0; !failed && at != end; at.increment(failed)) {
      if (++entries > kMostEntries || read_bytes_ > kMostReadBytes) break;
      std::error_code broken_link;
      const bool folder = at->is_directory(broken_link) && !at->is_symlink(broken_link);
      if (!(folder ? is_named(at->path()) && !holds_known(at->path()) : is_left(*at))) continue;
      left.paths.push_back(at->path().string());
      if (folder) at.disable_recursion_pending();
    }
    left.complete = !failed && at == end;
    std::ranges::sort(left.paths);
    return left;
  }

 private:
  static constexpr std::size_t kMostEntries = 100'000;
  static constexpr std::uintmax_t kLargestTableBytes = 4'000'000, kMostReadBytes = 500'000'000;

  bool is_named(const fs::path& path) const {
    const std::string below = path.lexically_relative(folder_).string();
    return std::ranges::any_of(names_, [&](const std::string& name) { return has_word(below, name); });
  }
  bool holds_known(const fs::path& folder) const {
    const auto first = known_.lower_bound(folder);
    return first != known_.end() && is_below(*first, folder);
  }
  bool is_left(const fs::directory_entry& entry) {
    return !known_.contains(entry.path()) && (is_named(entry.path()) || is_table_with_code(entry));
  }
  bool is_table_with_code(const fs::directory_entry& entry) {
    std::error_code failed;
    const std::string ending = entry.path().extension().string();
    if (ending != ".csv" && ending != ".tsv" && ending != ".json") return false;
    if (entry.is_symlink(failed) || !entry.is_regular_file(failed)) return false;
    const std::uintmax_t bytes = entry.file_size(failed);
    if (failed || bytes > kLargestTableBytes) return false;
    read_bytes_ += bytes;
    return has_word(schema::read_file(entry.path().string()).value_or(""), code_);
  }

  fs::path folder_;
  std::string code_;
  std::array<std::string, 2> names_;
  std::set<fs::path> known_;
  std::uintmax_t read_bytes_ = 0;
};

Result<void> remove_file(const std::string& file) {
  std::error_code failed;
  fs::remove(file, failed);
  if (!failed) return {};
  return fail(ErrorKind::cannot_write, "can't be deleted: " + failed.message(), file,
              "change its permissions, then withdraw again");
}

// Folders of the run that are now empty.
void remove_folders(const std::string& run) {
  std::error_code failed;
  std::vector<fs::path> folders = {run};
  for (const auto& entry : fs::recursive_directory_iterator(run, failed))
    if (entry.is_directory(failed) && !entry.is_symlink(failed)) folders.push_back(entry.path());
  std::ranges::sort(folders, std::greater());
  for (const fs::path& folder : folders) fs::remove(folder, failed);
}

// Folders sub-P07/beh of exports that are now empty; the folder of the export itself stays.
void remove_subject_folders(const std::string& stem) {
  const fs::path study_folder = folder_of_study(stem);
  for (const std::string& line : lines_of(outputs_path(stem))) {
    const fs::path table = placed(study_folder / line), beh = table.parent_path(),
                   subject = beh.parent_path();
    const std::string name = subject.filename().string();
    if (!name.starts_with("sub-") || !table.filename().string().starts_with(name + "_task-") ||
        !is_below(subject, study_folder))
      continue;
    std::error_code failed;  // of a folder with files
    fs::remove(beh, failed);
    fs::remove(subject, failed);
  }
}

}  // namespace

bool is_withdrawn(const std::string& stem, const std::string& participant) {
  return std::ranges::any_of(lines_of(withdrawn_path(stem)),
                             [&](const std::string& line) { return line.ends_with("\t" + participant); });
}

Result<void> check_not_withdrawn(const std::string& stem, const std::string& participant) {
  if (!is_withdrawn(stem, participant)) return {};
  return fail(ErrorKind::unsuitable, fmt::format("{} has withdrawn", participant), withdrawn_path(stem),
              "choose another --participant");
}

Result<void> log_outputs(const std::string& stem, const std::vector<std::string>& files) {
  std::vector<std::string> lines = lines_of(outputs_path(stem));
  const fs::path folder = folder_of_study(stem);
  for (const std::string& file : files) {
    const fs::path path = placed(file);
    const std::string line =
        is_below(path, folder) ? path.lexically_relative(folder).string() : path.string();
    if (std::ranges::find(lines, line) == lines.end()) lines.push_back(line);
  }
  return write_lines(outputs_path(stem), lines);
}

Result<Withdrawal> plan_withdrawal(const std::string& study, const std::string& participant) {
  TACTO_TRY(schema::check_participant(participant));
  Withdrawal withdrawal{schema::stem_of(study, ".protocol"), participant, {}, {}};
  TACTO_TRY(schema::check_readable(schema::protocol_path(withdrawal.stem)));
  const std::string run = withdrawal.stem + "-" + participant;
  if (schema::is_file(schema::protocol_path(run)))
    return fail(ErrorKind::unsuitable, "is a study, with files of the same names as those of the participant",
                schema::protocol_path(run), "move it to another folder");
  for (const std::string& path : {schema::journal_path(run), run + ".trials.tsv", run})
    add_all(path, withdrawal.files);
  if (withdrawal.files.empty() && !is_withdrawn(withdrawal.stem, participant))
    return fail(ErrorKind::not_found, "no participant with this code", run,
                "the code is that of STUDY-CODE.trials.jsonl");
  add_logged(withdrawal);
  TACTO_TRY(check_no_links(withdrawal.files));
  std::ranges::sort(withdrawal.files);
  return withdrawal;
}

Leftovers find_leftovers(const Withdrawal& withdrawal) {
  return CodeSearch(withdrawal).search();
}

Result<void> withdraw(const Withdrawal& withdrawal) {
  const std::string run = withdrawal.stem + "-" + withdrawal.participant;
  std::optional<schema::EventFile> journal;
  if (schema::is_file(schema::journal_path(run))) {
    auto locked = schema::EventFile::lock(schema::journal_path(run));
    if (!locked && locked.error().kind == ErrorKind::unsuitable)
      return fail(ErrorKind::unsuitable, "another process runs this participant", schema::journal_path(run),
                  "end it first");
    TACTO_TRY(locked);
    journal.emplace(std::move(*locked));
  }
  if (!is_withdrawn(withdrawal.stem, withdrawal.participant)) {
    std::vector<std::string> lines = lines_of(withdrawn_path(withdrawal.stem));
    lines.push_back(schema::creation_time() + "\t" + withdrawal.participant);
    TACTO_TRY(write_lines(withdrawn_path(withdrawal.stem), lines));
  }
  for (const std::string& file : withdrawal.files) TACTO_TRY(remove_file(file));
  remove_folders(run);
  remove_subject_folders(withdrawal.stem);
  if (!schema::is_file(outputs_path(withdrawal.stem))) return {};
  return write_lines(outputs_path(withdrawal.stem), withdrawal.outside);
}

}  // namespace tacto::analysis
