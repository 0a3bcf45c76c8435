// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/job/spatial_recording.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/base/quantity.hpp"
#include "data-schema/base/stroke_rule.hpp"
#include "data-schema/base/unknown_note.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/recording/recording.hpp"
#include "data-schema/texture/texture.hpp"
#include "spatial/dsp/filter/block_fourier_filter.hpp"
#include "spatial/job/spatial_average.hpp"
#include "spatial/job/spatial_report.hpp"
#include "spatial/job/texture_names.hpp"
#include "spatial/spectrogram/budget.hpp"
#include "spatial/strokes/touch_record.hpp"
#include "spatial/texture/filtered_track.hpp"
#include "spatial/texture/texture_warnings.hpp"
#include "spatial/texture/time_filter.hpp"

namespace tacto::spatial {
namespace {

using cli::Report;
using schema::ErrorKind;
using schema::Result;

constexpr double kSameSpeed = 0.05;  // for strokes that begin or end some frames apart

struct ChosenTexture {
  TextureOptions options;  // including method and grid
  cli::Report report;      // the choice; with --explain also the alternatives and the table
};

Result<TextureNeed> need_of(const SpatialOptions& options, const TextureOptions& target,
                            const TouchRecord& record, const std::vector<StrokeJob>& jobs) {
  if (target.filter.method != FilterMethod::fourier || target.space)
    return schema::fail(ErrorKind::usage, "an error can be guaranteed only for a band with an upper limit",
                        options.chosen_by.budget.max_error ? "--max-error" : "--quality",
                        "omit --filter and --band-in, or give --method and --grid");
  const double rate_hz = record.header().sample_rate_hz;
  TextureNeed need{rate_hz, target.filter.passed(rate_hz).high_hz, 1e300, options.method, options.pitch_m};
  for (const StrokeJob& job : jobs)
    need.slowest_mps = std::min(need.slowest_mps, record.mean_speed_mps(job.stroke));
  return need;
}

Report row_of(const TextureChoice& choice, const TextureChoice& taken) {
  const bool is_taken = choice.method == taken.method && choice.pitch_m == taken.pitch_m;
  return Report()
      .add("method", std::string(name_of(choice.method)))
      .add("grid_m", choice.pitch_m)
      .add("error_percent", 100 * choice.error)
      .add("cost_us_per_mm", 1e-6 * choice.cost_ns_per_m)
      .add("kib_per_mm", 1e-3 * choice.bytes_per_m / 1024)
      .add("taken", is_taken);
}

std::string asked(const schema::Budget& budget) {
  return budget.most_exact() ? "the most exact" : fmt::format("at most {:g} %", 100 * budget.most_error());
}

/// RMS of the recorded values minus the filtered ones, about its mean, over the RMS of the filtered ones in
/// the same frames; each is the largest of all strokes, of three axes also of these.
struct BandShare {
  double whole = 0;   ///< in all frames of a stroke
  double inside = 0;  ///< in their middle half, without the steps of the force at start and stop
};

double square_sum(std::span<const double> values, double about) {
  double sum = 0;
  for (const double value : values) sum += (value - about) * (value - about);
  return sum;
}

double rms_share(std::span<const double> taken, std::span<const double> passed) {
  const double mean = std::accumulate(taken.begin(), taken.end(), 0.0) / static_cast<double>(taken.size());
  const double all = square_sum(passed, 0);
  return all > 0 ? std::sqrt(square_sum(taken, mean) / all) : 0;
}

schema::Result<BandShare> share_of_stroke(const TouchRecord& record, Track track, FilteredTrack& filtered,
                                          FrameRange frames) {
  const auto holds = [&](const FrameRange& piece) { return piece.contains(frames); };
  const auto piece = std::ranges::find_if(record.pieces(), holds);
  if (piece == record.pieces().end())
    return schema::fail(schema::ErrorKind::unsuitable, "frames are missing inside the stroke",
                        record.where());
  const auto passed = filtered.values(record.source(), *piece, frames);
  TACTO_TRY(passed);
  std::vector<double> taken(frames.size());
  TACTO_TRY(record.source().read(track, frames.begin, taken));
  for (std::size_t i = 0; i < taken.size(); ++i) taken[i] -= (*passed)[i];
  const std::size_t quarter = taken.size() / 4, half = taken.size() - 2 * quarter;
  return BandShare{rms_share(taken, *passed),
                   rms_share(std::span(taken).subspan(quarter, half), passed->subspan(quarter, half))};
}

// Without an equaliser. Each section between two gaps is filtered once. Errors: unsuitable, if frames are
// missing inside a stroke; of check(filter, sample_rate_hz); of reading.
schema::Result<BandShare> band_share(const TouchRecord& record, const TimeFilter& filter,
                                     std::span<const Stroke> strokes) {
  BandShare worst;
  for (const Track track : record.value_tracks()) {
    FilteredTrack filtered(record.header().sample_rate_hz, filter, {}, track);
    for (const Stroke& stroke : strokes) {
      const auto share = share_of_stroke(record, track, filtered, stroke.frames);
      TACTO_TRY(share);
      worst.whole = std::max(worst.whole, share->whole);
      worst.inside = std::max(worst.inside, share->inside);
    }
  }
  return worst;
}

// The promise is about the force behind the band-pass, so what the band-pass removes is reported separately,
// as measured.
std::string excluded_text(double lowest_hz, const BandShare& share) {
  return fmt::format(
      "the part that the band-pass removes: in the worst stroke of this recording {:.3g} % of the RMS of the "
      "part that passes, {:.3g} % in the middle half of the stroke (drift, slow friction, the steps of the "
      "force where the finger starts and stops); the unknown signal within {:.2g} s beyond the ends of the "
      "record; rounding and noise of the encoder; changes of speed within {:g} frames; slower places (see "
      "the valid band)",
      100 * share.whole, 100 * share.inside, kBandKernelPeriods / lowest_hz, kSteadyFrames);
}

Result<BandShare> share_of(const TextureOptions& target, const TouchRecord& record,
                           const std::vector<StrokeJob>& jobs) {
  std::vector<Stroke> strokes;
  for (const StrokeJob& job : jobs) strokes.push_back(job.stroke);
  return band_share(record, target.filter, strokes);
}

void explain(Report& report, const TextureChoices& choices, const TextureNeed& need, double lowest_hz,
             const BandShare& share, const schema::FoundTradeTable& found) {
  report.add("by_table", found.origin);
  report.add("error_includes",
             fmt::format("error of method and grid up to {:g} Hz, interpolated between the points of the "
                         "grid, where the speed is {} or more",
                         need.highest_hz,
                         schema::for_people(kPromisedSpeed * need.slowest_mps, schema::Dimension::speed)));
  report.add("removed_by_filter_percent", 100 * share.whole)
      .add("removed_by_filter_inside_percent", 100 * share.inside);
  report.add("error_does_not_include", excluded_text(lowest_hz, share));
  std::vector<Report> rows;
  for (const TextureChoice& choice : choices.tried) rows.push_back(row_of(choice, choices.taken));
  report.add("tried", std::move(rows));
}

// Errors: usage, for a band without an upper limit; unsuitable, if no choice keeps the budget; of reading
// the table of measured choices.
Result<ChosenTexture> choose_texture(const SpatialOptions& options, const TextureOptions& target,
                                     const TouchRecord& record, const std::vector<StrokeJob>& jobs) {
  const schema::Budget& budget = options.chosen_by.budget;
  const auto need = need_of(options, target, record, jobs);
  TACTO_TRY(need);
  const auto found = schema::find_trade_table();
  TACTO_TRY(found);
  auto choices = choose_texture(found->table, *need, budget);
  if (!choices) {
    if (choices.error().where.empty()) choices.error().where = record.where();
    return schema::forward_error(choices);
  }
  ChosenTexture chosen{target, {}};
  chosen.options.method = choices->taken.method;
  chosen.options.pitch_m = choices->taken.pitch_m;
  chosen.report.add("method", std::string(name_of(choices->taken.method)))
      .add("guaranteed_error_percent", 100 * choices->taken.error)
      .add("allowed_error", asked(budget))
      .add("promise_is",
           "relative to the force after the same band-pass; --explain reports what the band-pass removes");
  if (!options.chosen_by.explain) return chosen;
  const auto share = share_of(target, record, jobs);
  TACTO_TRY(share);
  explain(chosen.report, *choices, *need, target.filter.passed(need->sample_rate_hz).low_hz, *share, *found);
  return chosen;
}

// The state of one recording's processing.
class Run {
 public:
  Run(const SpatialOptions& options, std::string stem, const std::function<void(double)>& progress,
      std::vector<cli::Warning>& warnings, TooShort& too_short)
      : options_(options),
        stem_(std::move(stem)),
        progress_(progress),
        warnings_(warnings),
        too_short_(too_short) {}

  Result<Report> on(const std::string& name) {
    const auto target = texture_options(options_);
    TACTO_TRY(target);
    auto record = opened(name, *target);
    TACTO_TRY(record);
    if (options_.list) return list(*record);
    const std::size_t said = warnings_.size();
    too_short_.recording = record->where();
    auto chosen = jobs(*record);
    TACTO_TRY(chosen);
    const auto choice = texture_choice(*target, *record, *chosen);
    TACTO_TRY(choice);
    auto maker = ready(std::move(*record), choice->options);
    if (!maker) {
      warnings_.resize(said);  // discard warnings about strokes that make no texture
      return schema::forward_error(maker);
    }
    TACTO_TRY(leave_out_short(*maker, *chosen));
    auto report = options_.average ? averages(*maker, *chosen) : textures(*maker, *chosen);
    if (report && options_.chosen_by.budget.asked())
      report->add("chosen", std::vector<Report>{choice->report});
    return report;
  }

  Result<Take> take(const std::string& name) {
    const auto target = texture_options(options_);
    TACTO_TRY(target);
    auto record = opened(name, *target);
    TACTO_TRY(record);
    too_short_.recording = record->where();
    auto chosen = jobs(*record);
    TACTO_TRY(chosen);
    auto maker = ready(std::move(*record), *target);
    TACTO_TRY(maker);
    TACTO_TRY(leave_out_short(*maker, *chosen));
    return Take{std::move(*maker), std::move(*chosen)};
  }

 private:
  Result<TouchRecord> opened(const std::string& name, const TextureOptions& target) {
    const auto recording = schema::open_recording(name);
    TACTO_TRY(recording);
    if (const std::string note = schema::unknown_note(name, recording->header); !note.empty()) warn(note);
    // A texture stores the checksum of the recording's samples, so it has to be correct.
    TACTO_TRY(schema::check_samples_sum(*recording));
    auto record = TouchRecord::open(*recording, target.channel);
    if (!record) return record;
    if (const std::string note = channel_note(target, *record); !note.empty()) warn(note);
    warn_of_recording(*record);
    return record;
  }

  Result<TextureMaker> ready(TouchRecord record, const TextureOptions& target) {
    const std::string name = record.where();
    const double rate_hz = record.header().sample_rate_hz;
    auto maker = TextureMaker::open(std::move(record), target);
    if (!maker) return maker;
    if (const std::string lost = rate_warning(target, rate_hz); !lost.empty())
      warn(fmt::format("{}: {}", name, lost));
    return maker;
  }

  Result<Report> list(const TouchRecord& record) const {
    std::vector<Report> rows;
    for (std::size_t i = 0; i < record.strokes().size(); ++i)
      rows.push_back(stroke_row(record, {record.strokes()[i], static_cast<int>(i) + 1, ""}));
    Report report;
    report.add("recording", record.where());
    add_position(report, record);
    report.add("found", rows.size());
    if (record.short_runs() > 0) report.add("too_short_for_a_stroke", record.short_runs());
    if (!record.jumps().empty()) report.add("position_jumps", jump_rows(record));
    if (!rows.empty()) report.add("strokes", std::move(rows));
    return report;
  }

  Result<std::vector<StrokeJob>> jobs(const TouchRecord& record) {
    if (options_.stroke) return one_job(record.stroke(*options_.stroke), *options_.stroke);
    if (!options_.from_s && !options_.to_s) return found_strokes(record);
    const Stroke whole{{0, record.header().frames}, 1};
    const double from_s = options_.from_s.value_or(record.from_s(whole));
    return one_job(record.section(from_s, options_.to_s.value_or(record.to_s(whole))), 0);
  }

  Result<std::vector<StrokeJob>> one_job(const Result<Stroke>& stroke, int number) const {
    TACTO_TRY(stroke);
    return std::vector<StrokeJob>{{*stroke, number, stem_}};
  }

  Result<std::vector<StrokeJob>> found_strokes(const TouchRecord& record) {
    std::vector<StrokeJob> all;
    for (const Stroke& stroke : record.strokes())
      all.push_back({stroke, static_cast<int>(all.size()) + 1, stem_});
    too_short_.motions = record.short_runs();
    too_short_.nothing_left = all.empty() && record.short_runs() > 0;
    if (all.empty())
      return schema::fail(
          ErrorKind::unsuitable,
          fmt::format("no stroke was found; the longest motion is {}",
                      schema::length_for_people(record.longest_m())),
          record.where(),
          fmt::format("a stroke is {}; select a shorter motion with --from and --to", schema::kStrokeRule));
    warn_of_jumps(record);
    std::vector<StrokeJob> jobs = down_only(record, std::move(all));
    if (jobs.empty())
      return schema::fail(ErrorKind::unsuitable, "the finger does not touch the surface in any stroke",
                          record.where(), "--finger-up makes textures nevertheless");
    if (jobs.size() > 1)
      for (StrokeJob& job : jobs) job.stem = fmt::format("{}-{:02}", stem_, job.number);
    return jobs;
  }

  // Removes the strokes with the finger up, with a warning.
  std::vector<StrokeJob> down_only(const TouchRecord& record, std::vector<StrokeJob> jobs) {
    std::vector<int> up;
    for (const StrokeJob& job : jobs)
      if (job.stroke.finger_up) up.push_back(job.number);
    if (up.empty() || options_.finger_up) return jobs;
    warn(
        fmt::format("{}: the finger does not touch in stroke{} {} (normal force below {}): no texture of {}; "
                    "use --finger-up or --stroke N",
                    record.where(), up.size() == 1 ? "" : "s", fmt::join(up, ", "),
                    why_finger_up(*record.finger_up_below_n()), up.size() == 1 ? "it" : "them"));
    std::erase_if(jobs, [](const StrokeJob& job) { return job.stroke.finger_up; });
    return jobs;
  }

  // Chooses by the budget, if there is one.
  Result<ChosenTexture> texture_choice(const TextureOptions& target, const TouchRecord& record,
                                       const std::vector<StrokeJob>& jobs) {
    if (options_.chosen_by.budget.asked()) return choose_texture(options_, target, record, jobs);
    if (options_.chosen_by.explain)
      return schema::fail(ErrorKind::usage, "--explain needs a choice by --quality or --max-error",
                          "--explain", "add --quality or --max-error");
    return ChosenTexture{target, {}};
  }

  // If there are several strokes, one that makes no texture is skipped with a warning.
  Result<Report> textures(TextureMaker& maker, const std::vector<StrokeJob>& jobs) {
    std::vector<std::string> stems;
    for (const StrokeJob& job : jobs) stems.push_back(job.stem);
    TACTO_TRY(check_names(stems));
    schema::PendingFiles pending;
    std::vector<Report> rows;
    std::optional<Report> head;
    std::optional<schema::Error> first;  // the reason why a stroke makes no texture
    for (const StrokeJob& job : jobs) {
      const auto texture = maker.make(job.stroke, job.number);
      if (!texture && (jobs.size() == 1 || texture.error().kind != ErrorKind::unsuitable))
        return schema::forward_error(texture);
      if (!texture) {
        first = first.value_or(texture.error());
        warnings_.push_back({fmt::format("stroke {}", job.number),
                             "no texture was made: " + schema::message(texture.error()), "no texture"});
        continue;
      }
      TACTO_TRY(schema::add_texture(pending, job.stem, *texture));
      if (!head) head = head_of(maker.record(), *texture);
      warn_of(job.stem, *texture);
      rows.push_back(texture_row(maker.record(), job, *texture));
      progress_(static_cast<double>(&job - jobs.data() + 1) / static_cast<double>(jobs.size()));
    }
    if (!head) {
      first->what = "no stroke makes a texture; reason for the first: " + first->what;
      return tl::unexpected(*first);
    }
    TACTO_TRY(pending.commit(options_.existing, options_.sync));
    head->add("textures", std::move(rows));
    return std::move(*head);
  }

  Result<Report> averages(TextureMaker& maker, const std::vector<StrokeJob>& jobs) {
    const auto groups = average_groups(jobs, options_.both_ways, stem_);
    std::vector<std::string> stems;
    for (const AverageGroup& group : groups) stems.push_back(group.stem);
    TACTO_TRY(check_names(stems));
    schema::PendingFiles pending;
    std::vector<Report> rows;
    std::optional<Report> head;
    for (const AverageGroup& group : groups) {
      std::vector<std::string> left_out;
      const auto texture = averaged(maker, group, options_, left_out, progress_);
      for (const std::string& warning : left_out) warn(warning);
      if (!texture && (groups.size() == 1 || texture.error().kind != ErrorKind::unsuitable))
        return schema::forward_error(texture);
      if (!texture) {
        warnings_.push_back({group.stem, "no average: " + schema::message(texture.error()), "no average"});
        continue;
      }
      TACTO_TRY(schema::add_texture(pending, group.stem, *texture));
      if (!head) head = head_of(maker.record(), *texture);
      warn_of(group.stem, *texture);
      rows.push_back(average_row(group.stem, *texture));
    }
    if (!head)
      return schema::fail(ErrorKind::unsuitable, "no two strokes can be averaged", maker.record().where(),
                          "the warnings give the reasons");
    TACTO_TRY(pending.commit(options_.existing, options_.sync));
    head->add("averages", std::move(rows));
    return std::move(*head);
  }

  Result<void> check_names(const std::vector<std::string>& stems) {
    for (const std::string& stem : stems)
      if (auto free = schema::check_texture_free(stem, options_.existing); !free) return free;
    const auto others = other_textures(stem_, stems);
    if (!others.empty())
      warn(fmt::format("{} of another run {} in the same folder: {}",
                       others.size() == 1 ? "a texture" : "textures", others.size() == 1 ? "is" : "are",
                       fmt::join(others, ", ")));
    return {};
  }

  void warn(const std::string& text) { warnings_.push_back({"", text}); }
  // Of the strokes that were found, not of one that the user selected: that is refused with its own message.
  Result<void> leave_out_short(const TextureMaker& maker, std::vector<StrokeJob>& jobs) {
    if (options_.stroke || options_.from_s || options_.to_s) return {};
    std::erase_if(jobs, [&](const StrokeJob& job) {
      const bool is_short = !maker.is_long_enough(job.stroke);
      if (is_short) too_short_.strokes.push_back(job.number);
      return is_short;
    });
    if (!jobs.empty()) return {};
    too_short_.nothing_left = true;
    return schema::fail(
        ErrorKind::unsuitable,
        "no stroke is long enough for a texture: each lasts less than one period of the band's "
        "lowest frequency",
        maker.record().where(), "use a higher --low, or --band off");
  }

  // Warnings that the recording stores for the channel, such as outliers; and a scale of the position that
  // was changed later.
  void warn_of_recording(const TouchRecord& record) {
    const schema::RecordingHeader& header = record.header();
    for (const std::string& warning : header.warnings)
      for (const Track track : record.value_tracks())
        if (warning.starts_with(record.source().channel(track)->name + ": "))
          warn(fmt::format("{}: {}", record.where(), warning));
    if (const std::size_t gaps = record.filled().size(); gaps > 0)
      warn(fmt::format("{}: {} missing frames in {} short gaps were interpolated", record.where(),
                       record.filled_in({0, header.frames}), gaps));
    for (const schema::StrokeFigures& stored : header.strokes)
      for (const Stroke& stroke : record.strokes()) {
        const bool together = stroke.frames.begin < stored.first_frame + stored.frames / 2 &&
                              stored.first_frame + stored.frames / 2 < stroke.frames.end;
        const double speed_mps = record.mean_speed_mps(stroke);
        if (!together || std::abs(speed_mps / stored.mean_speed_mps - 1) < kSameSpeed) continue;
        warn(fmt::format(
            "{}: a stroke has a mean speed of {}, but of {} when it was recorded: the scale of the "
            "position or the rate was changed",
            record.where(), schema::for_people(speed_mps, schema::Dimension::speed),
            schema::for_people(stored.mean_speed_mps, schema::Dimension::speed)));
        return;
      }
  }

  // Positions after a jump do not match those before it on the bench.
  void warn_of_jumps(const TouchRecord& record) {
    const auto& jumps = record.jumps();
    if (jumps.empty()) return;
    const auto& largest =
        *std::ranges::max_element(jumps, {}, [](const PositionJump& jump) { return std::abs(jump.step_m); });
    warn(fmt::format(
        "{}: {}{}; positions before and after it differ by that step", record.where(),
        record.refusal(largest).what,
        jumps.size() == 1 ? "" : fmt::format(" ({} such jumps; this is the largest)", jumps.size())));
  }

  void warn_of(const std::string& what, const schema::Texture& texture) {
    for (const TextureWarning& warning : texture_warnings(texture))
      warnings_.push_back({what, warning.text, warning.kind, warning.size});
  }

  const SpatialOptions& options_;
  std::string stem_;
  const std::function<void(double)>& progress_;
  std::vector<cli::Warning>& warnings_;
  TooShort& too_short_;
};

}  // namespace

SpatialOutcome spatial_recording(const SpatialOptions& options, const std::string& recording,
                                 const std::string& stem, const std::function<void(double)>& progress) {
  SpatialOutcome outcome;
  outcome.report = Run(options, stem, progress, outcome.warnings, outcome.too_short).on(recording);
  return outcome;
}

Result<Take> open_take(const SpatialOptions& options, const std::string& recording,
                       std::vector<std::string>& warnings, TooShort& too_short) {
  const std::function<void(double)> nothing = [](double) {};
  std::vector<cli::Warning> said;
  auto take = Run(options, "", nothing, said, too_short).take(recording);
  for (const cli::Warning& warning : said) warnings.push_back(cli::sentence(warning));
  return take;
}

}  // namespace tacto::spatial
