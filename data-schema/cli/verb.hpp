// SPDX-License-Identifier: GPL-3.0-or-later
// A verb of the command line: its entry in the table, and how it declares options with units.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "data-schema/cli/report.hpp"
#include "data-schema/error.hpp"
#include "data-schema/quantity.hpp"

namespace tacto::cli {

/// What a verb does once its options are read: the report for stdout, or the error for stderr and the exit
/// code.
using Action = std::function<schema::Result<Report>()>;

/// An entry of the table in tactograph.cpp. `declare` adds the options to `app`, keeps their values in an
/// object that the action shares, and gives the action.
struct Verb {
  std::string_view name;
  std::string_view summary;
  std::string_view example;  ///< shown by --help; one or more command lines
  Action (*declare)(CLI::App& app);
};

/// An option that takes a number with a unit of `dimension`; bare numbers are refused by name of the fitting
/// units.
CLI::Option* add_quantity(CLI::App& app, const std::string& name, double& value_si,
                          schema::Dimension dimension, const std::string& help);
CLI::Option* add_quantity(CLI::App& app, const std::string& name, std::optional<double>& value_si,
                          schema::Dimension dimension, const std::string& help);

/// One line to stderr: what the user should know although the job goes on.
void warn(const std::string& text);

}  // namespace tacto::cli
