// SPDX-License-Identifier: GPL-3.0-or-later
// Everything that is wrong with a file of ours, not only the first fault that a reader would stop at.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/kinds/file_kind.hpp"

namespace tacto::schema {

/// One fault: a file, with JSON pointer ("oak.json#/channels/0/unit") or channel and sample; and what is
/// wrong there.
struct Finding {
  std::string where;
  std::string what;
};

struct Checked {
  std::vector<Finding> findings;  ///< none where the file is sound
  std::string newer_version;      ///< where its minor version is newer than ours
  std::string note = {};          ///< what could not be checked, and why
};

/// Compares a file with its schema, its samples and its checksum. `progress`, where given, hears fractions
/// from 0 to 1. Errors: not_found (the file itself), unsupported_version; all else is a finding.
Result<Checked> check_file(const StoredFile& file, const std::function<void(double)>& progress = {});

}  // namespace tacto::schema
