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
#include <string>
#include <thread>
#include <vector>

#include "data-schema/files/files.hpp"
#include "data-schema/kinds/file_kind.hpp"
#include "data-schema/report/progress.hpp"
#include "spatial/job/spatial_average.hpp"
#include "spatial/job/spatial_recording.hpp"
#include "spatial/job/spatial_report.hpp"
#include "spatial/job/texture_names.hpp"
#include "spatial/job/too_short.hpp"
#include "spatial/texture/average_textures.hpp"
#include "spatial/texture/texture_warnings.hpp"

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

// The mean of one direction, or of both.
struct Mean {
  std::string ending;
  TextureAverager averager;
};

// What is compared between the recordings of one mean.
struct Origin {
  std::string recording, surface, simulated, sha256;
};

std::string surface_words(const Origin& origin) {
  return origin.surface.empty() ? "no surface is named in " + origin.recording
                                : fmt::format("'{}' in {}", origin.surface, origin.recording);
}

// Links, copies and other spellings of a name lead to the same samples.
Result<void> check_not_twice(const Origin& one, const std::vector<Origin>& others) {
  const auto same = std::ranges::find(others, one.sha256, &Origin::sha256);
  if (same == others.end()) return {};
  return schema::fail(ErrorKind::unsuitable, fmt::format("has the same samples as {}", same->recording),
                      one.recording, "name each recording once");
}

Result<void> check_not_mixed(const Origin& one, const Origin& first) {
  constexpr const char* kRemedy = "average them separately, or add --mix";
  if (one.simulated.empty() != first.simulated.empty())
    return schema::fail(ErrorKind::unsuitable,
                        fmt::format("is {}, but {} is {}", one.simulated.empty() ? "measured" : "simulated",
                                    first.recording, first.simulated.empty() ? "measured" : "simulated"),
                        one.recording, kRemedy);
  if (one.surface == first.surface) return {};
  return schema::fail(
      ErrorKind::unsuitable,
      fmt::format("the recordings have different surfaces: {}, {}", surface_words(first), surface_words(one)),
      one.recording, kRemedy);
}

class Takes {
 public:
  explicit Takes(const SpatialOptions& options, std::string stem)
      : options_(options), stem_(std::move(stem)), means_{{"-forward", {}}, {"-backward", {}}} {}

  // All warnings of a recording contain its name.
  Result<void> add(const std::string& recording, const std::function<void(double)>& progress) {
    warnings_.clear();
    TooShort& too_short = too_short_.emplace_back();
    auto take = open_take(options_, recording, warnings_, too_short);
    if (!take && take.error().kind != ErrorKind::unsuitable) return schema::forward_error(take);
    std::size_t strokes = 0;
    if (!take && !too_short.nothing_left) excluded_.push_back(take.error());
    if (take) TACTO_TRY(check_origin(recording, take->maker.record().header()));
    if (take)
      for (const AverageGroup& group : average_groups(take->jobs, options_.both_ways, "")) {
        const bool backward = !options_.both_ways && group.jobs.front().stroke.direction < 0;
        TextureAverager& averager = means_[backward ? 1 : 0].averager;
        const std::size_t before = averager.strokes();
        const auto added =
            add_strokes(take->maker, group.jobs, {options_, warnings_, progress, true}, averager);
        if (!added) return added;
        strokes += averager.strokes() - before;
      }
    for (const std::string& warning : warnings_)
      cli::warn(warning.starts_with(recording) ? warning : fmt::format("{}: {}", recording, warning));
    takes_.push_back(Report().add("recording", recording).add("strokes_averaged", strokes));
    return {};
  }

  Result<Report> finish() {
    if (const auto said = too_short_sentence(too_short_)) cli::warn(*said);
    for (const schema::Error& error : cli::by_cause(excluded_))
      cli::warn("excluded: " + schema::message(error));
    schema::PendingFiles pending;
    std::vector<Report> rows;
    for (const Mean& mean : means_) {
      if (mean.averager.strokes() == 0) continue;
      const std::string stem = stem_of(mean);
      const auto texture = mean.averager.finish(name_of(options_.align));
      if (!texture) {
        cli::warn(fmt::format("{}: no average: {}", stem, schema::message(texture.error())));
        continue;
      }
      TACTO_TRY(schema::check_texture_free(stem, options_.existing));
      TACTO_TRY(schema::add_texture(pending, stem, *texture));
      for (const TextureWarning& warning : texture_warnings(*texture)) cli::warn(stem + ": " + warning.text);
      rows.push_back(average_row(stem, *texture));
    }
    if (rows.empty())
      return schema::fail(ErrorKind::unsuitable, "no two strokes of these recordings can be averaged", stem_,
                          "the warnings give the reasons; --list shows the positions of the strokes");
    TACTO_TRY(pending.commit(options_.existing));
    return Report().add("takes", std::move(takes_)).add("averages", std::move(rows));
  }

 private:
  std::string stem_of(const Mean& mean) const {
    const bool both = means_.front().averager.strokes() > 0 && means_.back().averager.strokes() > 0;
    return both ? stem_ + mean.ending : stem_;
  }

  Result<void> check_origin(const std::string& recording, const schema::RecordingHeader& header) {
    origins_.push_back({recording, header.surface, header.simulated, header.sha256});
    const Origin one = origins_.back();
    TACTO_TRY(check_not_twice(one, {origins_.begin(), origins_.end() - 1}));
    return options_.mix ? Result<void>() : check_not_mixed(one, origins_.front());
  }

  const SpatialOptions& options_;
  std::string stem_;
  std::vector<Mean> means_;
  std::vector<Origin> origins_;
  std::vector<Report> takes_;
  std::vector<std::string> warnings_;  // of the recording that is added
  std::vector<TooShort> too_short_;
  std::vector<schema::Error> excluded_;
};

Result<void> check_options(const SpatialOptions& options) {
  if (!options.chosen_by.budget.asked() && !options.chosen_by.explain) return {};
  return schema::fail(ErrorKind::usage,
                      "--quality, --max-error and --explain do not apply to the mean of several recordings",
                      "--quality", "give --method and --grid");
}

// Whether the options request one mean over all recordings: --average, and -o is a plain name. A folder or a
// name with {} requests one mean per recording.
bool averages_recordings(const SpatialOptions& options) {
  return options.average && !options.list && names_one_texture(options.output);
}

// Aligns as within one recording: by position on the bench, which the takes must have in common, or by
// correlation with the strokes before. A recording without a usable stroke is left out with a warning.
// Errors: usage, of names; of reading; unsuitable, if two recordings have the same samples, different
// surfaces or only one of them is simulated (the last two unless --mix is given), or if fewer than two
// strokes remain.
Result<Report> spatial_takes(const SpatialOptions& options, const std::vector<std::string>& recordings) {
  TACTO_TRY(check_options(options));
  const auto each = texture_stems(recordings, "");  // an error if a recording is named twice
  TACTO_TRY(each);
  const auto stem = texture_stems({recordings.front()}, options.output);
  TACTO_TRY(stem);
  Takes takes(options, stem->front());
  cli::Progress progress("takes");
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    const auto tell = [&](double part) {
      progress.update((static_cast<double>(i) + part) / static_cast<double>(recordings.size()));
    };
    TACTO_TRY(takes.add(recordings[i], tell));
  }
  return takes.finish();
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
