// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <span>

#include "analysis/html.hpp"
#include "analysis/picture_svg.hpp"
#include "analysis/report/project.hpp"
#include "data-schema/creation_time.hpp"
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
  constexpr std::size_t kShown = 2, kLongest = 120;
  std::string words;
  for (const auto& [name, value] : std::span(file.figures).first(std::min(kShown, file.figures.size())))
    words += fmt::format("{}{}: {}", words.empty() ? "" : "; ", name, value);
  if (words.size() <= kLongest) return words;
  // Not within a character of several bytes.
  std::size_t end = kLongest;
  while (end > 0 && (static_cast<unsigned char>(words[end]) & 0xC0) == 0x80) --end;
  return words.substr(0, end) + "…";
}

std::string overview(const Project& project) {
  std::vector<std::vector<std::string>> rows = {
      {"file", "kind", "date", "device or source", "SHA-256", "main figures"}};
  for (const ProjectFile& file : project.files)
    rows.push_back({within(project, file.path), std::string(schema::kind_name(file.kind)), file.date,
                    source_words(file), file.checksum, main_figures(file)});
  return rows.size() == 1 ? "" : "<h2>What was measured where</h2>\n" + html_table(rows);
}

std::string broken_list(const Project& project) {
  if (project.broken.empty()) return "";
  std::vector<std::vector<std::string>> rows = {{"file that can't be used", "why"}};
  for (const BrokenFile& file : project.broken)
    rows.push_back({within(project, file.path), schema::message(file.error)});
  return "<h2>Left out</h2>\n" + html_table(rows);
}

std::string foreign_list(const Project& project) {
  if (project.foreign.empty()) return "";
  std::string html =
      fmt::format("<p class=\"note\">Also there, not described here ({}):", project.foreign.size());
  for (const std::string& path : project.foreign) html += fmt::format(" {};", escaped(within(project, path)));
  html.back() = '.';
  return html + "</p>\n";
}

std::string section(const Project& project, const ProjectFile& file) {
  const std::string name = within(project, file.path);
  std::string html = fmt::format("<h2>{}: {}</h2>\n", escaped(schema::kind_name(file.kind)), escaped(name));
  if (!file.simulated.empty())
    html +=
        fmt::format("<p class=\"simulated\"><strong>Simulated</strong> {}.</p>\n", escaped(file.simulated));
  if (!file.figures.empty()) html += figures_html(file.figures);
  for (const std::string& svg : file.drawings) html += inline_svg(svg, name);
  return html + file.pictures_html;
}

std::string counted(const Project& project) {
  const auto simulated =
      std::ranges::count_if(project.files, [](const auto& f) { return !f.simulated.empty(); });
  return fmt::format("{} files, {} of them simulated; {} can't be used", project.files.size(), simulated,
                     project.broken.size());
}

}  // namespace

std::string project_page(const Project& project) {
  const std::string title = std::filesystem::weakly_canonical(project.folder).filename().string();
  std::string body = fmt::format("<h1>{}</h1>\n<p>{}. Made {} by {}.</p>\n", escaped(title), counted(project),
                                 schema::creation_time(), escaped(kCreator));
  body += overview(project) + broken_list(project) + foreign_list(project);
  for (const ProjectFile& file : project.files) body += section(project, file);
  return html_document(title, body);
}

}  // namespace tacto::analysis
