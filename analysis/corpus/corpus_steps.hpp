// SPDX-License-Identifier: GPL-3.0-or-later
// The steps of a corpus: the work of the verbs `spatial` and `describe` for one recording.
#pragma once

#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/corpus/corpus_plan.hpp"
#include "spatial/features/description.hpp"
#include "spatial/job/spatial_options.hpp"

namespace tacto::analysis {

struct CorpusSteps {
  spatial::SpatialOptions spatial;
  spatial::DescriptionOptions description;
};

/// Reads the options of each step as its verb does. Options about names, several recordings and measured
/// choices (which differ between machines) do not exist here. Errors: usage.
schema::Result<CorpusSteps> parse_steps(const std::vector<schema::CorpusStep>& steps);

/// Writes what `tactograph spatial RECORDING -o FOLDER/` writes, without syncing it. Returns the warnings.
/// Errors: of the verb.
schema::Result<std::vector<std::string>> make_textures(const spatial::SpatialOptions& options,
                                                       const std::string& recording,
                                                       const std::string& folder);

/// Writes what `tactograph describe TEXTURES -o FOLDER/NAME` writes, without syncing it; NAME is the
/// recording's. Errors: of the verb.
schema::Result<void> make_descriptions(const spatial::DescriptionOptions& options,
                                       const std::string& recording, const std::string& textures,
                                       const std::string& folder);

}  // namespace tacto::analysis
