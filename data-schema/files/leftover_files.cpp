// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/files/leftover_files.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <iterator>
#include <map>
#include <mutex>
#include <optional>
#include <string_view>
#include <system_error>

#include "data-schema/files/process_mark.hpp"

namespace tacto::schema {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kTemporaryEnding = ".tmp";
constexpr std::size_t kMostTargetBytes = 200;  // a file system's names have 255, and the mark needs 45

std::string cut_target(const std::string& filename) {
  return filename.substr(0, kMostTargetBytes);
}

bool is_whole_number(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

// ".TARGET.MARK-N.tmp" in its parts.
struct TemporaryName {
  std::string target;
  std::optional<ProcessMark> mark;  // none where an older version wrote ".TARGET.PID.N.tmp"
};

// Returns the part behind the last dot; `name` keeps the part before it.
std::string_view take_ending(std::string_view& name) {
  const auto dot = name.rfind('.');
  if (dot == std::string_view::npos) return {};
  const std::string_view ending = name.substr(dot + 1);
  name = name.substr(0, dot);
  return ending;
}

std::optional<TemporaryName> parse_temporary(std::string_view name) {
  if (!name.starts_with('.') || !name.ends_with(kTemporaryEnding)) return std::nullopt;
  name = name.substr(1, name.size() - 1 - kTemporaryEnding.size());
  const std::string_view last = take_ending(name);
  const auto hyphen = last.rfind('-');
  if (hyphen != std::string_view::npos && is_whole_number(last.substr(hyphen + 1)))
    if (auto mark = parse_mark(last.substr(0, hyphen))) return TemporaryName{std::string(name), mark};
  if (is_whole_number(last) && is_whole_number(take_ending(name)) && !name.empty())
    return TemporaryName{std::string(name), std::nullopt};
  return std::nullopt;
}

std::optional<Leftover> leftover_at(const fs::path& path) {
  const auto name = parse_temporary(path.filename().native());
  struct stat status {};
  if (!name || lstat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
  const Liveness liveness = name->mark ? liveness_of(*name->mark, status.st_mtime) : Liveness::unknown;
  if (liveness == Liveness::runs) return std::nullopt;
  return Leftover{path.string(), name->target, static_cast<std::uint64_t>(status.st_size),
                  liveness == Liveness::ended};
}

// "oak" has "oak.wav" and "oak-01.texture.wav", not "oak-table.wav".
bool is_of_stem(std::string_view target, std::string_view stem) {
  if (!target.starts_with(stem)) return false;
  target.remove_prefix(stem.size());
  if (target.starts_with('-'))
    target.remove_prefix(std::min(target.find_first_not_of("0123456789", 1), target.size()));
  return target.starts_with('.');
}

fs::path folder_with(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

}  // namespace

std::string temporary_name_for(const std::string& path) {
  static std::atomic<unsigned> count{0};
  const fs::path target(path);
  const std::string name = fmt::format(".{}.{}-{}{}", cut_target(target.filename().string()),
                                       text_of(own_mark()), count++, kTemporaryEnding);
  return (target.parent_path() / name).string();
}

std::vector<Leftover> leftovers_in(const std::string& folder) {
  std::vector<Leftover> found;
  std::error_code failed;
  for (fs::directory_iterator entry(folder, failed), end; !failed && entry != end; entry.increment(failed))
    if (auto leftover = leftover_at(entry->path())) found.push_back(std::move(*leftover));
  std::ranges::sort(found, {}, &Leftover::path);
  return found;
}

std::vector<Leftover> leftovers_of(const std::string& stem) {
  const fs::path path(stem);
  auto found = leftovers_in(folder_with(path).string());
  const std::string name = cut_target(path.filename().string());
  std::erase_if(found, [&](const Leftover& one) { return !is_of_stem(one.target, name); });
  return found;
}

std::vector<Leftover> remove_ended(const std::vector<Leftover>& leftovers) {
  std::vector<Leftover> removed;
  std::ranges::copy_if(leftovers, std::back_inserter(removed),
                       [](const Leftover& one) { return one.ended && unlink(one.path.c_str()) == 0; });
  return removed;
}

void remove_leftovers_of_file(const std::string& path) {
  static std::mutex alone;
  static auto& by_folder = *new std::map<std::string, std::vector<Leftover>>;  // as pending_names()
  const fs::path target(path);
  const std::string folder = folder_with(target).string();
  const std::lock_guard lock(alone);
  const auto known = by_folder.find(folder);
  auto& leftovers = known != by_folder.end() ? known->second : by_folder[folder] = leftovers_in(folder);
  if (leftovers.empty()) return;
  const std::string name = cut_target(target.filename().string());
  std::erase_if(leftovers,
                [&](const Leftover& one) { return one.target == name && !remove_ended({one}).empty(); });
}

}  // namespace tacto::schema
