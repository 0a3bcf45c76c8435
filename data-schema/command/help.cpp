// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/command/help.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "data-schema/base/quantity.hpp"
#include "data-schema/files/embedded_files.hpp"

namespace tacto::cli {
namespace {

using schema::Dimension;

std::string units_text() {
  constexpr std::pair<const char*, Dimension> kDimensions[] = {
      {"length", Dimension::length},         {"time", Dimension::time},
      {"frequency", Dimension::frequency},   {"spatial frequency", Dimension::spatial_frequency},
      {"speed", Dimension::speed},           {"acceleration", Dimension::acceleration},
      {"force", Dimension::force},           {"voltage", Dimension::voltage},
      {"compliance", Dimension::compliance}, {"share", Dimension::share}};
  std::string text =
      "A quantity is a number with its unit, without a space: 10mm, 15Hz, 0.5um, 15/mm, 50mm/s, 1mm/N.\n"
      "A number without a unit is refused. The units:\n";
  for (const auto& [name, dimension] : kDimensions)
    text += fmt::format("  {:<20}{}\n", name, schema::units_of(dimension));
  return text;
}

std::string exit_codes_text() {
  std::string text;
  for (std::size_t code = 0; code < std::size(kExitCodes); ++code)
    text += fmt::format("  {}  {}{}\n", code, kExitCodes[code], code == 1 ? ": please report it" : "");
  return text + "With --json an error is an object on one line of stderr: what, where, remedy, exit_code.\n";
}

std::string_view document(std::string_view name) {
  const auto files = schema::embedded_files();
  return std::ranges::find(files, name, &schema::EmbeddedFile::name)->content;
}

// The items of WORDS.md, without its marks.
std::string glossary_text() {
  const std::string_view page = document("WORDS.md");
  std::string text;
  for (std::size_t at = page.find("\n- "); at < page.size(); at = page.find("\n- ", at + 1)) {
    const std::size_t end = std::min(page.find("\n- ", at + 1), page.size());
    for (const char c : page.substr(at + 3, end - at - 3))
      if (c != '*') text += c;
    if (text.back() != '\n') text += '\n';
  }
  return text;
}

// A text of Markdown without the marks of code and of links.
std::string plain(std::string_view marked) {
  std::string text;
  for (std::size_t at = 0; at < marked.size(); ++at)
    if (marked.substr(at).starts_with("]("))
      at = std::min(marked.find(')', at), marked.size());
    else if (marked[at] != '`' && marked[at] != '[')
      text += marked[at];
  return text;
}

// The chapter "Kinds of files" of README.md: the first two columns of its table, and its text.
std::string files_text() {
  constexpr std::string_view kTitle =
      "## Kinds of files\n\n| kind | files | folder | schema in `schemas/` |\n|---|---|---|---|\n";
  const std::string_view page = document("README.md");
  const std::size_t begin = page.find(kTitle) + kTitle.size();
  const std::string chapter = plain(page.substr(begin, page.find("\n## ", begin) - begin));
  std::string text;
  for (std::size_t at = 0; at < chapter.size();) {
    const std::size_t end = chapter.find('\n', at);
    const std::string line = chapter.substr(at, end - at);
    const std::size_t kind_end = line.find(" | ");
    if (line.starts_with("| "))
      text += fmt::format("  {:<42}{}\n", line.substr(2, kind_end - 2),
                          line.substr(kind_end + 3, line.find(" | ", kind_end + 3) - kind_end - 3));
    else
      text += line + "\n";
    at = std::min(end, chapter.size() - 1) + 1;
  }
  return text;
}

constexpr HelpTopic kTopics[] = {
    {"files", "the kinds of files, their names and what they hold", files_text},
    {"words", "the terms: tray, drive, tick, stroke, scene, formant and others", glossary_text},
    {"units", "how quantities are written, and the known units", units_text},
    {"exit-codes", "meaning of the exit codes", exit_codes_text}};

}  // namespace

std::vector<const HelpTopic*> all_topics(std::span<const HelpTopic* const> topics) {
  std::vector<const HelpTopic*> all(topics.begin(), topics.end());
  for (const HelpTopic& topic : kTopics) all.push_back(&topic);
  return all;
}

std::string topics_text(std::span<const HelpTopic* const> topics) {
  std::string text;
  for (const HelpTopic* topic : all_topics(topics))
    text += fmt::format("  {:<14}{}\n", topic->name, topic->summary);
  return text;
}

std::vector<std::string> topic_names(std::span<const HelpTopic* const> topics) {
  std::vector<std::string> names;
  for (const HelpTopic* topic : all_topics(topics)) names.emplace_back(topic->name);
  return names;
}

std::string topic_text(std::string_view name, std::span<const HelpTopic* const> topics) {
  std::string text;
  for (const HelpTopic* topic : all_topics(topics))
    if (topic->name == name) text = topic->text();
  return text;
}

}  // namespace tacto::cli
