// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/cli/command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <memory>

#include "data-schema/cli/harmless.hpp"
#include "data-schema/cli/talk.hpp"
#include "data-schema/files.hpp"
#include "data-schema/version.hpp"

namespace tacto::cli {
namespace {

constexpr std::string_view kExitCodes =
    "Exit codes: 0 done, 1 internal error, 2 command line, 3 file or device not found, 4 malformed file,\n"
    "5 data that the job can't work on, 6 file of a newer version, 7 can't write, 8 device failed.\n"
    "Quantities carry their unit: 10mm, 15Hz, 0.5um, 4.5s, 15/mm, 50mm/s, 1mm/N.";

struct Entry {
  CLI::App* app = nullptr;
  Action action;
  bool json = false;
};

Entry declare(CLI::App& parent, const Verb& verb) {
  Entry entry;
  entry.app = parent.add_subcommand(std::string(verb.name), std::string(verb.summary));
  entry.app->footer(fmt::format("Example:\n  {}", verb.example));
  entry.action = verb.declare(*entry.app);
  return entry;
}

int print_error(const schema::Error& error) {
  talk(fmt::format("tactograph: {}\n", on_one_line(schema::message(error))));
  return schema::exit_code(error.fault);
}

// A full disk or a closed pipe behind stdout is a failure to write like any other.
int print_report(const Report& report, bool json) {
  const std::string text = json ? report.json() : report.for_people();
  const bool written =
      std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
  if (!written)
    return print_error({schema::Fault::cannot_write, "the result could not be written", "stdout", ""});
  return report.exit_code();
}

int act(const Entry& entry) {
  const auto report = entry.action();
  if (!report) return print_error(report.error());
  return print_report(*report, entry.json);
}

int print_parse_error(const CLI::App& app, const CLI::ParseError& error) {
  if (error.get_exit_code() == 0) return app.exit(error);  // --help and --version arrive here too
  talk(fmt::format("tactograph: {}; see 'tactograph {}--help'\n", error.what(),
                   app.get_subcommands().empty() ? "" : app.get_subcommands().front()->get_name() + " "));
  return schema::exit_code(schema::Fault::usage);
}

void describe(CLI::App& app) {
  app.footer(std::string(kExitCodes));
  app.set_version_flag("--version", std::string(kCreator));
  app.require_subcommand(1);
  app.get_formatter()->column_width(34);
  app.option_defaults()->always_capture_default();
}

// CLI11 would only say that a subcommand is required.
bool is_unknown_verb(std::span<const Verb* const> verbs, std::string_view word) {
  const auto named = [&](const Verb* verb) { return verb->name == word; };
  return !word.starts_with('-') && word != "completion" && std::ranges::none_of(verbs, named);
}

int refuse_verb(std::span<const Verb* const> verbs, std::string_view word) {
  std::string names = "completion";
  for (const Verb* verb : verbs) names += fmt::format(", {}", verb->name);
  return print_error(
      {schema::Fault::usage, fmt::format("there is no verb '{}'", word), "", "the verbs are: " + names});
}

// Verbs that end in another way when asked (record) have handlers of their own meanwhile.
void leave_nothing_behind(int signal) {
  schema::remove_pending_files();
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

void handle_signals() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP})
    if (std::signal(signal, leave_nothing_behind) == SIG_IGN) std::signal(signal, SIG_IGN);  // nohup
  std::signal(SIGXFSZ,
              SIG_IGN);  // a file beyond the shell's limit is then an error of writing, as a full disk is
}

}  // namespace

int run_command(std::span<const Verb* const> verbs, int argc, const char* const* argv) {
  handle_signals();
  if (argc > 1 && is_unknown_verb(verbs, argv[1])) return refuse_verb(verbs, argv[1]);
  CLI::App app(
      "Records how a surface pulls on a finger, turns it into force against position, and plays it back.",
      "tactograph");
  describe(app);
  std::vector<std::unique_ptr<Entry>> entries;
  for (const Verb* verb : verbs) {
    entries.push_back(std::make_unique<Entry>(declare(app, *verb)));
    entries.back()->app->add_flag("--json", entries.back()->json, "Print the result as JSON");
  }
  CLI::App* completion = app.add_subcommand("completion", "Print the bash completion script");
  completion->footer("Example:\n  tactograph completion > /etc/bash_completion.d/tactograph");
  try {
    app.parse(argc, argv);
    if (completion->parsed()) return std::fputs(bash_completion(verbs).c_str(), stdout) < 0 ? 7 : 0;
    for (const auto& entry : entries)
      if (entry->app->parsed()) return act(*entry);
  } catch (const CLI::ParseError& error) {
    return print_parse_error(app, error);
  } catch (const std::exception& error) {
    return print_error({schema::Fault::internal, error.what(), "internal error", "please report it"});
  }
  return 0;
}

}  // namespace tacto::cli
