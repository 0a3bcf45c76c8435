// SPDX-License-Identifier: GPL-3.0-or-later
// A corpus as a dataset to give away: recordings and results, a table, checksums and an RO-Crate.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "data-schema/base/error.hpp"
#include "data-schema/exchange/ro_crate.hpp"
#include "data-schema/files/files.hpp"

namespace tacto::analysis {

struct CorpusPackOptions {
  std::string study, output;
  bool with_subjects = false;
  schema::Existing existing =
      schema::Existing::keep;  ///< replaces only a folder in which all files are as `pack` wrote them
  schema::Citation citation;
};

struct CorpusPack {
  std::size_t recordings = 0;  ///< in the table
  std::size_t left_out = 0;    ///< of these without files: unreadable, or changed since their sidecar
  std::size_t renamed = 0;     ///< because a subject's code was in the name
  std::size_t files = 0;
};

/// OUTPUT/recordings/NUMBER/ holds a recording with its results, OUTPUT/recordings.csv all recordings,
/// SHA256SUMS all checksums, ro-crate-metadata.json the description. It is written beside OUTPUT and renamed
/// at the end. Without `with_subjects` the codes of all subjects of the recordings are removed (see
/// SubjectCodes), and a name that contains one becomes the recording's number. Errors: usage; of the plan;
/// unsuitable: units are missing, recordings have changed, a WAV has text with a code; cannot_write.
schema::Result<CorpusPack> pack_corpus(const CorpusPackOptions& options,
                                       const std::function<void(double)>& progress,
                                       const std::function<bool()>& stopped);

}  // namespace tacto::analysis
