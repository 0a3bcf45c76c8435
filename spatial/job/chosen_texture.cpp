// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/job/chosen_texture.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "spatial/dsp/filter/block_fourier_filter.hpp"
#include "spatial/texture/band_share.hpp"

namespace tacto::spatial {
namespace {

using cli::Report;
using schema::ErrorKind;
using schema::Result;

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

}  // namespace

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

}  // namespace tacto::spatial
