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
  return outcome.report;
}

cli::Action declare_spatial(CLI::App& app) {
  const auto options = std::make_shared<SpatialOptions>();
  declare_spatial(app, *options);
  return
      [options] { return options->recordings.size() == 1 ? act_on_one(*options) : spatial_batch(*options); };
}

}  // namespace

const cli::Verb kSpatialVerb{
    "spatial", "Turn the strokes of a recording into textures: force against position",
    "tactograph spatial oak -o oak\n"
    "  tactograph spatial oak --from 4.55s --to 6.85s --band 15Hz..500Hz --grid 1um -o oak-down\n"
    "  tactograph spatial oak --list\n"
    "  tactograph spatial oak --average --align correlation -o oak-mean\n"
    "  tactograph spatial oak-1 oak-2 oak-3 --average -o oak-mean\n"
    "  tactograph spatial *.json --jobs 2 -o textures/",
    declare_spatial};

}  // namespace tacto::spatial
