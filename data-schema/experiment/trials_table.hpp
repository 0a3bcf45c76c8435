// SPDX-License-Identifier: GPL-3.0-or-later
// What the columns of STUDY-P07.trials.tsv mean.
#pragma once

#include <string>

namespace tacto::schema {

struct TrialsColumn {
  std::string description;
  std::string units;  ///< of a number: "1", "dB", "s"; else empty
};

/// As trials_table.schema.json says, also of the columns that an export adds. Precondition: there is such a
/// column.
TrialsColumn trials_column(const std::string& name);

}  // namespace tacto::schema
