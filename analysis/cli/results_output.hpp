// SPDX-License-Identifier: GPL-3.0-or-later
// Where verbs of this folder put what they found: NAME.results.json, NAME.html.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/report/report.hpp"
#include "data-schema/results/results.hpp"

namespace tacto::analysis {

/// A further kind of file that a verb can write: told by its ending; `ours` says of how a file begins whether
/// it may be replaced.
struct OutputKind {
  std::string ending;
  std::function<bool(std::string_view beginning)> ours;
  std::function<schema::Result<std::string>()> make;
};

/// That each may be written: .html (where `existing` says so, a file that begins with a doctype is replaced)
/// or .json (results are), or one of `more`. Errors: usage, for another ending, a file that is to be kept, or
/// one that would be lost.
schema::Result<void> check_outputs(const std::vector<std::string>& outputs, schema::Existing existing,
                                   std::span<const OutputKind> more = {});

/// All of them together, or none. `details` is what the verb prints with --json; verb, figures, pictures and
/// inputs are the caller's. Errors: those of `page`; cannot_write; usage, where
/// a file that is to be kept has a name.
schema::Result<void> write_outputs(const std::vector<std::string>& outputs, schema::Existing existing,
                                   schema::Results results, const cli::Report& details,
                                   const std::function<schema::Result<std::string>()>& page,
                                   std::span<const OutputKind> more = {});

}  // namespace tacto::analysis
