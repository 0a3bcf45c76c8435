// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/corpus/corpus_unit.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <string_view>

#include "data-schema/files/files.hpp"

namespace tacto::analysis {
namespace {

namespace fs = std::filesystem;
using schema::Result;

constexpr const char* kFailure = "failure.txt";
constexpr std::size_t kSumDigits = 64;
constexpr std::string_view kBetween = "  ";  // of sha256sum
constexpr const char* kCode = "exit code ";

std::string key_of(const std::string& creator, const schema::CorpusStep& step, const std::string& input) {
  std::string all = "unit 1";  // another number makes every unit again
  for (const std::string& part : {creator, step.step, step.options, input}) (all += '\0') += part;
  return schema::sha256_of(all);
}

Result<void> write(const std::string& folder, const char* name, const std::string& content) {
  schema::PendingFiles pending;
  TACTO_TRY(pending.write((fs::path(folder) / name).string(), content));
  return pending.commit(schema::Existing::replace, schema::Sync::by_caller);
}

std::vector<std::string_view> text_lines(std::string_view text) {
  std::vector<std::string_view> lines;
  for (std::size_t end = 0; !text.empty(); text.remove_prefix(std::min(text.size(), end + 1))) {
    end = std::min(text.find('\n'), text.size());
    lines.push_back(text.substr(0, end));
  }
  return lines;
}

bool is_intact(const fs::path& path, std::string_view sum, fs::file_time_type sealed, bool verify) {
  std::error_code failed;
  const auto changed = fs::last_write_time(path, failed);
  if (failed || !(verify || changed > sealed)) return !failed;
  const auto is = schema::sha256_of_file(path.string());
  return is && *is == sum;
}

// "exit code 5", then the message.
void read_failure(const std::string& path, Unit& unit) {
  unit.state = UnitState::damaged;
  const auto text = schema::read_file(path);
  if (!text || !text->starts_with(kCode)) return;
  const auto lines = text_lines(*text);
  if (lines.size() != 2) return;
  unit.state = UnitState::failed;
  unit.because = lines[1];
  unit.may_succeed = lines[0] != kCode + std::to_string(schema::exit_code(schema::ErrorKind::unsuitable));
}

}  // namespace

std::string corpus_plan_path(const std::string& study) {
  return (fs::path(study) / "plan.corpus.json").string();
}

std::string path_of(const std::string& study, const schema::CorpusRecording& recording) {
  // The plan's paths are relative to the folder itself, not to a link to it.
  return (fs::path(schema::canonical_path(study)) / recording.path).lexically_normal().string();
}

std::vector<std::string> unit_keys(const schema::CorpusPlan& plan, const schema::CorpusRecording& recording) {
  std::vector<std::string> keys;
  std::string input = fs::path(recording.path).filename().string() + '\0' + recording.sha256;
  for (const schema::CorpusStep& step : plan.steps) keys.push_back(input = key_of(plan.creator, step, input));
  return keys;
}

// Two digits of the key as a folder between keep folders short.
std::string unit_folder(const std::string& study, const std::string& key) {
  return (fs::path(study) / "units" / key.substr(0, 2) / key).string();
}

Unit read_unit(const std::string& folder, bool verify) {
  std::error_code failed;
  const fs::path sums = fs::path(folder) / kSums;
  const auto text = schema::read_file(sums.string());
  if (!text) return {fs::exists(folder, failed) ? UnitState::damaged : UnitState::missing};
  const auto sealed = fs::last_write_time(sums, failed);
  Unit unit{text->empty() || failed ? UnitState::damaged : UnitState::done};
  for (const std::string_view line : text_lines(*text)) {
    const bool is_whole =
        line.size() > kSumDigits + kBetween.size() && line.substr(kSumDigits, kBetween.size()) == kBetween;
    if (!is_whole) return {UnitState::damaged};
    const std::string name(line.substr(kSumDigits + kBetween.size()));
    const fs::path path = fs::path(folder) / name;
    if (!is_intact(path, line.substr(0, kSumDigits), sealed, verify)) return {UnitState::damaged};
    if (name == kFailure) read_failure(path.string(), unit);
    if (name == kWarnings) unit.has_warnings = true;
  }
  return unit;
}

Result<void> write_failure(const std::string& folder, schema::ErrorKind kind, const std::string& text) {
  return write(folder, kFailure, fmt::format("{}{}\n{}\n", kCode, schema::exit_code(kind), text));
}

Result<void> write_warnings(const std::string& folder, const std::vector<std::string>& warnings) {
  return write(folder, kWarnings, fmt::format("{}\n", fmt::join(warnings, "\n")));
}

Result<void> seal_unit(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code failed;
  for (fs::directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed))
    names.push_back(at->path().filename().string());
  if (failed)
    return schema::fail(schema::ErrorKind::not_found, "cannot be listed: " + failed.message(), folder);
  std::ranges::sort(names);
  std::string sums;
  for (const std::string& name : names) {
    const auto sum = schema::sha256_of_file((fs::path(folder) / name).string());
    TACTO_TRY(sum);
    sums += fmt::format("{}{}{}\n", *sum, kBetween, name);
  }
  return write(folder, kSums, sums);
}

}  // namespace tacto::analysis
