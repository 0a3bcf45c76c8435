// SPDX-License-Identifier: GPL-3.0-or-later
// Many warnings of one kind as one line.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"

namespace tacto::cli {

/// A warning about one of several things. Warnings of one `kind` differ in size only; a warning without a
/// kind is printed by itself.
struct Warning {
  std::string about;  ///< the file or stroke; may be empty
  std::string text;
  std::string kind = {};
  double size = 0;  ///< the largest of a kind is the worst
};

/// "about: text"
std::string sentence(const Warning& warning);

/// Prints them on stderr, one for each kind. All of them are in the report with --json.
void warn_grouped(std::span<const Warning> warnings);

/// The same for sentences: those that differ only in their numbers are of one kind, of which the first is
/// printed.
void warn_grouped(std::span<const std::string> sentences);

/// Errors that differ only in place and numbers become one, the first, with the number of places and
/// the first five of them.
std::vector<schema::Error> by_cause(std::span<const schema::Error> errors);

/// All warnings of this run, each of them, in order: what --json lists.
std::vector<std::string> all_warnings();

/// Prints it, and adds it to all_warnings().
void print_warning(const std::string& text);

}  // namespace tacto::cli
