// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/texture/transform_json.hpp"

#include <algorithm>
#include <array>

#include "data-schema/json/json_document.hpp"

namespace tacto::schema {
namespace {

constexpr std::array<const char*, 4> kOperations = {"stretch", "gain", "mix", "filter"};
constexpr std::array<const char*, 2> kLengthenings = {"periods", "best_fit"};

// The word's place in the list; the schema allows no other words.
template <class Word, std::size_t kCount>
Word word_from(const std::array<const char*, kCount>& words, const std::string& text) {
  const auto found = std::ranges::find(words, text);
  return static_cast<Word>(found == words.end() ? 0 : found - words.begin());
}

Json step_body(const TransformStep& step) {
  Json body = {{"operation", operation_name(step.operation)}};
  for (const auto& [name, member] : kTransformNumbers)
    if (step.*member) body[name] = *(step.*member);
  if (step.keep_slope) body["keep_slope"] = *step.keep_slope;
  if (step.lengthening) body["lengthening"] = lengthening_name(*step.lengthening);
  if (step.joints) body["joints"] = *step.joints;
  if (!step.weights.empty()) body["weights"] = step.weights;
  return body;
}

TransformStep step_from(const Json& body) {
  TransformStep step;
  step.operation = word_from<TransformOperation>(kOperations, text_or(body, "operation"));
  for (const auto& [name, member] : kTransformNumbers)
    if (body.contains(name)) step.*member = body[name].get<double>();
  if (body.contains("keep_slope")) step.keep_slope = body["keep_slope"].get<bool>();
  if (body.contains("lengthening"))
    step.lengthening = word_from<Lengthening>(kLengthenings, text_or(body, "lengthening"));
  if (body.contains("joints")) step.joints = body["joints"].get<int>();
  if (body.contains("weights")) step.weights = body["weights"].get<std::vector<double>>();
  return step;
}

}  // namespace

const char* operation_name(TransformOperation operation) {
  return kOperations[static_cast<std::size_t>(operation)];
}

const char* lengthening_name(Lengthening lengthening) {
  return kLengthenings[static_cast<std::size_t>(lengthening)];
}

Json transform_body(const TextureTransform& transform) {
  Json sources = Json::array(), steps = Json::array();
  for (const auto& [texture, sha256] : transform.sources)
    sources.push_back({{"texture", texture}, {"sha256", sha256}});
  for (const TransformStep& step : transform.steps) steps.push_back(step_body(step));
  return {{"sources", sources}, {"steps", steps}};
}

TextureTransform transform_from(const Json& body) {
  TextureTransform transform;
  for (const Json& source : body["sources"])
    transform.sources.push_back({text_or(source, "texture"), text_or(source, "sha256")});
  for (const Json& step : body["steps"]) transform.steps.push_back(step_from(step));
  return transform;
}

}  // namespace tacto::schema
