// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/command/command.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/ioctl.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <initializer_list>
#include <memory>
#include <string_view>

#include "data-schema/base/error.hpp"
#include "data-schema/base/format_version.hpp"
#include "data-schema/base/nearest_word.hpp"
#include "data-schema/base/unknown_note.hpp"
#include "data-schema/command/man_page.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/report/progress.hpp"
#include "data-schema/report/report_entries.hpp"
#include "data-schema/report/report_text.hpp"
#include "data-schema/report/terminal.hpp"
#include "data-schema/report/text_table.hpp"
#include "data-schema/report/warnings.hpp"
#include "data-schema/version.hpp"

namespace tacto::cli {
namespace {

std::string footer() {
  std::string text = "Exit codes:";
  for (std::size_t code = 0; code < std::size(kExitCodes); ++code)
    text += fmt::format(" {} {}{}", code, kExitCodes[code], code + 1 < std::size(kExitCodes) ? "," : ".");
  return text + "\nQuantities have a unit: 10mm, 15Hz, 0.5um, 4.5s, 15/mm, 50mm/s, 1mm/N.";
}

constexpr std::size_t kHelpColumn = 34;  // in which descriptions of options begin

using Verbs = std::span<const Verb* const>;
using Topics = std::span<const HelpTopic* const>;

struct Entry {
  CLI::App* app = nullptr;
  Action action;
  bool json = false;
  std::string rows;
};

// "all", or a number of rows.
std::string is_row_count(const std::string& text) {
  const bool number = !text.empty() && text.size() < 10 && text.find_first_not_of("0123456789") == text.npos;
  return text == "all" || (number && std::stoul(text) > 0)
             ? ""
             : "'" + text + "' is neither a number of rows nor all";
}

// Shows no default that is none: of an empty list, of an option that is required, and 0 where a count begins
// at 1.
void hide_empty_defaults(CLI::App& app) {
  for (CLI::Option* option : app.get_options()) {
    const std::string type = option->get_type_name(), shown = option->get_default_str();
    const bool from_one = type.find("POSITIVE") != type.npos || type.find("in [1 ") != type.npos;
    if (shown == "[]" || option->get_required() || (from_one && shown == "0")) option->default_str("");
  }
  for (CLI::App* part : app.get_subcommands({})) hide_empty_defaults(*part);
}

Entry declare(CLI::App& parent, const Verb& verb) {
  Entry entry;
  entry.app = parent.add_subcommand(std::string(verb.name), std::string(verb.summary));
  entry.app->footer(fmt::format("Example:\n  {}", verb.example));
  entry.action = verb.declare(*entry.app);
  hide_empty_defaults(*entry.app);
  return entry;
}

void add_output_options(Entry& entry) {
  entry.app->add_flag("--json", entry.json, "Print results and errors as JSON");
  entry.app->add_flag_callback("--progress", show_progress_lines,
                               "Print progress on stderr also if it is not a terminal");
  entry.app
      ->add_option("--rows", entry.rows,
                   "Rows of each table to print; default: on a terminal as many as fit, else all")
      ->type_name("N|all")
      ->check(is_row_count);
}

bool has_key(const Report& report, const std::string& key) {
  return std::ranges::any_of(ReportPrinter::entries(report),
                             [&](const auto& entry) { return entry.first == key; });
}

// On a terminal, tables stop at its height, less the line of the next prompt. In a file or pipe all is
// printed.
TextLimits limits_of(const Entry& entry) {
  TextLimits limits;
  winsize size{};
  if (isatty(STDOUT_FILENO) == 1 && ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_row > 1) {
    limits.columns = size.ws_col;
    limits.lines = size.ws_row - 1U;
  }
  if (entry.rows.empty()) return limits;
  limits.lines = 0;
  if (entry.rows != "all") limits.rows = std::stoul(entry.rows);
  return limits;
}

std::string printed(Report report, const Entry& entry) {
  if (!entry.json) return text_of(report, limits_of(entry));
  if (const auto warnings = all_warnings(); !warnings.empty() && !has_key(report, "warnings"))
    report.add("warnings", warnings);
  return report.json();
}

// One line on stderr, "tactograph: where: what (remedy)", or with `json` an object on one line: what, where,
// remedy, exit_code. Returns the exit code.
int print_error(const schema::Error& error, bool json) {
  const int code = schema::exit_code(error.kind);
  if (!json) {
    write_message(fmt::format("tactograph: {}\n", on_one_line(schema::message(error))));
    return code;
  }
  Report object;
  object.add("what", error.what).add("where", error.where).add("remedy", error.remedy).add("exit_code", code);
  write_message(json_line(object));
  return code;
}

// Whether the arguments ask for JSON: needed before they are parsed, because parsing may fail.
bool asks_for_json(int argc, const char* const* argv) {
  for (int i = 1; i < argc && std::string_view(argv[i]) != "--"; ++i)
    if (std::string_view(argv[i]) == "--json") return true;
  return false;
}

// A full disk or a closed pipe behind stdout is a failure to write.
int print_report(const Report& report, const Entry& entry) {
  const std::string text = printed(report, entry);
  const bool written =
      std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
  if (!written)
    return print_error({schema::ErrorKind::cannot_write, "the result could not be written", "stdout", ""},
                       entry.json);
  return report.exit_code();
}

int print_written(const schema::Result<void>& written, bool json) {
  return written ? 0 : print_error(written.error(), json);
}

// A verb that uses a file may have named it with its unknown members.
void warn_of_newer_versions() {
  const auto before = all_warnings();
  for (const auto& [file, version] : schema::newer_versions())
    if (std::ranges::none_of(before,
                             [&](const auto& note) { return schema::is_note_on(note, file, version); }))
      print_warning(schema::unknown_note(file, version, {}));
}

int act(const Entry& entry) {
  const auto report = entry.action();
  warn_of_newer_versions();
  if (!report) return print_error(report.error(), entry.json);
  return print_report(*report, entry);
}

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

using Words = std::span<const char* const>;

std::vector<std::string> names_of(const std::vector<const CLI::App*>& apps) {
  std::vector<std::string> names;
  for (const CLI::App* app : apps) names.push_back(app->get_name());
  return names;
}

// "-device", which is read as -d with the value "evice".
std::string with_one_hyphen(const CLI::App& verb, Words words) {
  const auto names = option_names(verb);
  for (const std::string_view word : words)
    if (word.size() > 2 && word[0] == '-' && std::ranges::find(names, "-" + std::string(word)) != names.end())
      return fmt::format("there is no option '{}' (did you mean '-{}'?)", word, word);
  return "";
}

// The part of a verb that was typed, as in 'experiment fitt'.
std::string unknown_part(const CLI::App& app, const CLI::App& verb) {
  const auto parts = names_of(verb.get_subcommands({}));
  if (&verb == &app || parts.empty() || !verb.get_subcommands().empty()) return "";
  const auto rest = app.remaining(true);
  if (rest.empty())
    return fmt::format("'{}' is followed by one of {}", verb.get_name(), fmt::join(parts, ", "));
  return fmt::format("there is no '{} {}'{}; it is followed by one of {}", verb.get_name(), rest.front(),
                     schema::did_you_mean(rest.front(), parts), fmt::join(parts, ", "));
}

// An option with a name, on the words of the error; nullptr if there is none.
const CLI::Option* option_in(const CLI::App& verb, const std::string& what) {
  for (const CLI::Option* option : verb.get_options())
    if (const std::string name = option->get_name(option->get_positional());
        !name.empty() && (what == name || what.starts_with(name + ":") || what.starts_with(name + " ")))
      return option;
  return nullptr;
}

// An unknown option, with the one that was probably meant; an unknown part of a verb; for an option or
// argument that is required, "'--device' is missing: " and its description, the same for an option without
// its value; else CLI11's own words.
std::string fault_of(const CLI::App& app, const CLI::App& verb, const CLI::ParseError& error, Words words) {
  if (const std::string hyphen = with_one_hyphen(verb, words); !hyphen.empty()) return hyphen;
  for (const std::string& argument : app.remaining(true))
    if (argument.starts_with("--")) {
      const std::string name = argument.substr(0, argument.find('='));
      return fmt::format("there is no option '{}'{}", name, schema::did_you_mean(name, option_names(verb)));
    }
  if (const std::string part = unknown_part(app, verb); !part.empty()) return part;
  const std::string what = error.what();
  const CLI::Option* option = option_in(verb, what);
  if (option == nullptr) return what;
  const std::string name = option->get_name(option->get_positional());
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr && option->count() == 0)
    return fmt::format("'{}' has no value: {}", name, option->get_description());
  if (dynamic_cast<const CLI::RequiredError*>(&error) == nullptr) return what;
  std::vector<std::string> missing;
  for (const CLI::Option* each : verb.get_options())
    if (each->get_required() && each->count() == 0)
      missing.push_back(fmt::format("'{}' is missing: {}", each->get_name(each->get_positional()),
                                    each->get_description()));
  return missing.empty() ? what : fmt::format("{}", fmt::join(missing, "; "));
}

// On a terminal, an option's description wraps beside its name; a command line of an example stays whole.
std::string wrapped_help(const std::string& text) {
  winsize size{};
  if (isatty(STDOUT_FILENO) != 1 || ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0) return text;
  const std::size_t columns = size.ws_col;
  std::string wrapped;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string line = text.substr(at, end - at);
    at = end + 1;
    const bool beside = line.size() > kHelpColumn && line[kHelpColumn - 1] == ' ' && line.starts_with("  ");
    const std::size_t indent = beside ? kHelpColumn : 0;
    if (line.size() <= columns || columns < 2 * kHelpColumn || line.starts_with("  tactograph ")) {
      wrapped += line + "\n";
      continue;
    }
    std::string before = line.substr(0, indent);
    for (const std::string& part : wrapped_text(line.substr(indent), columns - indent)) {
      wrapped += before + part + "\n";
      before = std::string(indent, ' ');
    }
  }
  return wrapped;
}

int print_text(const std::string& text) {
  return std::fputs(text.c_str(), stdout) < 0 ? schema::exit_code(schema::ErrorKind::cannot_write) : 0;
}

int print_parse_error(const CLI::App& app, const CLI::ParseError& error, Words words, bool json) {
  if (dynamic_cast<const CLI::CallForHelp*>(&error) != nullptr) return print_text(wrapped_help(app.help()));
  if (error.get_exit_code() == 0) return app.exit(error);  // --version arrives here too
  const CLI::App* verb = &app;
  std::string name;
  for (auto parsed = app.get_subcommands(); !parsed.empty(); parsed = verb->get_subcommands()) {
    verb = parsed.front();
    name += verb->get_name() + " ";
  }
  return print_error({schema::ErrorKind::usage, fault_of(app, *verb, error, words), "",
                      fmt::format("see 'tactograph {}--help'", name)},
                     json);
}

void describe(CLI::App& app, Topics topics) {
  app.footer(fmt::format("Help on a verb or a topic ({}): tactograph help TOPIC\n{}",
                         fmt::join(topic_names(topics), ", "), footer()));
  app.set_version_flag("--version", std::string(kCreator));
  app.require_subcommand(1);
  app.get_formatter()->column_width(kHelpColumn);
  app.option_defaults()->always_capture_default();
}

std::vector<std::string> verb_names(Verbs verbs) {
  std::vector<std::string> names;
  for (const Verb* verb : verbs) names.emplace_back(verb->name);
  names.insert(names.end(), {"help", "completion", "man-pages"});
  return names;
}

// CLI11's own message says only that a subcommand is required.
bool is_unknown_verb(Verbs verbs, std::string_view word) {
  const auto names = verb_names(verbs);
  return !word.starts_with('-') && std::ranges::find(names, word) == names.end();
}

int refuse_verb(Verbs verbs, const std::string& what, bool json) {
  return print_error({schema::ErrorKind::usage, what, "",
                      fmt::format("the verbs are: {}; 'tactograph help' describes them",
                                  fmt::join(verb_names(verbs), ", "))},
                     json);
}

// Help of a verb or a topic, or, without a word, of everything.
int print_help(const CLI::App& app, const std::string& word, Topics topics, bool json) {
  // app.help() would be that of the verb that was parsed, of `help`.
  if (word.empty())
    return print_text(
        wrapped_help(app.get_formatter()->make_help(&app, app.get_name(), CLI::AppFormatMode::Normal) +
                     "\nTopics of 'tactograph help':\n" + topics_text(topics)));
  for (const CLI::App* verb : app.get_subcommands({}))
    if (verb->get_name() == word) return print_text(wrapped_help(verb->help(app.get_name())));
  if (const std::string text = topic_text(word, topics); !text.empty()) return print_text(text);
  auto known = topic_names(topics);
  const std::string listed = fmt::format("the topics are: {}, and each verb", fmt::join(known, ", "));
  for (const CLI::App* verb : app.get_subcommands({})) known.push_back(verb->get_name());
  return print_error(
      {schema::ErrorKind::usage,
       fmt::format("there is no help on '{}'{}", word, schema::did_you_mean(word, known)), "", listed},
      json);
}

// Verbs that end in another way (record) set handlers of their own.
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

constexpr std::size_t kUsual = 10;
using Names = std::initializer_list<std::string_view>;

struct UsualOptions {
  std::string_view verb;
  Names names;
};

// With --help and --json, which every verb has: ten.
const UsualOptions kUsualOptions[] = {
    {"import", {"output", "channel", "rate", "time-column", "pitch", "speed", "surface", "force"}},
    {"record", {"device", "output", "template", "time", "strokes", "subject", "finger", "surface"}},
    {"spatial", {"output", "list", "stroke", "from", "to", "band", "grid", "average"}},
    {"spectrogram",
     {"output", "window", "resolution", "min-frequency", "max-frequency", "formants", "dynamic-range"}},
    {"formants", {"output", "force", "prominence", "go-on", "shortest", "bridge", "window", "max-frequency"}},
    {"sheet",
     {"output", "title", "columns", "formants", "window", "min-frequency", "max-frequency", "dynamic-range"}},
    {"transform", {"output", "stretch", "keep-slope", "period", "gain", "band", "weights", "force"}},
    {"render", {"finger-path", "output", "transducer", "device", "gain", "rate", "at", "ends"}},
    {"explain", {"speed", "transducer", "device", "rate", "ends", "quality", "board", "interpolation"}},
    {"play", {"device", "output", "transducer", "time", "gain", "at", "ends", "finger-path"}},
    {"ctl", {"socket", "at", "gain", "ends", "fade", "save", "time"}},
    {"compare", {"a", "b", "output", "tolerance", "align", "max-shift", "stroke-a", "stroke-b"}},
    {"design", {"device", "hand", "rate", "speed", "output", "table", "z-width", "force"}},
    {"fidelity", {"device", "transducer", "speed", "time", "gain", "output", "force", "rate"}},
    {"trade", {"output", "transducer", "stroke", "force", "calibrate", "device", "hand", "finger-path"}},
    {"identify", {"device", "output", "start-from", "method", "picture", "results", "second-mode", "finger"}},
};

struct Heading {
  std::string_view text;
  Names names;
};

// An option has the same meaning in every verb.
const Heading kHeadings[] = {
    {"Strokes and alignment",
     {"channel", "stroke", "from", "to", "finger-up", "both-ways", "align", "align-range", "max-shift"}},
    {"Filter and grid",
     {"band", "band-in", "low", "high", "filter", "order", "edges", "grid", "method", "equalise"}},
    {"Spectrum",
     {"window", "hop", "padding", "detrend", "scaling", "spectrum-window", "max-frequency", "min-frequency",
      "compress"}},
    {"Speed against accuracy", {"quality", "max-error", "explain", "max-tick"}},
    {"Drive computation",
     {"interpolation", "inverse", "reconstruction", "cutoff", "hold", "keep-hysteresis", "no-look-ahead",
      "engine", "encoder-step", "rate", "loop", "onset", "target", "displacement"}},
    {"Limits", {"energy-limit", "energy-window", "over-limit", "contact", "contact-off"}},
    {"Mesh or volume", {"unit", "repair", "open"}},
    {"Stored in the file", {"subject", "finger", "surface", "notes", "humidity", "date", "calibrated"}},
    {"Calibration", {"calibration", "no-calibration", "stale-after"}},
    {"Measuring and tables",
     {"amplitude", "frequencies", "lag", "fit-on", "amplitude-unit", "phase-unit", "phase-sign", "invert",
      "input", "output-channel"}},
};

bool holds(const Names& names, const CLI::Option& option) {
  return std::ranges::any_of(option.get_lnames(), [&](const std::string& name) {
    return std::ranges::find(names, name) != names.end();
  });
}

std::string heading_of(const CLI::Option& option) {
  for (const Heading& heading : kHeadings)
    if (holds(heading.names, option)) return std::string(heading.text);
  return "More options";
}

bool is_usual(std::string_view verb, const CLI::Option& option) {
  if (holds({"help", "json"}, option)) return true;
  const auto found = std::ranges::find(kUsualOptions, verb, &UsualOptions::verb);
  return found != std::end(kUsualOptions) && holds(found->names, option);
}

// For a verb with more than ten options: the usual ones, ten at most, come first; the others are below a
// heading for each subject. Call it after all options are declared.
void put_below_headings(std::string_view verb, CLI::App& app) {
  std::vector<CLI::Option*> named;
  for (CLI::Option* option : app.get_options())
    if (!option->get_positional() && !option->get_group().empty()) named.push_back(option);  // no hidden ones
  if (named.size() <= kUsual) return;
  for (CLI::Option* option : named)
    option->group(is_usual(verb, *option) ? "Usual options" : heading_of(*option));
}

}  // namespace

int run_command(std::span<const VerbGroup> groups, int argc, const char* const* argv, Topics topics) {
  handle_signals();
  std::vector<const Verb*> verbs;
  for (const VerbGroup& group : groups) verbs.insert(verbs.end(), group.verbs.begin(), group.verbs.end());
  const bool json = asks_for_json(argc, argv);
  if (argc < 2) return refuse_verb(verbs, "a verb is missing", json);
  if (is_unknown_verb(verbs, argv[1]))
    return refuse_verb(
        verbs,
        fmt::format("there is no verb '{}'{}", argv[1], schema::did_you_mean(argv[1], verb_names(verbs))),
        json);
  CLI::App app(
      "Records how a surface pulls on a finger, turns it into force against position, and plays it back.",
      "tactograph");
  describe(app, topics);
  std::vector<std::unique_ptr<Entry>> entries;
  for (const VerbGroup& group : groups)
    for (const Verb* verb : group.verbs) {
      entries.push_back(std::make_unique<Entry>(declare(app, *verb)));
      entries.back()->app->group(group.heading);
      add_output_options(*entries.back());
      put_below_headings(verb->name, *entries.back()->app);
    }
  CLI::App* help = app.add_subcommand("help", "Show help on a verb or a topic");
  std::string word;
  help->add_option("TOPIC", word, "A verb or a topic");
  CLI::App* completion = app.add_subcommand("completion", "Print the bash completion script");
  completion->footer("Example:\n  tactograph completion > /etc/bash_completion.d/tactograph");
  CLI::App* manual = app.add_subcommand("man-pages", "Write the manual pages into a folder");
  std::string manual_folder;
  std::vector<std::string> programs;
  manual->add_option("FOLDER", manual_folder, "The folder, such as /usr/share/man")->required();
  manual->add_option("PROGRAM", programs, "Other programs of tactograph, whose --help becomes a page, too");
  hide_empty_defaults(*manual);
  manual->footer("Example:\n  tactograph man-pages /usr/local/share/man /usr/bin/tactographd");
  try {
    app.parse(argc, argv);
    if (help->parsed()) return print_help(app, word, topics, json);
    if (manual->parsed()) return print_written(write_man_pages(manual_folder, app, topics, programs), json);
    if (completion->parsed()) return print_text(bash_completion(verbs, topics));
    for (const auto& entry : entries)
      if (entry->app->parsed()) return act(*entry);
  } catch (const CLI::ParseError& error) {
    return print_parse_error(app, error, {argv, static_cast<std::size_t>(argc)}, json);
  } catch (const std::exception& error) {
    return print_error({schema::ErrorKind::internal, error.what(), "internal error", "please report it"},
                       json);
  }
  return 0;
}

}  // namespace tacto::cli
