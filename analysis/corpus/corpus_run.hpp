// SPDX-License-Identifier: GPL-3.0-or-later
// Computes the units of a corpus that are missing or damaged.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "data-schema/base/error.hpp"

namespace tacto::analysis {

struct CorpusRunOptions {
  std::string study;
  std::size_t shard = 1, shards = 1;  ///< every `shards`-th recording, from the `shard`-th on
  std::size_t jobs = 1;               ///< recordings at the same time
  bool verify = false;                ///< compare all files with their checksums, also unchanged ones
};

struct CorpusRunCounts {
  std::size_t recordings = 0;  ///< in the shard
  std::size_t made = 0;        ///< units, published by this run; failures among them
  std::size_t failed = 0;      ///< of these, failures
  std::size_t present = 0;     ///< units that were there
  std::size_t others = 0;      ///< units that another run published in the meantime
  std::size_t removed = 0;     ///< working folders of runs that were killed
  std::size_t worked_on = 0;   ///< recordings of which this run computed a unit
  bool stopped = false;
};

/// A unit is computed in STUDY/work/PROCESS, synced to disk together with others, and published by renaming
/// its folder. rename(2) never replaces a folder that has contents, on local file systems and on NFS, so of
/// several runs, also on several machines, one publishes a unit and the others discard theirs. A recording
/// that fails becomes a unit with the reason. `stopped` is asked before each recording; what is complete is
/// then published. Errors: of the plan; unsuitable, if another version of the program made it; cannot_write,
/// which stops the run.
schema::Result<CorpusRunCounts> run_corpus(const CorpusRunOptions& options,
                                           const std::function<void(double)>& progress,
                                           const std::function<bool()>& stopped);

}  // namespace tacto::analysis
