// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/cli/identify_options.hpp"

#include <algorithm>
#include <filesystem>

#include "analysis/cli/results_output.hpp"
#include "analysis/identify/fit/plausibility.hpp"
#include "data-schema/files/files.hpp"

namespace tacto::analysis {

using cli::Report;
using schema::Result;

ExcitationPlan plan_on(const IdentifyOptions& o, const firmware_host::Device& device, double usual_v) {
  ExcitationPlan plan = o.plan;
  plan.rate_hz = drive_rate_hz(device);
  plan.amplitude_v = o.amplitude_v.value_or(usual_v);
  if (!o.high_hz) plan.high_hz = std::min(plan.high_hz, kMostOfRate * plan.rate_hz);
  return plan;
}

std::string transducer_name_of(const IdentifyOptions& o) {
  return std::filesystem::path(schema::stem_of(o.stem, ".transducer")).filename().string();
}

std::string transducer_file_of(const IdentifyOptions& o) {
  return schema::stem_of(o.stem, ".transducer") + ".transducer.json";
}

Result<void> draw_identified(const IdentifyOptions& o, const spatial::Figure& figure, Report& report) {
  if (o.picture.empty()) return {};
  if (auto drawn = spatial::write_figure(o.picture, figure); !drawn) return drawn;
  report.add("picture", o.picture);
  return {};
}

Result<Report> with_identify_results(const IdentifyOptions& o, const std::function<schema::Results()>& make,
                                     Report report) {
  if (o.results.empty()) return report;
  schema::Results results = make();
  results.verb = "identify";
  results.device = o.device_uri;
  for (const std::string& input : {o.file, o.base})
    if (!input.empty()) results.inputs.push_back(input);
  const auto no_page = [] { return Result<std::string>(); };
  TACTO_TRY(write_outputs({o.results}, o.existing, std::move(results), report, no_page));
  return report.add("results", o.results);
}

Result<void> check_fitted(const IdentifyOptions& o, const ResponseFit& fit, const schema::Transducer& base) {
  if (const auto level = check_levels(fit, base); !level || o.implausible) return level;
  if (const auto sized = check_size(fit, base); !sized) return sized;
  return check_frequencies(fit, base);
}

}  // namespace tacto::analysis
