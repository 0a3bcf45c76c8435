// SPDX-License-Identifier: GPL-3.0-or-later
// Writes the results of this folder's verbs: NAME.results.json, NAME.html.
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

/// A further kind of file that a verb can write, recognised by its ending. `ours` says, from the beginning of
/// an existing file, whether it may be replaced.
struct OutputKind {
  std::string ending;
  std::function<bool(std::string_view beginning)> ours;
  std::function<schema::Result<std::string>()> make;
};

/// Checks that each output may be written: .html, .json or one of `more`. If `existing` allows it, an HTML
/// file that begins with a doctype and a results file are replaced. Errors: usage: another ending, a file
/// that must be kept, or one that another output would overwrite.
schema::Result<void> check_outputs(const std::vector<std::string>& outputs, schema::Existing existing,
                                   std::span<const OutputKind> more = {});

/// Writes all outputs or none. `details` is what the verb prints with --json; the caller sets verb, figures,
/// pictures and inputs. Errors: those of `page`; cannot_write; usage: a file that must be kept has one of the
/// names.
schema::Result<void> write_outputs(const std::vector<std::string>& outputs, schema::Existing existing,
                                   schema::Results results, const cli::Report& details,
                                   const std::function<schema::Result<std::string>()>& page,
                                   std::span<const OutputKind> more = {});

}  // namespace tacto::analysis
