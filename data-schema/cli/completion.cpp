// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <set>
#include <string>

#include "data-schema/cli/command.hpp"

namespace tacto::cli {
namespace {

void add_names(const CLI::App& app, std::set<std::string>& names) {
  for (const CLI::Option* option : app.get_options()) {
    for (const auto& name : option->get_snames()) names.insert("-" + name);
    for (const auto& name : option->get_lnames()) names.insert("--" + name);
  }
  for (const CLI::App* part : app.get_subcommands({})) add_names(*part, names);
}

// Those of a verb's parts too (calibrate tare).
std::string option_names(const Verb& verb) {
  CLI::App app;
  const Action action = verb.declare(app);
  std::set<std::string> names = {"--json"};
  add_names(app, names);
  return fmt::format("{}", fmt::join(names, " "));
}

constexpr std::string_view kTail = R"(    *) options="--help --version" ;;
  esac
  if [ "$COMP_CWORD" -eq 1 ]; then
    COMPREPLY=($(compgen -W "$verbs --help --version" -- "$word"))
  elif [[ "$word" == -* ]]; then
    COMPREPLY=($(compgen -W "$options" -- "$word"))
  else
    compopt -o default
    COMPREPLY=()
  fi
}
complete -F _tactograph tactograph
)";

}  // namespace

std::string bash_completion(std::span<const Verb* const> verbs) {
  std::string names = "completion";
  for (const Verb* verb : verbs) names += " " + std::string(verb->name);
  std::string script = fmt::format(
      "# bash completion for tactograph; made by: tactograph completion\n_tactograph() {{\n"
      "  local word=${{COMP_WORDS[COMP_CWORD]}} verbs=\"{}\" options\n  case ${{COMP_WORDS[1]}} in\n",
      names);
  for (const Verb* verb : verbs)
    script += fmt::format("    {}) options=\"{}\" ;;\n", verb->name, option_names(*verb));
  return script + std::string(kTail);
}

}  // namespace tacto::cli
