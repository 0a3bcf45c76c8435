// SPDX-License-Identifier: GPL-3.0-or-later
// A verb of the command line: its entry in the table, and how it declares options with units.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/base/gain.hpp"
#include "data-schema/base/quantity.hpp"
#include "data-schema/report/report.hpp"

namespace tacto::cli {

/// The work of a verb after its options are read: gives the report for stdout, or the error for stderr and
/// the exit code.
using Action = std::function<schema::Result<Report>()>;

/// An entry of the table in tactograph.cpp. `declare` adds the options to `app`, stores their values in an
/// object shared with the action, and returns the action.
struct Verb {
  std::string_view name;
  std::string_view summary;
  std::string_view example;  ///< shown by --help; one or more command lines
  Action (*declare)(CLI::App& app);
};

/// Runs a verb in this process, as if its words had been typed, and gives the report that it would print.
/// Errors: usage, of the words; those of the verb.
schema::Result<Report> run_verb(const Verb& verb, std::vector<std::string> words);

/// A part of a verb, as `init` of `corpus`: declared and run like a verb.
struct VerbPart {
  const char *name, *summary;
  Action (*declare)(CLI::App& app);
};

/// Declares the parts as subcommands, of which one must be given; runs that one. They accept --json and
/// --rows of the verb behind their own options, too.
Action declare_parts(CLI::App& app, std::span<const VerbPart> parts);

/// An option that takes a number with a unit of `dimension`; bare numbers are refused by name of the fitting
/// units.
CLI::Option* add_quantity(CLI::App& app, const std::string& name, double& value_si,
                          schema::Dimension dimension, const std::string& help);
CLI::Option* add_quantity(CLI::App& app, const std::string& name, std::optional<double>& value_si,
                          schema::Dimension dimension, const std::string& help);

/// --gain, with the same forms in every verb (kGainForms). `before` stands before its help, `default_words`
/// after it.
CLI::Option* add_gain(CLI::App& app, std::optional<schema::Gain>& gain, const std::string& before,
                      const std::string& default_words);

/// The words of an option and their meanings; the first with the current value is shown as default.
template <class Choice>
using Choices = std::vector<std::pair<std::string, Choice>>;

/// "a|b|c"
std::string words_of(const std::vector<std::string>& words);
/// The word's index. Throws CLI::ValidationError, with the words there are: for use in an option's callback
/// only.
std::size_t choose(const std::string& option, const std::string& word, const std::vector<std::string>& words);

/// An option with one of several words as its value.
template <class Choice>
CLI::Option* add_choice(CLI::App& app, const std::string& name, Choice& value, const Choices<Choice>& choices,
                        const std::string& help) {
  std::vector<std::string> words;
  std::string standard;
  for (const auto& [word, meaning] : choices) {
    words.push_back(word);
    if (meaning == value && standard.empty()) standard = word;
  }
  auto read = [name, words, choices, &value](const std::string& word) {
    value = choices[choose(name, word, words)].second;
  };
  return app.add_option_function<std::string>(name, read, help)
      ->type_name(words_of(words))
      ->default_str(standard);
}

/// Adds the definition of a stroke below the help of a verb.
void explain_strokes(CLI::App& app);

/// For an option that is a count: a whole number from 1.
const CLI::Validator& from_one();

/// One line to stderr: a warning; the work continues.
void warn(const std::string& text);

}  // namespace tacto::cli
