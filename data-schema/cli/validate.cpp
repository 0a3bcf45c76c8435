// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/check/check.hpp"
#include "data-schema/cli/describe.hpp"
#include "data-schema/cli/verbs.hpp"
#include "data-schema/report/progress.hpp"

namespace tacto::schema {
namespace {

struct ValidateOptions {
  std::vector<std::string> names;
};

// Every file of every name, checked.
struct Outcome {
  std::vector<cli::Report> files, faults;
  ErrorKind worst = ErrorKind::malformed;  // an unreadable file counts more than a faulty one
};

Result<void> check(const StoredFile& file, Outcome& outcome) {
  cli::Progress progress("checking " + file.path);
  const auto checked = check_file(file, [&](double fraction) { progress.update(fraction); });
  TACTO_TRY(checked);
  warn_of_unknown(file.path, *checked);
  cli::Report& row = outcome.files.emplace_back(report_of(file.kind, file.path, ""));
  row.add("valid", checked->findings.empty());
  for (const auto& [where, what] : checked->findings)
    outcome.faults.push_back(cli::Report().add("where", where).add("what", what));
  return {};
}

// A file that cannot be read, is not JSON, or is of an unknown kind is a fault like any other: the other
// files are still checked.
void put_unreadable(const std::string& name, const Error& error, Outcome& outcome) {
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

Result<cli::Report> run_validate(const ValidateOptions& options) {
  Outcome outcome;
  for (const std::string& name : options.names) check_name(name, outcome);
  cli::Report report;
  report.add("valid", outcome.faults.empty()).add("files", std::move(outcome.files));
  if (outcome.faults.empty()) return report;
  report.add("faults", std::move(outcome.faults)).ends_with(outcome.worst);
  return report;
}

cli::Action declare_validate(CLI::App& app) {
  auto options = std::make_shared<ValidateOptions>();
  app.add_option("FILE", options->names,
                 "Files to check, by stem (all files under it), in full, or a preset's name")
      ->required();
  return [options] { return run_validate(*options); };
}

}  // namespace

const cli::Verb kValidateVerb{
    "validate", "Check files (schema, checksum, samples), and list every fault",
    "tactograph validate oak\n  tactograph validate oak.texture.json bench.transducer.json",
    declare_validate};

}  // namespace tacto::schema
