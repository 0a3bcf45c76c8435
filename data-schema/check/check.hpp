// SPDX-License-Identifier: GPL-3.0-or-later
// All faults of a stored file, not only the first one, at which a reader stops.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/kinds/file_kind.hpp"

namespace tacto::schema {

/// One fault: the place (a file, with JSON pointer ("oak.json#/channels/0/unit") or channel and sample) and
/// the fault.
struct Finding {
  std::string where;
  std::string what;
};

struct Checked {
  std::vector<Finding> findings;  ///< empty if the file is correct
  std::string newer_version;      ///< if its minor version is newer than ours
  std::vector<std::string> unknown_members = {};
};

/// Compares a file with its schema, its samples and its checksum. `progress`, if given, gets fractions from 0
/// to 1. Errors: not_found (the file itself), unsupported_version; everything else is a finding.
Result<Checked> check_file(const StoredFile& file, const std::function<void(double)>& progress = {});

}  // namespace tacto::schema
