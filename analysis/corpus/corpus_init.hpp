// SPDX-License-Identifier: GPL-3.0-or-later
// Makes the plan of a corpus from recordings.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/corpus/corpus_plan.hpp"
#include "data-schema/files/files.hpp"

namespace tacto::analysis {

struct CorpusInput {
  std::string study;                  ///< folder of the plan and the results
  std::vector<std::string> patterns;  ///< of recordings
  std::vector<schema::CorpusStep> steps;
  schema::Existing existing = schema::Existing::keep;  ///< of a plan
};

struct NewCorpus {
  schema::CorpusPlan plan;
  std::size_t others = 0;  ///< files that are no recordings
};

/// Writes STUDY/plan.corpus.json. `progress` is called with fractions from 0 to 1. Only sidecars are read:
/// each contains the SHA-256 of its WAV, which is checked when the recording is used. Errors: usage, of
/// options or if there is a plan; not_found; cannot_write.
schema::Result<NewCorpus> init_corpus(const CorpusInput& input, const std::function<void(double)>& progress);

}  // namespace tacto::analysis
