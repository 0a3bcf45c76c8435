// SPDX-License-Identifier: GPL-3.0-or-later
// A participant withdraws: all files with the answers are deleted, and only the fact remains.
#pragma once

#include <string>
#include <vector>

#include "data-schema/base/error.hpp"

namespace tacto::analysis {

/// What would be deleted.
struct Withdrawal {
  std::string stem, participant;     ///< of the study
  std::vector<std::string> files;    ///< in the study's folder
  std::vector<std::string> outside;  ///< outputs elsewhere with answers: never deleted
};

/// Whether STUDY.withdrawn.txt names the participant. `stem`: of the study.
bool is_withdrawn(const std::string& stem, const std::string& participant);
/// Errors: unsuitable, if it does.
schema::Result<void> check_not_withdrawn(const std::string& stem, const std::string& participant);

/// Keeps in STUDY.outputs.txt, a path a line, where answers of the study's participants were written.
/// Errors: cannot_write.
schema::Result<void> log_outputs(const std::string& stem, const std::vector<std::string>& files);

/// The files of a participant: the journal, its table, all in STUDY-P07/, and the outputs of the study that
/// were logged and exist. `study`: STEM or STEM.protocol.json. Errors: not_found: no study, or neither a file
/// nor a record of this participant; unsuitable: one of the files is a symbolic link; usage: no code of a
/// participant.
schema::Result<Withdrawal> plan_withdrawal(const std::string& study, const std::string& participant);

/// Paths with the participant's code that are not deleted.
struct Leftovers {
  std::vector<std::string> paths;
  bool complete = false;  ///< false: an error, or too much to search; folders without permission are skipped
};

/// Searches the study's folder, without following links, for other files and folders than those of the plan:
/// with sub-P07 or STUDY-P07 in the name, or a csv, tsv or json file of at most 4 MB with P07 as a word. Of a
/// folder that has the name, only the folder. At most 100 000 entries and 500 MB of tables.
Leftovers find_leftovers(const Withdrawal& withdrawal);

/// Writes the record, then deletes the files; after an interruption it can be repeated. Errors:
/// unsuitable, while the participant's run is going on; cannot_write.
schema::Result<void> withdraw(const Withdrawal& withdrawal);

}  // namespace tacto::analysis
