// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <span>

#include "analysis/page/html.hpp"
#include "analysis/page/picture_svg.hpp"
#include "analysis/report/project.hpp"
#include "data-schema/base/creation_time.hpp"
#include "data-schema/version.hpp"

namespace tacto::analysis {
namespace {

std::string within(const Project& project, const std::string& path) {
  return std::filesystem::path(path).lexically_relative(project.folder).string();
}

std::string source_words(const ProjectFile& file) {
  if (file.simulated.empty()) return file.origin;
  return file.origin.empty() ? "simulated" : file.origin + " (simulated)";
}

std::string main_figures(const ProjectFile& file) {
  constexpr std::size_t kShown = 2, kLongest = 240;
  std::string words;
  for (const auto& [name, value] : std::span(file.figures).first(std::min(kShown, file.figures.size())))
    words += fmt::format("{}{}: {}", words.empty() ? "" : "; ", name, value);
  if (words.size() <= kLongest) return words;
  // Cut between two parts of a sentence, or else not within a character of several bytes.
  std::size_t end = words.find_last_of(";,:", kLongest);
  if (end == words.npos || end < kLongest / 4) end = kLongest;
  while (end > 0 && (static_cast<unsigned char>(words[end]) & 0xC0) == 0x80) --end;
  return words.substr(0, end) + " …";
}

// With more files, the page shows the first ones and folds the rest.
constexpr std::size_t kRowsShown = 20, kSectionsShown = 12;

// Of the section of a file.
std::string section_id(std::size_t file) {
  return fmt::format("file-{}", file + 1);
}

std::string files_table(const Project& project, std::size_t from, std::size_t to) {
  using File = const ProjectFile*;
  std::vector<File> files;
  for (std::size_t i = from; i < to; ++i) files.push_back(&project.files[i]);
  return html_table(files,
                    {{"file", [&](File file) { return within(project, file->path); }},
                     {"kind", [](File file) { return std::string(schema::kind_name(file->kind)); }},
                     {"date", [](File file) { return file->date; }},
                     {"device or source", [](File file) { return source_words(*file); }},
                     {"SHA-256", [](File file) { return file->checksum; }},
                     {"main figures", [](File file) { return main_figures(*file); }}},
                    [&](std::size_t row) { return section_id(from + row); });
}

std::string overview(const Project& project) {
  const std::size_t files = project.files.size(), shown = std::min(kRowsShown, files);
  if (files == 0) return "";
  std::string html = "<h2>What was measured where</h2>\n" + files_table(project, 0, shown);
  if (shown < files)
    html += folded(fmt::format("{} more files", files - shown), files_table(project, shown, files));
  return html;
}

std::string broken_list(const Project& project) {
  if (project.broken.empty()) return "";
  return "<h2>Left out</h2>\n" +
         html_table(project.broken, {{"file that can't be used",
                                      [&](const auto& file) { return within(project, file.path); }},
                                     {"why", [](const auto& file) { return schema::message(file.error); }}});
}

std::string foreign_list(const Project& project) {
  if (project.foreign.empty()) return "";
  std::string html = fmt::format("<p class=\"note\">Not described here ({}):", project.foreign.size());
  for (const std::string& path : project.foreign) html += fmt::format(" {};", escaped(within(project, path)));
  html.back() = '.';
  return html + "</p>\n";
}

std::string section_body(const Project& project, const ProjectFile& file) {
  auto figures = file.figures;
  if (!file.simulated.empty()) figures.push_back({"simulated", file.simulated});
  std::string html = figures.empty() ? "" : figures_html(figures);
  for (const std::string& svg : file.drawings) html += inline_svg(svg, within(project, file.path));
  return html + file.pictures_html;
}

// A browser opens a folded section when a link leads to its inside.
std::string section(const Project& project, std::size_t number) {
  const ProjectFile& file = project.files[number];
  const std::string title = fmt::format("{}: {}", schema::kind_name(file.kind), within(project, file.path));
  const std::string id = section_id(number), body = section_body(project, file);
  if (project.files.size() > kSectionsShown)
    return folded(title, fmt::format("<div id=\"{}\">\n{}</div>\n", id, body));
  return fmt::format("<h2 id=\"{}\">{}</h2>\n{}", id, escaped(title), body);
}

std::size_t simulated_files(const Project& project) {
  return static_cast<std::size_t>(
      std::ranges::count_if(project.files, [](const auto& f) { return !f.simulated.empty(); }));
}

std::string counted(const Project& project) {
  return fmt::format("{} {}, {} of them simulated; {} can't be used", project.files.size(),
                     project.files.size() == 1 ? "file" : "files", simulated_files(project),
                     project.broken.size());
}

// Once a page; the section of each file has the origin of its simulation.
std::string box_of(const Project& project) {
  const std::size_t simulated = simulated_files(project);
  if (simulated == 0) return "";
  return fmt::format(
      "<p class=\"simulated\"><strong>Simulated</strong>: {} of {} files. Their sections name what simulated "
      "them.</p>\n",
      simulated, project.files.size());
}

}  // namespace

std::string project_page(const Project& project) {
  const std::string title = std::filesystem::weakly_canonical(project.folder).filename().string();
  std::string body = fmt::format("<h1>{}</h1>\n{}<p>Made {} by {}.</p>\n", escaped(title),
                                 answer(counted(project) + "."), schema::creation_time(), escaped(kCreator));
  body += box_of(project) + broken_list(project) + overview(project) + foreign_list(project);
  if (project.files.size() > kSectionsShown) body += "<h2>Each file</h2>\n";
  for (std::size_t i = 0; i < project.files.size(); ++i) body += section(project, i);
  return html_document(title, body);
}

}  // namespace tacto::analysis
