// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/command/man_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "data-schema/base/creation_time.hpp"
#include "data-schema/version.hpp"

namespace tacto::cli {
namespace {

using schema::ErrorKind;
using schema::Result;

// A page's name and section ("tactograph-spatial", '1'), and its text in roff (man macros).
struct ManPage {
  std::string name;
  char section;
  std::string text;
};

// A backslash begins a request, a hyphen would become a typographic one, and a line's first dot or quote
// would make it a macro.
std::string roff(std::string_view text) {
  std::string escaped;
  for (const char letter : text) {
    const bool line_begins = escaped.empty() || escaped.back() == '\n';
    if (line_begins && (letter == '.' || letter == '\'')) escaped += "\\&";
    if (letter == '\\')
      escaped += "\\e";
    else if (letter == '-')
      escaped += "\\-";
    else
      escaped += letter;
  }
  return escaped;
}

std::string heading(std::string_view name, char section, std::string_view summary) {
  std::string upper(name);
  std::ranges::transform(upper, upper.begin(),
                         [](unsigned char letter) { return static_cast<char>(std::toupper(letter)); });
  return fmt::format(".TH {} {} {} \"{}\"\n.SH NAME\n{} \\- {}\n", roff(upper), section,
                     roff(schema::creation_time().substr(0, 10)), roff(kCreator), roff(name), roff(summary));
}

// The first line of `text`, which is then without it.
std::string_view take_line(std::string_view& text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return line;
}

// An indented line: "term   meaning" (two spaces or more) is an item of a list, the continuation of a meaning
// belongs to it, all others (a command, a document) are printed as they are.
std::string indented(std::string_view line, bool& in_item) {
  const std::size_t begin = line.find_first_not_of(' ');
  const std::string_view words = line.substr(begin);
  const std::size_t gap = words.find("  ");
  if (in_item && begin > 4) return roff(words) + "\n";
  in_item = gap < words.size();
  if (!in_item) return fmt::format(".PP\n.nf\n{}\n.fi\n", roff(words));
  const std::size_t meaning = words.find_first_not_of(' ', gap);
  return fmt::format(".TP\n\\fB{}\\fR\n{}\n", roff(words.substr(0, gap)), roff(words.substr(meaning)));
}

// A text of the help. A line that ends a sentence ends its paragraph.
std::string body(std::string_view text) {
  std::string page;
  for (bool ended = true, in_item = false; !text.empty();) {
    const std::string_view line = take_line(text);
    if (line.find_first_not_of(' ') == line.npos || line[0] == ' ') {
      ended = true;
      if (!line.empty()) page += indented(line, in_item);
      continue;
    }
    in_item = false;
    page += (ended ? ".PP\n" : "") + roff(line) + "\n";
    ended = line.ends_with('.') || line.ends_with(':');
  }
  return page;
}

// An option as --help has it.
std::string option_lines(const CLI::Option& option) {
  const CLI::Formatter help;
  return fmt::format(".TP\n\\fB{}\\fR{}\n{}\n", roff(help.make_option_name(&option, option.get_positional())),
                     roff(help.make_option_opts(&option)), roff(option.get_description()));
}

// Groups in the order in which the program declares them; an option without a group is hidden from the help.
std::string options_of(const CLI::App& app) {
  std::string arguments, text;
  for (const CLI::Option* option : app.get_options())
    if (option->get_positional()) arguments += option_lines(*option);
  for (const std::string& group : app.get_groups()) {
    std::string lines;
    for (const CLI::Option* option : app.get_options())
      if (!group.empty() && option->get_group() == group && !option->get_positional())
        lines += option_lines(*option);
    if (!lines.empty()) text += fmt::format(".SS {}\n{}", roff(group), lines);
  }
  return (arguments.empty() ? "" : ".SH ARGUMENTS\n" + arguments) + ".SH OPTIONS\n" + text;
}

constexpr std::string_view kExample = "Example:\n";

std::string footer_of(const CLI::App& app) {
  const std::string text = app.get_footer();
  std::string_view left = text;
  std::string page;
  if (left.starts_with(kExample)) {
    left.remove_prefix(kExample.size());
    page = ".SH EXAMPLES\n.nf\n";
    while (left.starts_with("  tactograph ")) page += roff(take_line(left).substr(2)) + "\n";
    page += ".fi\n";
  }
  return left.empty() ? page : page + ".SH NOTES\n" + body(left);
}

// "tactograph import [OPTIONS] FILE"
std::string synopsis(const CLI::App& app, const std::string& command) {
  const std::string usage = CLI::Formatter().make_usage(&app, command);
  const std::string_view after_word = std::string_view(usage).substr(usage.find(' ') + 1 + command.size());
  return fmt::format("\\fB{}\\fR{}", roff(command), roff(after_word));
}

std::string parts_of(const CLI::App& app, const std::string& command) {
  std::string text;
  for (const CLI::App* part : app.get_subcommands({})) {
    const std::string name = command + " " + part->get_name();
    text += fmt::format(".SH {}\n{}.PP\n{}\n{}{}", roff(name), synopsis(*part, name),
                        roff(part->get_description()), options_of(*part), footer_of(*part));
  }
  return text;
}

std::string see_also(std::span<const HelpTopic* const> topics) {
  std::string text = ".SH SEE ALSO\n\\fBtactograph\\fR(1)";
  for (const HelpTopic* topic : all_topics(topics))
    text += fmt::format(",\n\\fBtactograph\\-{}\\fR(7)", roff(topic->name));
  return text + "\n";
}

std::string exit_status() {
  return ".SH EXIT STATUS\n" + body(topic_text("exit-codes", {}));
}

ManPage page_of(const CLI::App& verb, std::span<const HelpTopic* const> topics) {
  const std::string command = "tactograph " + verb.get_name(), name = "tactograph-" + verb.get_name();
  return {name, '1',
          heading(name, '1', verb.get_description()) + ".SH SYNOPSIS\n" + synopsis(verb, command) +
              options_of(verb) + footer_of(verb) + parts_of(verb, command) + exit_status() +
              see_also(topics)};
}

ManPage page_of_all(const CLI::App& app, std::span<const HelpTopic* const> topics) {
  std::string text = heading("tactograph", '1', "record how a surface pulls on a finger, and play it back");
  text += ".SH SYNOPSIS\n" + synopsis(app, "tactograph") + options_of(app) + ".SH VERBS\n";
  std::string group;
  for (const CLI::App* verb : app.get_subcommands({})) {
    if (verb->get_group() != group) text += fmt::format(".SS {}\n", roff(group = verb->get_group()));
    text += fmt::format(".TP\n\\fBtactograph\\-{}\\fR(1)\n{}\n", roff(verb->get_name()),
                        roff(verb->get_description()));
  }
  return {"tactograph", '1', text + footer_of(app) + exit_status() + see_also(topics)};
}

ManPage page_of(const HelpTopic& topic, std::span<const HelpTopic* const> topics) {
  const std::string name = fmt::format("tactograph-{}", topic.name);
  return {name, '7',
          heading(name, '7', topic.summary) + ".SH DESCRIPTION\n" + body(topic.text()) + see_also(topics)};
}

// Empty if the program fails.
std::string help_printed_by(const std::string& program) {
  std::FILE* pipe = popen(fmt::format("'{}' --help", program).c_str(), "r");
  if (pipe == nullptr) return "";
  std::string text(std::size_t{1} << 16, '\0');
  text.resize(std::fread(text.data(), 1, text.size(), pipe));
  return pclose(pipe) == 0 ? text : "";
}

// The first line of its help is "NAME: summary", and a line "usage: ..." is its synopsis.
Result<ManPage> page_of_program(const std::string& program, std::span<const HelpTopic* const> topics) {
  constexpr std::string_view kUsage = "\n\nusage: ";
  const std::string help = help_printed_by(program), name = std::filesystem::path(program).filename();
  const std::size_t usage = help.find(kUsage);
  if (!help.starts_with(name + ": ") || usage == help.npos)
    return schema::fail(ErrorKind::not_found, "does not print a help that begins with its name and its usage",
                        program, "give the path of tactographd or tactograph-gadget");
  std::string_view left = std::string_view(help).substr(usage + kUsage.size());
  std::string text =
      heading(name, '8', std::string_view(help).substr(name.size() + 2, usage - name.size() - 2));
  text += fmt::format(".SH SYNOPSIS\n{}\n", roff(take_line(left)));
  return ManPage{name, '8', text + ".SH DESCRIPTION\n" + body(left) + see_also(topics)};
}

Result<void> write_page(const std::string& folder, const ManPage& page) {
  const std::filesystem::path section = std::filesystem::path(folder) / fmt::format("man{}", page.section);
  const std::filesystem::path path = section / fmt::format("{}.{}", page.name, page.section);
  std::error_code failed;
  std::filesystem::create_directories(section, failed);
  std::ofstream file(path, std::ios::binary);
  file << page.text;
  if (!file.flush())
    return schema::fail(ErrorKind::cannot_write, "the manual page could not be written", path.string(),
                        "give a folder with write permission");
  return {};
}

}  // namespace

Result<void> write_man_pages(const std::string& folder, const CLI::App& app,
                             std::span<const HelpTopic* const> topics,
                             const std::vector<std::string>& programs) {
  std::vector<ManPage> pages = {page_of_all(app, topics)};
  for (const CLI::App* verb : app.get_subcommands({})) pages.push_back(page_of(*verb, topics));
  for (const HelpTopic* topic : all_topics(topics)) pages.push_back(page_of(*topic, topics));
  for (const std::string& program : programs) {
    auto page = page_of_program(program, topics);
    TACTO_TRY(page);
    pages.push_back(std::move(*page));
  }
  for (const ManPage& page : pages) TACTO_TRY(write_page(folder, page));
  return {};
}

}  // namespace tacto::cli
