// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <set>
#include <string>

#include "data-schema/command/command.hpp"
#include "data-schema/files/embedded_files.hpp"

namespace tacto::cli {
namespace {

// The completions of a verb, by the option before the word, or "positional".
struct Taken {
  std::set<std::string> options = {"--json", "--progress", "--rows"};
  std::map<std::string, std::string> values, units;
};

std::string with_spaces(std::string text, const std::string& separators) {
  for (char& c : text)
    if (separators.find(c) != std::string::npos) c = ' ';
  return text;
}

// "a|b|c" as values, "NUMBER+UNIT(um, mm)" as units.
void add_type(const std::string& name, const std::string& type, Taken& taken) {
  const std::size_t open = type.find("+UNIT(");
  if (open != type.npos)
    taken.units[name] = with_spaces(type.substr(open + 6, type.find(')') - open - 6), ",");
  else if (type.find('|') != type.npos)
    taken.values[name] = with_spaces(type, "|");
}

// Also those of a verb's parts (calibrate tare).
void add_options(const CLI::App& app, Taken& taken) {
  for (const CLI::Option* option : app.get_options()) {
    std::vector<std::string> names;
    for (const auto& name : option->get_snames()) names.push_back("-" + name);
    for (const auto& name : option->get_lnames()) names.push_back("--" + name);
    taken.options.insert(names.begin(), names.end());
    if (option->get_positional()) names.emplace_back("positional");
    for (const std::string& name : names) add_type(name, option->get_type_name(), taken);
  }
  for (const CLI::App* part : app.get_subcommands({})) {
    taken.values["positional"] += part->get_name() + " ";
    add_options(*part, taken);
  }
}

Taken taken_by(const Verb& verb) {
  CLI::App app;
  const Action action = verb.declare(app);
  Taken taken;
  add_options(app, taken);
  return taken;
}

std::string presets() {
  constexpr std::string_view kEnding = ".transducer.json";
  std::string names;
  for (const auto& file : schema::embedded_files())
    if (const std::string_view name = file.name; name.ends_with(kEnding))
      names += fmt::format("{} ", name.substr(0, name.size() - kEnding.size()));
  return names;
}

// The first word of each of the topic's lines that begins with two spaces: "  surface     A, B ...".
std::string sim_keys(std::span<const HelpTopic* const> topics) {
  std::string keys, text = topic_text("sim", topics);
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    if (text.compare(at, 2, "  ") == 0 && text[at + 2] != ' ')
      keys += text.substr(at + 2, text.find(' ', at + 2) - at - 2) + "= ";
    at = end + 1;
  }
  return keys;
}

std::string cases_of(const Verb& verb) {
  const Taken taken = taken_by(verb);
  std::string cases;
  for (const auto& [option, values] : taken.values)
    cases += fmt::format("    \"{} {}\") values=\"{}\" ;;\n", verb.name, option, values);
  for (const auto& [option, units] : taken.units)
    cases += fmt::format("    \"{} {}\") units=\"{}\" ;;\n", verb.name, option, units);
  return cases;
}

// Bash breaks words at : and =, so the typed part of a device URI is taken from the line.
constexpr std::string_view kTail = R"(  esac
  local token=$word
  [ -n "$COMP_LINE" ] && token=${COMP_LINE:0:COMP_POINT} && token=${token##* }
  if [ "$COMP_CWORD" -eq 1 ]; then
    COMPREPLY=($(compgen -W "$verbs --help --version" -- "$word"))
  elif [ "$verb" = help ]; then
    COMPREPLY=($(compgen -W "$topics $verbs" -- "$word"))
  elif [[ "$token" == sim:* ]]; then
    local key=${token#sim:}; key=${key##*,}
    [[ "$key" == *=* ]] && COMPREPLY=() && return
    COMPREPLY=($(compgen -P "${word%"$key"}" -W "$sim_keys" -- "$key"))
    compopt -o nospace
  elif [[ "$word" == -* ]]; then
    COMPREPLY=($(compgen -W "$options" -- "$word"))
  elif [ "$previous" = --transducer ] || [ "$previous" = --start-from ]; then
    compopt -o default
    COMPREPLY=($(compgen -W "$presets" -- "$word"))
  elif [ "$previous" = -d ] || [ "$previous" = --device ]; then
    COMPREPLY=($(compgen -W "usb: tty: sim: replay:" -- "$word"))
    compopt -o nospace
  elif [ -n "$units" ] && [[ "$word" =~ ^-?[0-9.]+ ]]; then
    COMPREPLY=($(compgen -P "$BASH_REMATCH" -W "$units" -- "${word#"$BASH_REMATCH"}"))
  elif [ -n "$values" ]; then
    COMPREPLY=($(compgen -W "$values" -- "$word"))
  else
    compopt -o default
    COMPREPLY=()
  fi
}
complete -F _tactograph tactograph
)";

}  // namespace

std::string bash_completion(std::span<const Verb* const> verbs, std::span<const HelpTopic* const> topics) {
  std::string names = "completion help";
  for (const Verb* verb : verbs) names += " " + std::string(verb->name);
  std::string script = fmt::format(
      "# bash completion for tactograph; made by: tactograph completion\n_tactograph() {{\n"
      "  local word=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD-1]}} "
      "verb=${{COMP_WORDS[1]}}\n"
      "  local verbs=\"{}\" topics=\"{}\" presets=\"{}\" sim_keys=\"{}\"\n"
      "  local options=\"--help --version\" values= units= asked=\"$verb $previous\"\n"
      "  [ \"$COMP_CWORD\" -eq 2 ] && asked=\"$verb positional\"\n  case $verb in\n",
      names, fmt::join(topic_names(topics), " "), presets(), sim_keys(topics));
  for (const Verb* verb : verbs)
    script += fmt::format("    {}) options=\"{}\" ;;\n", verb->name, fmt::join(taken_by(*verb).options, " "));
  script += "  esac\n  case $asked in\n";
  for (const Verb* verb : verbs) script += cases_of(*verb);
  return script + std::string(kTail);
}

}  // namespace tacto::cli
