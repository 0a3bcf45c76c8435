// SPDX-License-Identifier: GPL-3.0-or-later
// Units of a corpus: a unit is the stored result of one step for one recording, in the folder
// STUDY/units/KE/KEY. It holds the files of the verb, the verb's warnings (warnings.txt), or the reason why
// there is no result (failure.txt), and SHA256SUMS, which `sha256sum -c` reads.
#pragma once

#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/corpus/corpus_plan.hpp"

namespace tacto::analysis {

/// Files in each unit, and in a dataset of `pack`.
inline constexpr const char *kSums = "SHA256SUMS", *kWarnings = "warnings.txt";

/// STUDY/plan.corpus.json
std::string corpus_plan_path(const std::string& study);

/// The recording's sidecar, from the current folder.
std::string path_of(const std::string& study, const schema::CorpusRecording& recording);

/// The key of each step's unit, in the order of the steps: SHA-256 of the plan's program, the step, its
/// options and its input. The input is the recording's file name (textures contain it) and SHA-256, for later
/// steps the key of the step before.
std::vector<std::string> unit_keys(const schema::CorpusPlan& plan, const schema::CorpusRecording& recording);

std::string unit_folder(const std::string& study, const std::string& key);

enum class UnitState {
  missing,
  done,
  failed,   ///< the step has no result for this recording
  damaged,  ///< a file is missing, or differs from its checksum
};

struct Unit {
  UnitState state = UnitState::missing;
  std::string because = {};  ///< of a failed one
  bool may_succeed = false;  ///< of a failed one: for other reasons than what its key covers
  bool has_warnings = false;
};

/// Files that are older than their SHA256SUMS are not read, unless `verify`. Any thread.
Unit read_unit(const std::string& folder, bool verify);

/// Writes failure.txt; `text` is the message, with names that are the same on every machine. Not synced, as
/// seal_unit. Errors: cannot_write.
schema::Result<void> write_failure(const std::string& folder, schema::ErrorKind kind,
                                   const std::string& text);
schema::Result<void> write_warnings(const std::string& folder, const std::vector<std::string>& warnings);

/// Writes SHA256SUMS of all files in the folder. Errors: cannot_write; not_found.
schema::Result<void> seal_unit(const std::string& folder);

}  // namespace tacto::analysis
