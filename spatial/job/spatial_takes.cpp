// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/job/spatial_takes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "data-schema/files/files.hpp"
#include "data-schema/report/progress.hpp"
#include "spatial/job/spatial_average.hpp"
#include "spatial/job/spatial_recording.hpp"
#include "spatial/job/spatial_report.hpp"
#include "spatial/job/texture_names.hpp"
#include "spatial/texture/average_textures.hpp"
#include "spatial/texture/texture_warnings.hpp"

namespace tacto::spatial {
namespace {

using cli::Report;
using schema::ErrorKind;
using schema::Result;

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

  Result<void> add(const std::string& recording, const std::function<void(double)>& progress);
  Result<Report> finish();

 private:
  std::string stem_of(const Mean& mean) const;
  Result<void> check_origin(const std::string& recording, const schema::RecordingHeader& header);

  const SpatialOptions& options_;
  std::string stem_;
  std::vector<Mean> means_;
  std::vector<Origin> origins_;
  std::vector<Report> takes_;
  std::vector<std::string> warnings_;  // of the recording that is added
  std::vector<TooShort> too_short_;
  std::vector<schema::Error> excluded_;
};

Result<void> Takes::check_origin(const std::string& recording, const schema::RecordingHeader& header) {
  origins_.push_back({recording, header.surface, header.simulated, header.sha256});
  const Origin one = origins_.back();
  TACTO_TRY(check_not_twice(one, {origins_.begin(), origins_.end() - 1}));
  return options_.mix ? Result<void>() : check_not_mixed(one, origins_.front());
}

// All warnings of a recording contain its name.
Result<void> Takes::add(const std::string& recording, const std::function<void(double)>& progress) {
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

std::string Takes::stem_of(const Mean& mean) const {
  const bool both = means_.front().averager.strokes() > 0 && means_.back().averager.strokes() > 0;
  return both ? stem_ + mean.ending : stem_;
}

Result<Report> Takes::finish() {
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

Result<void> check_options(const SpatialOptions& options) {
  if (!options.chosen_by.budget.asked() && !options.chosen_by.explain) return {};
  return schema::fail(ErrorKind::usage,
                      "--quality, --max-error and --explain do not apply to the mean of several recordings",
                      "--quality", "give --method and --grid");
}

}  // namespace

bool averages_recordings(const SpatialOptions& options) {
  return options.average && !options.list && names_one_texture(options.output);
}

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

}  // namespace tacto::spatial
