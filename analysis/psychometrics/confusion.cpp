// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/psychometrics/confusion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace tacto::analysis {
namespace {

using Shares = std::vector<double>;

double sum_of(const Shares& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

double entropy_bit(const Shares& shares) {
  double sum = 0;
  for (const double share : shares)
    if (share > 0) sum -= share * std::log2(share);
  return sum;
}

Shares normalised(const Shares& counts) {
  Shares shares = counts;
  const double sum = sum_of(counts);
  for (double& share : shares) share /= sum;
  return shares;
}

// Entropy of the answers less the mean of their entropy under each stimulus.
double mutual_bit(const std::vector<Shares>& answers, const Shares& stimuli) {
  Shares mixed(answers.front().size(), 0);
  double given = 0;
  for (std::size_t s = 0; s < stimuli.size(); ++s) {
    for (std::size_t a = 0; a < mixed.size(); ++a) mixed[a] += stimuli[s] * answers[s][a];
    given += stimuli[s] * entropy_bit(answers[s]);
  }
  return entropy_bit(mixed) - given;
}

double excess_cells(const Shares& shares) {
  return static_cast<double>(std::ranges::count_if(shares, [](double share) { return share > 0; })) - 1;
}

// n times the plug-in value less n - 1 times the mean without one answer, for each stimulus.
double jackknife_bit(const ConfusionMatrix& matrix, const std::vector<Shares>& answers, const Shares& stimuli,
                     double plug_in) {
  double value = plug_in;
  for (std::size_t s = 0; s < matrix.size(); ++s) {
    const double count = sum_of(matrix[s]);
    std::vector<Shares> without = answers;
    for (std::size_t a = 0; a < matrix[s].size(); ++a) {
      if (matrix[s][a] == 0) continue;
      Shares left = matrix[s];
      left[a] -= 1;
      without[s] = normalised(left);
      value += (count - 1) * matrix[s][a] / count * (plug_in - mutual_bit(without, stimuli));
    }
  }
  return value;
}

}  // namespace

Information information_of(const ConfusionMatrix& matrix) {
  Shares stimuli, all(matrix.front().size(), 0);
  std::vector<Shares> answers;
  for (const Shares& row : matrix) {
    stimuli.push_back(sum_of(row));
    answers.push_back(normalised(row));
    for (std::size_t a = 0; a < row.size(); ++a) all[a] += row[a];
  }
  const double count = sum_of(stimuli);
  stimuli = normalised(stimuli);
  Information information;
  information.plug_in = mutual_bit(answers, stimuli);
  double cells = excess_cells(all);
  for (const Shares& row : matrix) cells -= excess_cells(row);
  information.miller_madow = information.plug_in + cells / (2 * count * std::numbers::ln2);
  information.jackknife = jackknife_bit(matrix, answers, stimuli, information.plug_in);
  return information;
}

}  // namespace tacto::analysis
