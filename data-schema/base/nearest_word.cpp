// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/base/nearest_word.hpp"

#include <algorithm>
#include <cctype>
#include <vector>

namespace tacto::schema {
namespace {

char lower(char c) {
  return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
}

std::size_t typing_errors(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i)
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const auto same = [&](std::size_t x, std::size_t y) { return lower(a[x]) == lower(b[y]); };
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (same(i - 1, j - 1) ? 0 : 1)});
      if (i > 1 && j > 1 && same(i - 1, j - 2) && same(i - 2, j - 1))
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

}  // namespace

std::string nearest_word(std::string_view typed, std::span<const std::string> words) {
  constexpr std::size_t kLongest = 64;  // longer words are not typing errors; time grows with the square
  std::string nearest;
  std::size_t fewest = kLongest;
  for (const std::string& word : words) {
    if (word.size() > kLongest || typed.size() > kLongest) continue;
    const std::size_t errors = typing_errors(typed, word);
    const std::size_t most = std::max<std::size_t>(1, std::max(word.size(), typed.size()) / 3);
    if (errors >= fewest || errors > most || errors >= word.size()) continue;
    fewest = errors;
    nearest = word;
  }
  return nearest;
}

std::string did_you_mean(std::string_view typed, std::span<const std::string> words) {
  const std::string nearest = nearest_word(typed, words);
  return nearest.empty() ? "" : " (did you mean '" + nearest + "'?)";
}

}  // namespace tacto::schema
