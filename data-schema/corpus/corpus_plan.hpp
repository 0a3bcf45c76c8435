// SPDX-License-Identifier: GPL-3.0-or-later
// The plan of a corpus: which steps are computed of which recordings. NAME.corpus.json.
#pragma once

#include <string>
#include <vector>

#include "data-schema/base/error.hpp"

namespace tacto::schema {

struct CorpusStep {
  std::string step;     ///< the verb: "spatial", "describe"
  std::string options;  ///< as on its command line
};

struct CorpusRecording {
  std::string path;    ///< of the sidecar; a relative one starts at the folder of the plan
  std::string sha256;  ///< of the sidecar, which contains that of its WAV
};

struct CorpusPlan {
  std::vector<CorpusStep> steps;  ///< spatial, then perhaps describe
  std::vector<CorpusRecording> recordings;
  std::string created, creator;  ///< the creator's version is part of each result's key
  std::string extra_json;
  std::string newer_version;
  std::vector<std::string> unknown_members = {};
};

/// Errors: not_found; malformed, also for unknown members and steps in another order; unsupported_version.
Result<CorpusPlan> read_corpus_plan(const std::string& path);

/// The file's text. Errors: unsuitable, where the schema does not allow it.
Result<std::string> corpus_plan_json(const CorpusPlan& plan);

}  // namespace tacto::schema
