// SPDX-License-Identifier: GPL-3.0-or-later
// A corpus as a job of a cluster: a file for Slurm or Snakemake that runs `corpus run --shard I/N`.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "data-schema/base/error.hpp"

namespace tacto::analysis {

/// An array of Slurm has at most 1,001 indices by default (MaxArraySize), 0 among them.
inline constexpr std::size_t kMostShards = 1000;

enum class WorkflowEngine { slurm, snakemake };

struct CorpusWorkflowOptions {
  std::string study, output;
  WorkflowEngine engine = WorkflowEngine::slurm;
  bool missing = false;                          ///< only shards in which a unit is missing or damaged
  std::optional<std::size_t> shards;             ///< default: a minute of work each, or more
  std::string account, partition, time, memory;  ///< as Slurm's options; may be empty
};

struct CorpusWorkflow {
  std::string text;  ///< of the file
  std::size_t recordings = 0;
  std::size_t shards = 0;           ///< into which the recordings are divided
  std::vector<std::size_t> listed;  ///< those in the file, from 1
  double work_s = 0;                ///< of all recordings on one core, estimated
  std::size_t read = 0;             ///< recordings whose length the estimate knows
};

/// The number of shards depends on plan and recordings only, so that a shard has the same recordings with and
/// without `missing`. Errors: of the plan; usage, of options; unsuitable, if nothing is missing.
schema::Result<CorpusWorkflow> corpus_workflow(const CorpusWorkflowOptions& options);

/// Whether a file with this first comment was made of a CorpusWorkflow::text.
bool is_workflow(std::string_view first_line);

}  // namespace tacto::analysis
