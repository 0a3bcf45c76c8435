// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/corpus/corpus_plan.hpp"

#include <fmt/format.h>

#include "data-schema/json/json_document.hpp"
#include "data-schema/json/known_members.hpp"

namespace tacto::schema {
namespace {

constexpr std::string_view kCorpusKind = "corpus";
constexpr std::string_view kStepsInOrder[] = {"spatial", "describe"};

Result<void> check_order(const std::vector<CorpusStep>& steps, const std::string& where) {
  for (std::size_t i = 0; i < steps.size(); ++i)
    if (i >= std::size(kStepsInOrder) || steps[i].step != kStepsInOrder[i])
      return fail(ErrorKind::malformed, fmt::format("'{}' cannot be step {}", steps[i].step, i + 1),
                  fmt::format("{}#/steps/{}/step", where, i),
                  "the steps are spatial, or spatial and describe");
  return {};
}

}  // namespace

Result<CorpusPlan> read_corpus_plan(const std::string& path) {
  const auto document = open_document(path, kCorpusKind);
  TACTO_TRY(document);
  TACTO_TRY(check_document_known(*document, kCorpusKind, path));
  const Json& body = document->body;
  CorpusPlan plan;
  for (const Json& each : body["steps"])
    plan.steps.push_back({text_or(each, "step"), text_or(each, "options")});
  TACTO_TRY(check_order(plan.steps, path));
  plan.recordings.reserve(body["recordings"].size());
  for (const Json& each : body["recordings"])
    plan.recordings.push_back({text_or(each, "path"), text_or(each, "sha256")});
  plan.created = text_or(body, "created");
  plan.creator = text_or(body, "creator");
  keep_unknown(*document, plan);
  return plan;
}

Result<std::string> corpus_plan_json(const CorpusPlan& plan) {
  TACTO_TRY(check_order(plan.steps, ""));
  Json body = Json::object();
  put_text(body, "created", plan.created);
  put_text(body, "creator", plan.creator);
  body["steps"] = Json::array();
  for (const CorpusStep& each : plan.steps)
    body["steps"].push_back({{"step", each.step}, {"options", each.options}});
  body["recordings"] = Json::array();
  for (const CorpusRecording& each : plan.recordings)
    body["recordings"].push_back({{"path", each.path}, {"sha256", each.sha256}});
  return document_text(kCorpusKind, body, plan.extra_json);
}

}  // namespace tacto::schema
