// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/command/verb.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "data-schema/base/nearest_word.hpp"
#include "data-schema/base/stroke_rule.hpp"
#include "data-schema/report/warnings.hpp"

namespace tacto::cli {
namespace {

std::string type_name(schema::Dimension dimension) {
  if (dimension == schema::Dimension::none) return "NUMBER";
  return "NUMBER+UNIT(" + schema::units_of(dimension) + ")";
}

double parsed(const std::string& name, const std::string& text, schema::Dimension dimension) {
  const auto value = schema::parse_quantity(text, dimension);
  if (!value) throw CLI::ValidationError(name, schema::message(value.error()));
  return *value;
}

}  // namespace

CLI::Option* add_quantity(CLI::App& app, const std::string& name, double& value_si,
                          schema::Dimension dimension, const std::string& help) {
  auto read = [name, &value_si, dimension](const std::string& text) {
    value_si = parsed(name, text, dimension);
  };
  return app.add_option_function<std::string>(name, read, help)
      ->type_name(type_name(dimension))
      ->default_str(schema::for_people(value_si, dimension));
}

CLI::Option* add_quantity(CLI::App& app, const std::string& name, std::optional<double>& value_si,
                          schema::Dimension dimension, const std::string& help) {
  auto read = [name, &value_si, dimension](const std::string& text) {
    value_si = parsed(name, text, dimension);
  };
  return app.add_option_function<std::string>(name, read, help)->type_name(type_name(dimension));
}

CLI::Option* add_gain(CLI::App& app, std::optional<schema::Gain>& gain, const std::string& before,
                      const std::string& default_words) {
  auto read = [&gain](const std::string& text) {
    const auto value = schema::parse_gain(text);
    if (!value) throw CLI::ValidationError("--gain", schema::message(value.error()));
    gain = *value;
  };
  return app
      .add_option_function<std::string>("--gain", read,
                                        fmt::format("{}{}{}", before, schema::kGainForms, default_words))
      ->type_name(fmt::format("NUMBER+UNIT(x, %, {})", schema::units_of(schema::Dimension::compliance)));
}

std::string words_of(const std::vector<std::string>& words) {
  return fmt::format("{}", fmt::join(words, "|"));
}

std::size_t choose(const std::string& option, const std::string& word,
                   const std::vector<std::string>& words) {
  const auto found = std::ranges::find(words, word);
  if (found == words.end())
    throw CLI::ValidationError(option,
                               fmt::format("'{}' is not a possible value{}: use one of {}", word,
                                           schema::did_you_mean(word, words), fmt::join(words, ", ")));
  return static_cast<std::size_t>(found - words.begin());
}

schema::Result<Report> run_verb(const Verb& verb, std::vector<std::string> words) {
  CLI::App app;
  const Action action = verb.declare(app);
  std::ranges::reverse(words);  // CLI11 takes them from the back
  try {
    app.parse(std::move(words));
  } catch (const CLI::ParseError& error) {
    return schema::fail(schema::ErrorKind::usage, error.what(), std::string(verb.name));
  }
  return action();
}

Action declare_parts(CLI::App& app, std::span<const VerbPart> parts) {
  auto actions = std::make_shared<std::vector<std::pair<CLI::App*, Action>>>();
  std::vector<std::string> names;
  for (const VerbPart& part : parts) {
    CLI::App* const one = app.add_subcommand(part.name, part.summary);
    actions->emplace_back(one, part.declare(*one));
    one->fallthrough();
    names.emplace_back(part.name);
  }
  app.require_subcommand(1);
  return [actions, names, &app]() -> schema::Result<Report> {
    for (const auto& [one, action] : *actions)
      if (one->parsed()) return action();
    return schema::fail(schema::ErrorKind::usage, "its part is missing", app.get_name(),
                        "give one of: " + words_of(names));
  };
}

void explain_strokes(CLI::App& app) {
  app.footer(app.get_footer() + fmt::format("\nA stroke is {}.", schema::kStrokeRule));
}

// CLI11's own message prints a range with 309 digits.
const CLI::Validator& from_one() {
  static const CLI::Validator kFromOne(
      [](std::string& text) {
        const bool digits = !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
        const bool fits = digits && text.find_first_not_of('0') != std::string::npos;
        return fits ? std::string() : fmt::format("'{}' is not a whole number of at least 1", text);
      },
      "POSITIVE");
  return kFromOne;
}

void warn(const std::string& text) {
  print_warning(text);
}

}  // namespace tacto::cli
