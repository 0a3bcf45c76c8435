// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/job/spatial_batch.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <mutex>
#include <numeric>
#include <optional>
#include <thread>

#include "data-schema/kinds/file_kind.hpp"
#include "data-schema/report/progress.hpp"
#include "spatial/job/spatial_recording.hpp"
#include "spatial/job/spatial_takes.hpp"
#include "spatial/job/texture_names.hpp"
#include "spatial/job/too_short.hpp"

namespace tacto::spatial {
namespace {

using cli::Report;
using schema::ErrorKind;
using schema::Result;

namespace fs = std::filesystem;

struct Sorted {
  std::vector<std::string> recordings, skipped;
};

// By name. A damaged sidecar is recognised by the WAV beside it, and fails with its own message.
Result<std::vector<std::string>> recordings_in(const std::string& folder) {
  std::error_code failed, ignored;
  std::vector<std::string> found;
  for (fs::directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed)) {
    if (at->path().extension() != ".json") continue;
    const std::string path = at->path().string();
    const auto files = schema::stored_files(path);
    if (files ? files->front().kind == schema::FileKind::recording
              : fs::exists(fs::path(path).replace_extension(".wav"), ignored))
      found.push_back(path);
  }
  if (failed) return schema::fail(ErrorKind::not_found, "cannot be listed: " + failed.message(), folder);
  if (found.empty()) return schema::fail(ErrorKind::unsuitable, "contains no recording", folder);
  std::ranges::sort(found);
  return found;
}

Result<std::vector<std::string>> without_folders(const std::vector<std::string>& names) {
  std::error_code ignored;
  std::vector<std::string> all;
  for (const std::string& name : names) {
    if (!fs::is_directory(name, ignored)) {
      all.push_back(name);
      continue;
    }
    const auto inside = recordings_in(name);
    TACTO_TRY(inside);
    all.insert(all.end(), inside->begin(), inside->end());
  }
  return all;
}

// Names of files of another kind are skipped; a name without a file is kept, so that it fails with its own
// message.
Sorted sorted(const std::vector<std::string>& names) {
  Sorted result;
  for (const std::string& name : names) {
    const auto files = schema::stored_files(name);
    const bool other = files && files->front().kind != schema::FileKind::recording;
    if (other)
      result.skipped.push_back(fmt::format("{} ({})", name, schema::kind_name(files->front().kind)));
    else
      result.recordings.push_back(name);
  }
  return result;
}

// Processes the recordings, `jobs` at a time; the outcomes are in the order of their names.
class Batch {
 public:
  Batch(const SpatialOptions& options, const std::vector<std::string>& names,
        const std::vector<std::string>& stems)
      : options_(options), names_(names), stems_(stems), outcomes_(names.size()), done_(names.size(), 0.0) {}

  const std::vector<SpatialOutcome>& run() {
    {
      const auto jobs = std::min(static_cast<std::size_t>(options_.jobs), names_.size());
      std::vector<std::jthread> workers;
      for (std::size_t j = 0; j < jobs; ++j) workers.emplace_back([this] { work(); });
    }
    return outcomes_;
  }

 private:
  void work() {
    for (std::size_t i = next_++; i < names_.size(); i = next_++) {
      outcomes_[i] =
          spatial_recording(options_, names_[i], stems_[i], [this, i](double part) { update(i, part); });
      update(i, 1);
    }
  }

  void update(std::size_t i, double fraction) {
    const std::lock_guard lock(printing_);
    done_[i] = fraction;
    progress_.update(std::accumulate(done_.begin(), done_.end(), 0.0) / static_cast<double>(done_.size()));
  }

  const SpatialOptions& options_;
  const std::vector<std::string>&names_, &stems_;
  std::vector<SpatialOutcome> outcomes_;
  std::vector<double> done_;  // fraction of each
  std::atomic<std::size_t> next_ = 0;
  std::mutex printing_;
  cli::Progress progress_{"recordings"};
};

// Whether a recording has no texture because of its data (a finger at rest, say), and not because of a file.
bool is_unsuitable(const SpatialOutcome& outcome) {
  return !outcome.report && !outcome.too_short.nothing_left &&
         outcome.report.error().kind == ErrorKind::unsuitable;
}

bool has_failed(const SpatialOutcome& outcome) {
  return !outcome.report && !outcome.too_short.nothing_left && !is_unsuitable(outcome);
}

Report report_of(const std::vector<SpatialOutcome>& outcomes, const std::vector<std::string>& skipped) {
  std::vector<Report> made, unsuitable;
  std::vector<std::string> failed;
  std::vector<std::string> too_short;
  std::optional<ErrorKind> fault;
  for (const SpatialOutcome& outcome : outcomes) {
    if (outcome.too_short.any()) too_short.push_back(words_of(outcome.too_short));
    if (outcome.report) {
      made.push_back(*outcome.report);
      continue;
    }
    const schema::Error& error = outcome.report.error();
    if (is_unsuitable(outcome))
      unsuitable.push_back(Report().add("recording", error.where).add("because", error.what));
    if (!has_failed(outcome)) continue;
    failed.push_back(schema::message(error));
    fault = fault.value_or(error.kind);
  }
  Report report;
  report.add("done", made.size());
  report.add("recordings", std::move(made));
  if (!skipped.empty()) report.add("skipped", skipped);
  if (!too_short.empty()) report.add("too_short", std::move(too_short));
  if (!unsuitable.empty()) report.add("unsuitable", std::move(unsuitable));
  if (fault) report.add("failed", std::move(failed)).ends_with(*fault);
  return report;
}

}  // namespace

bool is_batch(const SpatialOptions& options) {
  std::error_code ignored;
  return options.recordings.size() > 1 || fs::is_directory(options.recordings.front(), ignored);
}

Result<Report> spatial_batch(const SpatialOptions& options) {
  const auto names = without_folders(options.recordings);
  TACTO_TRY(names);
  const Sorted files = sorted(*names);
  if (!files.skipped.empty())
    cli::warn(fmt::format("skipped because they are not recordings: {}", fmt::join(files.skipped, ", ")));
  if (files.recordings.empty())
    return schema::fail(ErrorKind::unsuitable, "none of the given files is a recording");
  if (averages_recordings(options)) return spatial_takes(options, files.recordings);
  const auto stems = texture_stems(files.recordings, options.output);
  TACTO_TRY(stems);
  Batch batch(options, files.recordings, *stems);
  const auto& outcomes = batch.run();
  // Collected over all recordings, so that one warning of a kind can summarise a whole folder.
  std::vector<cli::Warning> warnings;
  for (const SpatialOutcome& outcome : outcomes)
    warnings.insert(warnings.end(), outcome.warnings.begin(), outcome.warnings.end());
  cli::warn_grouped(warnings);
  std::vector<TooShort> too_short;
  std::vector<schema::Error> unsuitable, failures;
  for (const SpatialOutcome& outcome : outcomes) {
    too_short.push_back(outcome.too_short);
    if (is_unsuitable(outcome)) unsuitable.push_back(outcome.report.error());
    if (has_failed(outcome)) failures.push_back(outcome.report.error());
  }
  auto reasons = cli::by_cause(unsuitable);
  const auto said = too_short_sentence(too_short);
  if (std::ranges::all_of(too_short, &TooShort::nothing_left))
    return schema::fail(ErrorKind::unsuitable, *said);
  if (said) cli::warn(*said);
  const bool none = std::ranges::none_of(outcomes, [](const auto& each) { return each.report.has_value(); });
  for (const schema::Error& error : std::span(reasons).subspan(none && failures.empty() ? 1 : 0))
    cli::warn("skipped: " + schema::message(error));
  if (none && failures.empty()) return tl::unexpected(reasons.front());
  for (const schema::Error& error : cli::by_cause(failures)) cli::warn("failed: " + schema::message(error));
  return report_of(outcomes, files.skipped);
}

}  // namespace tacto::spatial
