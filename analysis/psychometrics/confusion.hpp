// SPDX-License-Identifier: GPL-3.0-or-later
// The information that answers carry about stimuli, from a confusion matrix.
#pragma once

#include <vector>

namespace tacto::analysis {

/// Numbers of answers: a row per stimulus, a column per answer.
using ConfusionMatrix = std::vector<std::vector<double>>;

/// Mutual information of stimulus and answer, bit. The shares of the stimuli are those of the rows and known:
/// they are the experimenter's. From few answers the plug-in value is too large.
struct Information {
  double plug_in = 0;
  double miller_madow = 0;  ///< each entropy plus (occupied cells - 1) / (2 n)
  double jackknife = 0;     ///< each answer left out in turn, stimulus by stimulus
};

/// Precondition: rows of equal length; each has at least two answers. Pure.
Information information_of(const ConfusionMatrix& matrix);

}  // namespace tacto::analysis
