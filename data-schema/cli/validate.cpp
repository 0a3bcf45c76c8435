// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <filesystem>
#include <system_error>

#include "data-schema/check/check.hpp"
#include "data-schema/cli/describe.hpp"
#include "data-schema/cli/verbs.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/report/progress.hpp"

namespace tacto::schema {
namespace {

struct ValidateOptions {
  std::vector<std::string> names;
};

// Every file of every name, checked.
struct Outcome {
  std::vector<cli::Report> files, faults;
  std::size_t invalid = 0, others = 0;     // files; those of other programs, in folders
  ErrorKind worst = ErrorKind::malformed;  // an unreadable file counts more than a faulty one
};

Result<void> check(const StoredFile& file, Outcome& outcome) {
  cli::Progress progress("checking " + file.path);
  const auto checked = check_file(file, [&](double fraction) { progress.update(fraction); });
  TACTO_TRY(checked);
  warn_of_unknown(file.path, *checked);
  cli::Report& row = outcome.files.emplace_back(report_of(file.kind, file.path, ""));
  row.add("valid", checked->findings.empty());
  if (!checked->findings.empty()) ++outcome.invalid;
  for (const auto& [where, what] : checked->findings)
    outcome.faults.push_back(cli::Report().add("where", where).add("what", what));
  return {};
}

// A file that cannot be read, is not JSON, or is of an unknown kind is a fault like any other: the other
// files are still checked.
void put_unreadable(const std::string& name, const Error& error, Outcome& outcome) {
  ++outcome.invalid;
  outcome.files.push_back(cli::Report().add("file", name).add("kind", "unknown").add("valid", false));
  outcome.faults.push_back(cli::Report().add("where", error.where).add("what", error.what));
  if (error.kind != ErrorKind::malformed) outcome.worst = error.kind;
}

void check_name(const std::string& name, Outcome& outcome) {
  const auto files = stored_files(name);
  if (!files) return put_unreadable(name, files.error(), outcome);
  for (const StoredFile& file : *files)
    if (const auto done = check(file, outcome); !done) put_unreadable(file.path, done.error(), outcome);
}

// A recording that was not closed is checked by its stem, which gives the fault.
std::string name_to_check(const std::string& path) {
  constexpr std::string_view kJournal = ".events.jsonl";
  return path.ends_with(kJournal) ? path.substr(0, path.size() - kJournal.size()) : path;
}

// Of a JSON file without a known kind only the name or its WAV shows whose it is.
bool is_ours(const std::string& path) {
  if (path.ends_with(".height.nc") || path.ends_with(".force.nc")) return false;  // maps of scenes
  if (path.ends_with(".nc") || path.ends_with(".session") || path.ends_with(".events.jsonl")) return true;
  if (!path.ends_with(".json")) return false;
  const std::string stem = path.substr(0, path.size() - std::string_view(".json").size());
  return stored_files(path) || is_file(stem + ".wav") || has_ending_of_kind(path);
}

// All files in it and in the folders below, except hidden ones. WAVs are checked with their sidecars.
Result<void> check_folder(const std::string& folder, Outcome& outcome) {
  const auto below = files_below(folder);
  TACTO_TRY(below);
  const std::size_t before = outcome.files.size();
  for (const Error& closed : below->unreadable) put_unreadable(closed.where, closed, outcome);
  for (const std::string& path : below->files) {
    if (!is_file(path)) continue;
    if (is_ours(path))
      check_name(name_to_check(path), outcome);
    else if (!path.ends_with(".wav") || !is_file(path.substr(0, path.size() - 4) + ".json"))
      ++outcome.others;
  }
  if (outcome.files.size() > before) return {};
  return fail(ErrorKind::not_found, "contains no file of tactograph", folder, "name another folder");
}

bool is_folder(const std::string& name) {
  std::error_code ignored;
  return std::filesystem::is_directory(name, ignored);
}

Result<cli::Report> run_validate(const ValidateOptions& options) {
  Outcome outcome;
  bool folders = false;
  for (const std::string& name : options.names) {
    if (!is_folder(name)) {
      check_name(name, outcome);
      continue;
    }
    folders = true;
    if (const auto done = check_folder(name, outcome); !done) put_unreadable(name, done.error(), outcome);
  }
  cli::Report report;
  report.add("valid", outcome.faults.empty());
  if (folders)
    report.add("checked", outcome.files.size())
        .add("invalid", outcome.invalid)
        .add("of_other_programs", outcome.others);
  report.add("files", std::move(outcome.files));
  if (outcome.faults.empty()) return report;
  report.add("faults", std::move(outcome.faults)).ends_with(outcome.worst);
  return report;
}

cli::Action declare_validate(CLI::App& app) {
  auto options = std::make_shared<ValidateOptions>();
  app.add_option(
         "FILE", options->names,
         "Files to check, by stem (all files under it), in full, or a preset's name; folders, with all "
         "files of tactograph in them and below")
      ->required();
  return [options] { return run_validate(*options); };
}

}  // namespace

const cli::Verb kValidateVerb{"validate", "Check files (schema, checksum, samples), and list every fault",
                              "tactograph validate oak\n  tactograph validate oak.texture.json "
                              "bench.transducer.json\n  tactograph validate study",
                              declare_validate};

}  // namespace tacto::schema
