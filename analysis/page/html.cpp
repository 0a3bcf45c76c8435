// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/page/html.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <stdexcept>

#include "data-schema/base/column_unit.hpp"

namespace tacto::analysis {
namespace {

constexpr std::string_view kStyle = R"(
:root { color-scheme: light dark; --text: #1d2126; --page: #fff; --soft: #56606b; --line: #d5d9de; --row: #aab2bb; --note: #fff3d6; --edge: #e0a100; }
@media (prefers-color-scheme: dark) { :root { --text: #e4e7ea; --page: #16191d; --soft: #a7b0ba; --line: #3a4149; --row: #59626c; --note: #3d3110; } }
body { font: 16px/1.5 "DejaVu Sans", Verdana, sans-serif; color: var(--text); background: var(--page); max-width: 62rem; margin: 2rem auto; padding: 0 1rem; overflow-wrap: break-word; }
h1 { font-size: 1.7rem; margin-bottom: .2rem; } h2 { font-size: 1.25rem; margin-top: 2.6rem; border-top: 1px solid var(--line); padding-top: 1.2rem; }
p.answer { font-size: 1.2rem; font-weight: 600; margin: .8rem 0; }
a { color: inherit; }
.simulated { background: var(--note); border-left: .4rem solid var(--edge); padding: .6rem 1rem; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; margin: .8rem 0; }
th, td { padding: .35rem .6rem; text-align: right; vertical-align: top; border-bottom: 1px solid var(--line); }
th { font-weight: 600; vertical-align: bottom; } td:first-child, th:first-child { text-align: left; }
table.pairs th, table.pairs td { text-align: left; } table.c9 { font-size: .9rem; display: block; overflow-x: auto; } td.long { overflow-wrap: anywhere; } td.word { white-space: nowrap; } td.text, th.text { text-align: left; }
.picture { overflow-x: auto; } .picture img { min-width: 40rem; } .small img { min-width: 0; }
img { width: 100%; height: auto; margin: .6rem 0; border-radius: .3rem; } p.note { color: var(--soft); font-size: .9rem; }
details { margin: .8rem 0; border: 1px solid var(--line); border-radius: .3rem; padding: 0 .8rem; }
pre { overflow-x: auto; background: rgba(127, 127, 127, .12); padding: .6rem 1rem; font-size: .85rem; }
summary { cursor: pointer; padding: .5rem 0; font-weight: 600; }
)";

// On a screen narrower than this width, a table of so many columns becomes a list: one block per row, one
// line "header: value" per cell.
struct ListedBelow {
  std::size_t columns;
  const char* width;
};
constexpr ListedBelow kListedBelow[] = {{9, "66rem"}, {6, "50rem"}, {4, "40rem"}};

std::string list_style() {
  std::string style;
  for (const ListedBelow& rule : kListedBelow)
    style += fmt::format(
        "@media (max-width: {0}) {{ table.c{1}, .c{1} tbody, .c{1} tr {{ display: block; }} .c{1} thead {{ "
        "display: none; }}\n"
        ".c{1} tr {{ border-bottom: 2px solid var(--row); padding: .5rem 0; }} .c{1} td {{ display: flex; "
        "justify-content: space-between; gap: 1rem; border: 0; padding: .1rem 0; text-align: right; }}\n"
        ".c{1} td::before {{ content: attr(data-label); text-align: left; color: var(--soft); }} .c{1} "
        "td:first-child {{ font-weight: 600; }} }}\n",
        rule.width, rule.columns);
  return style;
}

// The CSS class for a table of so many columns: names and values side by side, or one that becomes a list on
// a narrow screen; empty for other tables.
std::string table_class(std::size_t columns) {
  if (columns == 2) return " class=\"pairs\"";
  for (const ListedBelow& rule : kListedBelow)
    if (columns >= rule.columns) return fmt::format(" class=\"c{}\"", rule.columns);
  return "";
}

// Encodes the characters that a data: URI in a double-quoted attribute cannot contain. Base64 would enlarge
// the SVG by a third, and the pictures within it, which already are base64, a second time.
std::string percent_encoded(std::string_view text) {
  std::string uri;
  for (const char c : text)
    if (std::string_view("%#\"<>&").find(c) != std::string_view::npos ||
        static_cast<unsigned char>(c) <= ' ' || static_cast<unsigned char>(c) > '~')
      uri += c == ' ' ? " " : fmt::format("%{:02X}", static_cast<unsigned>(static_cast<unsigned char>(c)));
    else
      uri += c;
  // A page has no links: a search for "http" must not find the names of XML's namespaces.
  for (std::size_t at = 0; (at = uri.find("http", at)) != uri.npos;) uri.replace(at, 1, "%68");
  return uri;
}

std::size_t longest_word(std::string_view text) {
  std::size_t longest = 0, length = 0;
  for (const char c : text) longest = std::max(longest, length = c == ' ' ? 0 : length + 1);
  return longest;
}

constexpr std::size_t kLongWord = 24, kSentence = 28;

bool is_text(std::string_view cell) {
  return longest_word(cell) > kLongWord || cell.size() > kSentence;
}

// A long word without spaces, such as a path, may be broken anywhere; another single word, such as a date,
// is not broken. All cells of a column with sentences are aligned left.
std::string cell_class(std::string_view cell, bool in_text_column) {
  const bool is_long = longest_word(cell) > kLongWord;
  const bool is_word = !is_long && cell.find('-') != cell.npos && cell.find(' ') == cell.npos;
  const char* classes = is_long && in_text_column   ? "long text"
                        : is_long                   ? "long"
                        : is_word && in_text_column ? "word text"
                        : is_word                   ? "word"
                        : in_text_column            ? "text"
                                                    : "";
  return *classes == 0 ? "" : fmt::format(" class=\"{}\"", classes);
}

std::string head_row(const std::vector<std::string>& headers, const std::vector<bool>& text_columns) {
  std::string row = "<thead><tr>";
  for (std::size_t i = 0; i < headers.size(); ++i)
    row += fmt::format("<th{}>{}</th>", text_columns[i] ? " class=\"text\"" : "", escaped(headers[i]));
  return row + "</tr></thead>\n";
}

std::string entity(char c) {
  if (c == '<') return "&lt;";
  if (c == '>') return "&gt;";
  if (c == '&') return "&amp;";
  return c == '"' ? "&quot;" : std::string(1, c);
}

// Length in bytes of the first UTF-8 character; 0 if it is invalid (names of files may contain any bytes).
std::size_t sign_bytes(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  if (byte(0) < 0x80) return 1;
  const std::size_t bytes = byte(0) >= 0xF0 && byte(0) < 0xF5   ? 4
                            : byte(0) >= 0xE0 && byte(0) < 0xF0 ? 3
                            : byte(0) >= 0xC2 && byte(0) < 0xE0 ? 2
                                                                : 0;
  if (bytes == 0 || text.size() < bytes) return 0;
  for (std::size_t i = 1; i < bytes; ++i)
    if ((byte(i) & 0xC0) != 0x80) return 0;
  return bytes;
}

// The unit that begins at `text`, without what it is divided by; empty if it is another word.
std::string_view unit_at(std::string_view text) {
  const auto end = std::ranges::find_if(
      text, [](char c) { return !std::isalnum(static_cast<unsigned char>(c)) && c != '%' && c != '/'; });
  const std::string_view word(text.begin(), end);
  const std::string_view before = word.substr(0, word.find('/', word.starts_with("1/") ? 2 : 0));
  return before != "1" && schema::is_known_unit(before) ? before : "";
}

bool is_micro(std::string_view unit) {
  return unit.size() == 2 && unit.front() == 'u';
}

// The unit behind the space at `i`, if a number is before it.
std::string_view unit_of_number(std::string_view text, std::size_t i) {
  if (i == 0 || text[i] != ' ' || std::isdigit(static_cast<unsigned char>(text[i - 1])) == 0) return {};
  return unit_at(text.substr(i + 1));
}

// The space in "p 0.03".
bool is_after_p(std::string_view text, std::size_t i) {
  const auto is_word = [&](std::size_t at) {
    return std::isalnum(static_cast<unsigned char>(text[at])) != 0;
  };
  return i > 0 && i + 1 < text.size() && text[i] == ' ' && text[i - 1] == 'p' &&
         (i == 1 || !is_word(i - 2)) && std::isdigit(static_cast<unsigned char>(text[i + 1])) != 0;
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string safe;
  for (std::size_t i = 0; i < text.size();) {
    if (const std::string_view unit = unit_of_number(text, i); !unit.empty()) {
      const bool micro = is_micro(unit);
      safe += fmt::format("&nbsp;{}{}", micro ? "\u00B5" : "", unit.substr(micro ? 1 : 0));
      i += 1 + unit.size();
      continue;
    }
    if (is_after_p(text, i)) {
      safe += "&nbsp;";
      ++i;
      continue;
    }
    const std::size_t bytes = sign_bytes(text.substr(i));
    safe += bytes == 0 ? "\uFFFD" : bytes == 1 ? entity(text[i]) : std::string(text.substr(i, bytes));
    i += std::max<std::size_t>(1, bytes);
  }
  return safe;
}

std::string with_micro_signs(std::string_view text) {
  std::string typeset;
  for (std::size_t i = 0; i < text.size(); ++i) {
    typeset += text[i];
    if (!is_micro(unit_of_number(text, i))) continue;
    typeset += "\u00B5";
    ++i;  // the u
  }
  return typeset;
}

namespace {

// A long word, like sim:surface=C,speed=50mm/s, breaks after its commas if it can.
std::string with_breaks(std::string_view cell) {
  std::string text = escaped(cell);
  if (longest_word(cell) <= kLongWord) return text;
  for (std::size_t at = 0; (at = text.find(',', at)) != text.npos; at += 6)
    if (at + 1 < text.size() && text[at + 1] != ' ') text.insert(at + 1, "<wbr>");
  return text;
}

}  // namespace

std::string inline_svg(std::string_view svg, std::string_view alternative) {
  return fmt::format("<div class=\"picture\"><img alt=\"{}\" src=\"data:image/svg+xml,{}\"></div>\n",
                     escaped(alternative), percent_encoded(svg));
}

std::string html_table(const std::vector<std::string>& headers, std::size_t rows, const CellText& cell,
                       const RowTarget& target) {
  std::vector<std::vector<std::string>> cells(rows);
  std::vector<bool> text_columns(headers.size());
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t column = 0; column < headers.size(); ++column) {
      cells[row].push_back(cell(row, column));
      if (is_text(cells[row].back())) text_columns[column] = true;
    }
  std::string table =
      fmt::format("<table{}>\n{}<tbody>\n", table_class(headers.size()), head_row(headers, text_columns));
  for (std::size_t i = 0; i < rows; ++i) {
    table += "<tr>";
    for (std::size_t column = 0; column < headers.size(); ++column) {
      const std::string& text = cells[i][column];
      std::string shown = with_breaks(text);
      if (target && column == 0) shown = fmt::format("<a href=\"#{}\">{}</a>", escaped(target(i)), shown);
      table += fmt::format("<td{} data-label=\"{}\">{}</td>", cell_class(text, text_columns[column]),
                           escaped(headers[column]), shown);
    }
    table += "</tr>\n";
  }
  return table + "</tbody></table>\n";
}

std::string html_table(const std::vector<std::vector<std::string>>& rows) {
  for (const auto& row : rows)
    if (row.size() != rows.front().size())
      throw std::logic_error("a table's row has another number of cells than its head");
  return html_table(rows.front(), rows.size() - 1,
                    [&](std::size_t row, std::size_t column) { return rows[row + 1][column]; });
}

std::string folded(std::string_view summary, std::string_view html) {
  return fmt::format("<details><summary>{}</summary>\n{}</details>\n", escaped(summary), html);
}

std::string answer(std::string_view sentence) {
  return fmt::format("<p class=\"answer\">{}</p>\n", escaped(sentence));
}

std::string simulated_box(std::string_view by_what) {
  if (by_what.empty()) return "";
  return fmt::format(
      "<p class=\"simulated\"><strong>Simulated</strong> {}. No figure here was measured on hardware.</p>\n",
      escaped(by_what));
}

std::string html_document(std::string_view title, std::string_view body) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>{}</title>\n<style>{}{}</style></head>\n<body>\n{}</body></html>\n",
      escaped(title), kStyle, list_style(), body);
}

}  // namespace tacto::analysis
