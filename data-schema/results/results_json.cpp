// SPDX-License-Identifier: GPL-3.0-or-later
// NAME.results.json, read and written.
#include <fmt/format.h>

#include <cmath>

#include "data-schema/files/files.hpp"
#include "data-schema/json/json_document.hpp"
#include "data-schema/kinds/file_kind.hpp"
#include "data-schema/results/results.hpp"

namespace tacto::schema {
namespace {

constexpr std::string_view kResultsKind = "results";

Json curve_body(const ResultCurve& curve) {
  Json body = {{"name", curve.name}, {"dashed", curve.dashed}, {"x", Json::array()}, {"y", Json::array()}};
  if (curve.marks) body["marks"] = true;
  for (std::size_t i = 0; i < std::min(curve.x.size(), curve.y.size()); ++i) {
    if (!std::isfinite(curve.x[i]) || !std::isfinite(curve.y[i])) continue;
    body["x"].push_back(curve.x[i]);
    body["y"].push_back(curve.y[i]);
  }
  return body;
}

ResultCurve curve_from(const Json& body) {
  return {text_or(body, "name"), body["x"].get<std::vector<double>>(), body["y"].get<std::vector<double>>(),
          body.value("dashed", false), body.value("marks", false)};
}

Json picture_body(const ResultPicture& picture) {
  Json body = {{"title", picture.title},
               {"x_label", picture.x_label},
               {"y_label", picture.y_label},
               {"logarithmic_x", picture.logarithmic_x},
               {"curves", Json::array()}};
  for (const ResultCurve& curve : picture.curves) body["curves"].push_back(curve_body(curve));
  return body;
}

ResultPicture picture_from(const Json& body) {
  ResultPicture picture{text_or(body, "title"),
                        text_or(body, "x_label"),
                        text_or(body, "y_label"),
                        body.value("logarithmic_x", false),
                        {}};
  for (const Json& curve : body["curves"]) picture.curves.push_back(curve_from(curve));
  return picture;
}

// A check that a schema cannot express: a curve's points are pairs.
Result<void> check_curves(const Json& body, const std::string& path) {
  for (std::size_t p = 0; p < body["pictures"].size(); ++p) {
    const Json& curves = body["pictures"][p]["curves"];
    for (std::size_t c = 0; c < curves.size(); ++c)
      if (const std::size_t x = curves[c]["x"].size(), y = curves[c]["y"].size(); x != y)
        return fail(ErrorKind::malformed, fmt::format("x has {} values, y has {}", x, y),
                    fmt::format("{}#/pictures/{}/curves/{}", path, p, c));
  }
  return {};
}

std::string results_path(const std::string& name) {
  if (is_file(name)) return name;
  return name.ends_with(".results.json") ? name : name + ".results.json";
}

Result<Json> details_of(const std::string& text) {
  if (text.empty()) return Json::object();
  Json details = Json::parse(text, nullptr, false);
  if (details.is_object()) return details;
  return fail(ErrorKind::unsuitable, "are not a JSON object", "details");
}

}  // namespace

Result<Results> read_results(const std::string& name) {
  const auto document = open_document(results_path(name), kResultsKind);
  TACTO_TRY(document);
  const Json& body = document->body;
  TACTO_TRY(check_curves(body, results_path(name)));
  Results results;
  results.verb = text_or(body, "verb");
  results.inputs = body["inputs"].get<std::vector<std::string>>();
  results.device = text_or(body, "device");
  results.simulated = text_or(body, "simulated");
  for (const Json& each : body["figures"])
    results.figures.push_back({text_or(each, "name"), text_or(each, "value")});
  for (const Json& each : body["pictures"]) results.pictures.push_back(picture_from(each));
  if (body.contains("details")) results.details_json = body["details"].dump();
  results.created = text_or(body, "created");
  results.creator = text_or(body, "creator");
  keep_unknown(*document, results);
  return results;
}

Result<std::string> results_json(const Results& results) {
  const auto details = details_of(results.details_json);
  TACTO_TRY(details);
  Json body = {{"verb", results.verb}, {"inputs", results.inputs}};
  put_text(body, "device", results.device);
  put_text(body, "simulated", results.simulated);
  put_text(body, "created", results.created);
  put_text(body, "creator", results.creator);
  body["figures"] = Json::array();
  for (const ResultFigure& figure : results.figures)
    body["figures"].push_back({{"name", figure.name}, {"value", figure.value}});
  body["pictures"] = Json::array();
  for (const ResultPicture& picture : results.pictures) body["pictures"].push_back(picture_body(picture));
  body["details"] = *details;
  return document_text(kResultsKind, body, results.extra_json);
}

Result<void> check_results_free(const std::string& path, Existing existing) {
  if (!is_file(path)) return check_output_free(path, existing);
  const auto there = stored_files(path);
  if (there && there->front().kind == FileKind::results) return check_output_free(path, existing);
  return fail(ErrorKind::usage,
              there ? fmt::format("is a {} and is not overwritten", kind_name(there->front().kind))
                    : "is not a file of results and is not overwritten",
              path, "choose another name");
}

}  // namespace tacto::schema
