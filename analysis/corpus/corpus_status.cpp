// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/corpus/corpus_status.hpp"

#include "data-schema/files/files.hpp"

namespace tacto::analysis {
namespace {

// The last unit that can exist: the first that is not done, else that of the last step.
UnitState add_units(CorpusStatus& status, const std::string& study, std::size_t recording, bool verify) {
  const auto keys = unit_keys(status.plan, status.plan.recordings[recording]);
  UnitState state = UnitState::done;
  for (std::size_t step = 0; step < keys.size() && state == UnitState::done; ++step) {
    std::string folder = unit_folder(study, keys[step]);
    Unit unit = read_unit(folder, verify);
    state = unit.state;
    status.warned += unit.has_warnings ? 1U : 0U;
    status.units.push_back({recording, step, std::move(folder), std::move(unit)});
  }
  return state;
}

}  // namespace

schema::Result<CorpusStatus> corpus_status(const std::string& study, bool verify) {
  auto plan = schema::read_corpus_plan(corpus_plan_path(study));
  TACTO_TRY(plan);
  CorpusStatus status;
  status.plan = std::move(*plan);
  for (std::size_t i = 0; i < status.plan.recordings.size(); ++i) {
    const schema::CorpusRecording& recording = status.plan.recordings[i];
    if (verify)
      if (const auto sum = schema::sha256_of_file(path_of(study, recording));
          !sum || *sum != recording.sha256)
        status.changed.push_back(i);
    const UnitState state = add_units(status, study, i, verify);
    ++(state == UnitState::done ? status.done : state == UnitState::failed ? status.failed : status.missing);
  }
  return status;
}

}  // namespace tacto::analysis
