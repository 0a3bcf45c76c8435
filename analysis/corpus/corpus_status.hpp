// SPDX-License-Identifier: GPL-3.0-or-later
// The state of a corpus: the results that exist, are missing, failed, or belong to changed recordings.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "analysis/corpus/corpus_unit.hpp"
#include "data-schema/base/error.hpp"
#include "data-schema/corpus/corpus_plan.hpp"

namespace tacto::analysis {

/// A unit of a recording; its later steps are not listed if it is not done.
struct CorpusUnitStatus {
  std::size_t recording = 0;  ///< index in the plan
  std::size_t step = 0;
  std::string folder;
  Unit unit;
};

struct CorpusStatus {
  schema::CorpusPlan plan;
  std::vector<CorpusUnitStatus> units;            ///< in the order of the plan
  std::size_t done = 0, failed = 0, missing = 0;  ///< recordings; missing: a unit is missing or damaged
  std::size_t warned = 0;                         ///< units with warnings
  std::vector<std::size_t> changed;               ///< recordings that are not those of `init`, with `verify`
};

/// `verify` compares all files, and the recordings, with their checksums. Errors: of the plan.
schema::Result<CorpusStatus> corpus_status(const std::string& study, bool verify);

}  // namespace tacto::analysis
