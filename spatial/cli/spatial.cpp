// SPDX-License-Identifier: GPL-3.0-or-later
// tactograph spatial: makes textures, force against position, of a recording's strokes.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>

#include "data-schema/report/progress.hpp"
#include "spatial/cli/verbs.hpp"
#include "spatial/job/spatial_batch.hpp"
#include "spatial/job/spatial_options.hpp"
#include "spatial/job/spatial_recording.hpp"
#include "spatial/job/texture_names.hpp"

namespace tacto::spatial {
namespace {

using cli::Report;
using schema::Result;

Result<Report> act_on_one(const SpatialOptions& options) {
  const auto stems = texture_stems(options.recordings, options.output);
  TACTO_TRY(stems);
  cli::Progress progress("textures");
  const auto outcome = spatial_recording(options, options.recordings.front(), stems->front(),
                                         [&](double fraction) { progress.update(fraction); });
  cli::warn_grouped(outcome.warnings);
  const std::vector too_short{outcome.too_short};
  if (const auto said = too_short_sentence(too_short); said && outcome.report) cli::warn(*said);
  return outcome.report;
}

cli::Action declare_spatial(CLI::App& app) {
  const auto options = std::make_shared<SpatialOptions>();
  declare_spatial(app, *options);
  cli::explain_strokes(app);
  return [options] { return is_batch(*options) ? spatial_batch(*options) : act_on_one(*options); };
}

}  // namespace

const cli::Verb kSpatialVerb{
    "spatial", "Turn the strokes of a recording into textures: force against position",
    "tactograph spatial oak -o oak\n"
    "  tactograph spatial oak --from 4.55s --to 6.85s --band 15Hz..500Hz --grid 1um -o oak-down\n"
    "  tactograph spatial oak --list\n"
    "  tactograph spatial oak --average --align correlation -o oak-mean\n"
    "  tactograph spatial oak-1 oak-2 oak-3 --average -o oak-mean\n"
    "  tactograph spatial study-3 --jobs 2 -o textures/",
    declare_spatial};

}  // namespace tacto::spatial
