// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/check/check.hpp"

#include "data-schema/check/check_parts.hpp"
#include "data-schema/results/results.hpp"
#include "data-schema/session/session_netcdf.hpp"
#include "data-schema/transducer/transducer.hpp"

namespace tacto::schema {
namespace {

Checked one_finding(const std::string& where, const std::string& what) {
  return {{{where, what}}, {}};
}

// Errors that end the check: a missing or a newer file cannot be checked.
bool ends_the_check(const Error& error) {
  return error.kind == ErrorKind::not_found || error.kind == ErrorKind::unsupported_version ||
         error.kind == ErrorKind::internal;
}

Result<Checked> judged(const Error& error) {
  if (ends_the_check(error)) return tl::unexpected(error);
  return one_finding(error.where, error.what);
}

// Checks that a schema cannot express: read_transducer does them.
std::vector<Finding> check_transducer(const std::string& path) {
  const auto transducer = read_transducer(path);
  if (transducer) return {};
  return {{transducer.error().where, transducer.error().what}};
}

std::vector<Finding> check_results(const std::string& path) {
  const auto results = read_results(path);
  if (results) return {};
  return {{results.error().where, results.error().what}};
}

Result<Checked> check_document(const StoredFile& file, const Progress& progress) {
  const auto violations = violations_of(file.path);
  if (!violations) return judged(violations.error());
  Checked checked;
  for (const auto& [pointer, what] : *violations)
    checked.findings.push_back({file.path + "#" + pointer, what});
  if (!checked.findings.empty()) return checked;
  const auto document = open_document(file.path, kind_name(file.kind));
  if (!document) return judged(document.error());
  checked.newer_version = document->newer_version;
  if (file.kind == FileKind::recording) checked.findings = check_recording(file.path, *document, progress);
  if (file.kind == FileKind::scene) checked.findings = check_scene(file.path, *document);
  if (file.kind == FileKind::transducer) checked.findings = check_transducer(file.path);
  if (file.kind == FileKind::results) checked.findings = check_results(file.path);
  if (file.kind == FileKind::texture) checked.findings = check_texture(file.path, *document, progress);
  return checked;
}

Result<Checked> check_preset(const std::string& name) {
  const auto transducer = read_transducer(name);
  return transducer ? Checked{} : judged(transducer.error());
}

}  // namespace

Result<Checked> check_file(const StoredFile& file, const Progress& progress) {
  if (file.kind == FileKind::transducer && !file.path.ends_with(".json")) return check_preset(file.path);
  if (file.kind == FileKind::session) {
    auto checked = check_session(file.path);
    return checked ? checked : judged(checked.error());
  }
  if (file.kind == FileKind::session_table) {
    const auto table = read_session_table(file.path);
    return table ? Checked{} : judged(table.error());
  }
  if (file.kind != FileKind::spectrogram) return check_document(file, progress);
  auto checked = check_spectrogram(file.path);
  return checked ? checked : judged(checked.error());
}

}  // namespace tacto::schema
