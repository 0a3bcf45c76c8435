// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/experiment/study_export.hpp"

#include <fmt/format.h>

#include <cctype>
#include <filesystem>
#include <utility>

#include "analysis/experiment/study_answers.hpp"
#include "analysis/experiment/withdrawal.hpp"
#include "data-schema/experiment/trials_table.hpp"
#include "data-schema/version.hpp"

namespace tacto::analysis {

using schema::Result;

namespace {

bool is_two_interval(const schema::Protocol& protocol) {
  return protocol.task == schema::Task::two_interval;
}

constexpr const char* kScript =
    R"R(# Generalised linear mixed model (probit) of the answers of all persons, by lme4: the point of subjective
# equality (PSE) and the just noticeable difference (JND, from there to 75 %) of the average person.
#   Rscript analysis.R                                            trials.csv beside this script
#   Rscript analysis.R TABLE PERSON LEVEL YES [NO [CONDITION]]    another table, by the names of its columns
arguments <- commandArgs(trailingOnly = TRUE)
script <- sub("^--file=", "", grep("^--file=", commandArgs(), value = TRUE)[1])
if (length(arguments) == 0)
  arguments <- c(file.path(dirname(script), "trials.csv"), "participant", "nominal_stretch", "seemed_longer")
trials <- read.csv(arguments[1])
if ("delivered" %in% names(trials)) trials <- trials[trials$delivered == "yes" & !is.na(trials$seemed_longer), ]
answers <- data.frame(person = factor(trials[[arguments[2]]]), level = trials[[arguments[3]]],
                      yes = trials[[arguments[4]]])
answers$no <- if (length(arguments) > 4) trials[[arguments[5]]] else 1 - answers$yes
answers$condition <- factor(if (length(arguments) > 5) trials[[arguments[6]]] else "all")
several <- nlevels(answers$condition) > 1
# Stretches of one sign cannot separate the PSE from the JND: then it is 0.
no_pse <- arguments[3] == "nominal_stretch" && (all(answers$level > 0) || all(answers$level < 0))
fixed <- if (several) "cbind(yes, no) ~ 0 + condition + condition:level" else if (no_pse) "cbind(yes, no) ~ 0 + level" else "cbind(yes, no) ~ level"
if (nlevels(answers$person) > 1) {
  model <- lme4::glmer(as.formula(paste(fixed, if (no_pse) "+ (0 + level | person)" else "+ (1 + level | person)")), family = binomial("probit"), data = answers)
  b <- lme4::fixef(model)
} else {
  b <- coef(glm(as.formula(fixed), family = binomial("probit"), data = answers))
}
conditions <- levels(answers$condition)
intercept <- if (several) b[paste0("condition", conditions)] else if (no_pse) 0 else b["(Intercept)"]
slope <- if (several) b[paste0("condition", conditions, ":level")] else b["level"]
write.csv(data.frame(condition = conditions, pse = -intercept / slope, jnd = qnorm(0.75) / slope),
          row.names = FALSE, quote = FALSE)
)R";

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == at)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

std::string json_text(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' || c == '\\' ? std::string{'\\', c} : std::string(1, c);
  return quoted + "\"";
}

std::string row_of(const std::vector<std::string>& cells, char between,
                   std::string (*cell)(const std::string&)) {
  std::string row;
  for (std::size_t i = 0; i < cells.size(); ++i)
    row += (i > 0 ? std::string(1, between) : "") + cell(cells[i]);
  return row + "\n";
}

std::string bids_cell(const std::string& text) {
  return text.empty() ? "n/a" : text;
}

bool is_right(const Run& run, const Attempt& attempt) {
  if (run.study.protocol.task == schema::Task::fidelity)
    return (attempt.answered->choice == schema::kSameChoice) == (attempt.trial.code == attempt.trial.sample);
  return is_two_interval(run.study.protocol)
             ? seemed_longer(attempt)
             : attempt.answered->word == stimulus_of(run.study.key, attempt.trial.code).name;
}

// The cells of trials_table(); with seemed_longer of two intervals, with correct of an identification and a
// fidelity.
std::vector<std::vector<std::string>> rows_of(const Run& run) {
  std::vector<std::vector<std::string>> rows;
  std::vector<const Attempt*> attempts = {nullptr};  // of each line
  for (const Attempt& each : run.queue.attempts())
    if (!each.trial.is_practice()) attempts.push_back(&each);
  std::vector<std::string> lines = split(trials_table(run), '\n');
  lines.pop_back();
  for (std::size_t i = 0; i < lines.size(); ++i) {
    rows.push_back(split(lines[i], '\t'));
    const schema::Task task = run.study.protocol.task;
    if (!is_two_interval(run.study.protocol) && task != schema::Task::identification &&
        task != schema::Task::fidelity)
      continue;
    const Attempt* const attempt = attempts[i];
    const bool answered = attempt != nullptr && attempt->answered;
    const char* const name = is_two_interval(run.study.protocol) ? "seemed_longer" : "correct";
    rows.back().emplace_back(attempt == nullptr ? name
                             : !answered        ? ""
                                                : (is_right(run, *attempt) ? "1" : "0"));
  }
  return rows;
}

// A label has letters and digits only.
std::string task_label(const std::string& study) {
  std::string label;
  for (const char c : study)
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) label += c;
  return label.empty() ? "study" : label;
}

std::string sidecar(const std::string& task, const std::vector<std::string>& names) {
  std::string text = "{\n  \"TaskName\": " + json_text(task);
  for (const std::string& name : names) {
    const auto [description, units] = schema::trials_column(name);
    text += fmt::format(",\n  {}: {{\"Description\": {}", json_text(name), json_text(description));
    if (!units.empty()) text += fmt::format(", \"Units\": {}", json_text(units));
    text += "}";
  }
  return text + "\n}\n";
}

class Export {
 public:
  explicit Export(std::string folder) : folder_(std::move(folder)) {}

  Result<void> add(const std::string& name, const std::string& text) {
    files_.push_back((std::filesystem::path(folder_) / name).string());
    return pending_.write(files_.back(), text);
  }
  Result<void> add_run(const Run& run, const std::string& task) {
    const std::string subject = "sub-" + run.journal.plan.participant;
    const std::string stem = fmt::format("{0}/beh/{0}_task-{1}_beh", subject, task);
    std::string table;
    const auto rows = rows_of(run);
    for (const auto& row : rows) table += row_of(row, '\t', bids_cell);
    TACTO_TRY(add(stem + ".tsv", table));
    return add(stem + ".json", sidecar(task, rows.front()));
  }
  Result<void> commit(schema::Existing existing) { return pending_.commit(existing); }
  const std::vector<std::string>& files() const { return files_; }

 private:
  std::string folder_;
  std::vector<std::string> files_;
  schema::PendingFiles pending_;
};

std::string csv_of(const std::vector<Run>& runs) {
  std::string csv;
  for (const Run& run : runs) {
    auto rows = rows_of(run);
    if (!csv.empty()) rows.erase(rows.begin());
    for (auto& row : rows) {
      row.insert(row.begin(), csv.empty() ? "participant" : run.journal.plan.participant);
      csv += row_of(row, ',', csv_cell);
    }
  }
  return csv;
}

std::string participants_of(const std::vector<Run>& runs) {
  std::string table = "participant_id\tcomplete\tsimulated\tmasking_level\n";
  for (const Run& run : runs)
    table += fmt::format("sub-{}\t{}\t{}\t{}\n", run.journal.plan.participant,
                         run.queue.has_ended() ? "yes" : "no", bids_cell(run.journal.plan.observer),
                         bids_cell(run.journal.plan.masking_level));
  return table;
}

}  // namespace

Result<std::vector<std::string>> export_study(const std::string& study, const std::string& folder,
                                              bool unblind, schema::Existing existing) {
  const auto runs = answered_runs(study, unblind);
  TACTO_TRY(runs);
  const std::string name = runs->front().study.name(), task = task_label(name);
  Export all(folder);
  TACTO_TRY(all.add("trials.csv", csv_of(*runs)));
  if (is_two_interval(runs->front().study.protocol)) TACTO_TRY(all.add("analysis.R", kScript));
  TACTO_TRY(all.add("dataset_description.json",
                    fmt::format("{{\"Name\": {}, \"BIDSVersion\": \"1.8.0\", \"DatasetType\": \"raw\", "
                                "\"GeneratedBy\": [{{\"Name\": {}}}]}}\n",
                                json_text(name), json_text(std::string(kCreator)))));
  TACTO_TRY(all.add("participants.tsv", participants_of(*runs)));
  for (const Run& run : *runs) TACTO_TRY(all.add_run(run, task));
  // The log first: what it names may be missing, but no file is unknown to a withdrawal.
  TACTO_TRY(log_outputs(runs->front().study.stem, all.files()));
  TACTO_TRY(all.commit(existing));
  return all.files();
}

}  // namespace tacto::analysis
