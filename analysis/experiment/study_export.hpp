// SPDX-License-Identifier: GPL-3.0-or-later
// The trials of a study for other programs: CSV, BIDS, and an R script that reads the CSV.
#pragma once

#include <string>
#include <vector>

#include "data-schema/files/files.hpp"

namespace tacto::analysis {

/// Writes into `folder`: trials.csv (a row for each attempt of all runs), analysis.R, and after the Brain
/// Imaging Data Structure (bids-specification 1.8.0, behavioural data) dataset_description.json,
/// participants.tsv and sub-P07/beh/sub-P07_task-STUDY_beh.tsv with its .json. STUDY.outputs.txt keeps their
/// names. Returns them. Errors: those of answered_runs; usage: a file exists and is to be kept; cannot_write.
schema::Result<std::vector<std::string>> export_study(const std::string& study, const std::string& folder,
                                                      bool unblind, schema::Existing existing);

}  // namespace tacto::analysis
