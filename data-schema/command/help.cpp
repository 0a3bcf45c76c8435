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
  return "  0  done\n  1  internal error: please report it\n  2  command line\n  3  file or device not "
         "found\n"
         "  4  malformed file\n  5  data that cannot be used for this\n  6  file of a newer version\n"
         "  7  cannot write\n  8  device failed\n  9  unstable\n"
         "With --json an error is an object on one line of stderr: what, where, remedy, exit_code.\n";
}

// The items of WORDS.md, without its marks.
std::string glossary_text() {
  const auto files = schema::embedded_files();
  const std::string_view page = std::ranges::find(files, "WORDS.md", &schema::EmbeddedFile::name)->content;
  std::string text;
  for (std::size_t at = page.find("\n- "); at < page.size(); at = page.find("\n- ", at + 1)) {
    const std::size_t end = std::min(page.find("\n- ", at + 1), page.size());
    for (const char c : page.substr(at + 3, end - at - 3))
      if (c != '*') text += c;
    if (text.back() != '\n') text += '\n';
  }
  return text;
}

constexpr HelpTopic kTopics[] = {
    {"words", "the terms: tray, drive, tick, stroke, scene, formant and others", glossary_text},
    {"units", "how quantities are written, and the known units", units_text},
    {"exit-codes", "meaning of the exit codes", exit_codes_text}};

template <class Use>
void for_each_topic(std::span<const HelpTopic* const> topics, Use use) {
  for (const HelpTopic* topic : topics) use(*topic);
  for (const HelpTopic& topic : kTopics) use(topic);
}

}  // namespace

std::string topics_text(std::span<const HelpTopic* const> topics) {
  std::string text;
  for_each_topic(topics, [&](const HelpTopic& topic) {
    text += fmt::format("  {:<14}{}\n", topic.name, topic.summary);
  });
  return text;
}

std::vector<std::string> topic_names(std::span<const HelpTopic* const> topics) {
  std::vector<std::string> names;
  for_each_topic(topics, [&](const HelpTopic& topic) { names.emplace_back(topic.name); });
  return names;
}

std::string topic_text(std::string_view name, std::span<const HelpTopic* const> topics) {
  std::string text;
  for_each_topic(topics, [&](const HelpTopic& topic) {
    if (topic.name == name) text = topic.text();
  });
  return text;
}

}  // namespace tacto::cli
