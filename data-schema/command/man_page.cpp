// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/command/man_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "data-schema/base/creation_time.hpp"
#include "data-schema/command/help.hpp"
#include "data-schema/command/option_headings.hpp"
#include "data-schema/version.hpp"

namespace tacto::cli {
namespace {

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

std::string heading(std::string_view name, std::string_view summary) {
  std::string upper(name);
  std::ranges::transform(upper, upper.begin(),
                         [](unsigned char letter) { return static_cast<char>(std::toupper(letter)); });
  return fmt::format(".TH {} 1 {} \"{}\" \"User Commands\"\n.SH NAME\n{} \\- {}\n", roff(upper),
                     roff(schema::creation_time().substr(0, 10)), roff(kCreator), roff(name), roff(summary));
}

std::string option_line(const CLI::Option& option) {
  const bool positional = option.get_positional();
  std::string line = fmt::format(".TP\n\\fB{}\\fR", roff(option.get_name(positional, true)));
  if (option.get_items_expected_max() > 0 && !option.get_type_name().empty())
    line += fmt::format(" \\fI{}\\fR", roff(option.get_type_name()));
  if (!option.get_default_str().empty())
    line += fmt::format(" (default: {})", roff(option.get_default_str()));
  return line + "\n" + roff(option.get_description()) + "\n";
}

// Groups in the order in which the program declares them; an option without a group is hidden from the help.
std::string options_of(const CLI::App& app) {
  std::string text;
  for (const std::string& group : app.get_groups()) {
    if (group.empty()) continue;
    std::string lines;
    for (const CLI::Option* option : app.get_options())
      if (option->get_group() == group) lines += option_line(*option);
    if (!lines.empty()) text += fmt::format(".SS {}\n{}", roff(group), lines);
  }
  return text;
}

std::string parts_of(const CLI::App& app) {
  std::string text;
  for (const CLI::App* part : app.get_subcommands({}))
    if (!part->get_name().empty())
      text += fmt::format(".SH {}\n{}\n{}", roff(part->get_name()), roff(part->get_description()),
                          options_of(*part));
  return text;
}

std::string literal(std::string_view title, std::string_view lines) {
  return fmt::format(".SH {}\n.nf\n{}\n.fi\n", title, roff(lines));
}

std::string exit_status() {
  return literal("EXIT STATUS", topic_text("exit-codes", {}));
}

ManPage page_of(const Verb& verb) {
  CLI::App app;
  const Action action = verb.declare(app);  // the variables of the options must live as long
  put_below_headings(verb.name, app);
  const std::string name = fmt::format("tactograph-{}", verb.name);
  std::string text = heading(name, verb.summary);
  text += fmt::format(".SH SYNOPSIS\n\\fBtactograph {}\\fR [options]\n", roff(verb.name));
  text += ".SH OPTIONS\n" + options_of(app) + parts_of(app);
  text += literal("EXAMPLES", verb.example) + exit_status();
  return {name + ".1", text + ".SH SEE ALSO\n\\fBtactograph\\fR(1)\n"};
}

ManPage page_of_all(std::span<const Verb* const> verbs) {
  std::string text = heading("tactograph", "record how a surface pulls on a finger, and play it back");
  text += ".SH SYNOPSIS\n\\fBtactograph\\fR \\fIverb\\fR [options]\n.SH VERBS\n";
  for (const Verb* verb : verbs)
    text += fmt::format(".TP\n\\fB{}\\fR\n{}; see \\fBtactograph\\-{}\\fR(1)\n", roff(verb->name),
                        roff(verb->summary), roff(verb->name));
  return {"tactograph.1", text + exit_status()};
}

}  // namespace

std::vector<ManPage> man_pages(std::span<const Verb* const> verbs) {
  std::vector<ManPage> pages = {page_of_all(verbs)};
  for (const Verb* verb : verbs) pages.push_back(page_of(*verb));
  return pages;
}

schema::Result<void> write_man_pages(const std::string& folder, std::span<const Verb* const> verbs) {
  for (const ManPage& page : man_pages(verbs)) {
    std::ofstream file(folder + "/" + page.file, std::ios::binary);
    file << page.text;
    if (!file.flush())
      return schema::fail(schema::ErrorKind::cannot_write, "the manual page could not be written",
                          folder + "/" + page.file, "give an existing folder with write permission");
  }
  return {};
}

}  // namespace tacto::cli
