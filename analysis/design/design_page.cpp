// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/design/design_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/page/html.hpp"
#include "analysis/page/picture_svg.hpp"
#include "data-schema/base/quantity.hpp"
#include "playback/stability/passive_limit.hpp"

namespace tacto::analysis {
namespace {

using schema::Dimension;
using schema::for_people;

std::string stiffness_words(double n_per_m) {
  return n_per_m < 1e4 ? fmt::format("{:.4g} N/m", n_per_m) : fmt::format("{:.0f} N/m", n_per_m);
}

std::string load_words(const VirtualLoad& load) {
  std::string words = load.stiffness_n_per_m > 0 ? stiffness_words(load.stiffness_n_per_m) : "";
  if (load.damping_n_s_per_m > 0)
    words += fmt::format("{}{:.4g} N s/m", words.empty() ? "" : " and ", load.damping_n_s_per_m);
  return words.empty() ? "-" : words;
}

std::string layer_name(const JudgedLayer& layer) {
  return fmt::format("{} {} of patch '{}'", layer.type, layer.index, layer.patch);
}

bool is_reached(const JudgedLayer& layer) {
  return layer.verdict != Stability::not_reached;
}

std::string limit_words(const JudgedLayer& layer, Holder holder) {
  if (!is_reached(layer)) return "-";
  const double limit = layer.loop.limit(holder, layer.total.damping_n_s_per_m);
  return limit > 0 ? stiffness_words(limit) : "none";
}

std::string delay_words(const JudgedLayer& layer, Holder judged) {
  const double delay_s = layer.loop.largest_delay_s(judged, layer.total);
  if (delay_s < 0) return "none";
  return std::isinf(delay_s) ? "over 50 ticks" : for_people(delay_s, Dimension::time);
}

std::string period_words(const JudgedLayer& layer, Holder judged) {
  const double period_s = layer.loop.greatest_period_s(judged, layer.total);
  if (std::isinf(period_s)) return "any";
  return period_s > 0 ? for_people(period_s, Dimension::time) : "none";
}

std::string passive_speed_words(const JudgedLayer& layer) {
  const double speed = playback::largest_passive_speed_mps(
      layer.loop.axis, layer.loop.timing(), layer.total.stiffness_n_per_m, layer.total.damping_n_s_per_m);
  if (std::isinf(speed)) return "any";
  return speed > 0 ? for_people(speed, Dimension::speed) : "none";
}

std::string layers_table(const Design& design) {
  std::vector<Column<JudgedLayer>> columns = {
      {"layer", layer_name},
      {"asked", [](const JudgedLayer& layer) { return load_words(layer.own); }},
      {"with the layers there",
       [](const JudgedLayer& layer) { return is_reached(layer) ? load_words(layer.total) : "-"; }}};
  for (const Holder holder : holders_of(design.request))
    columns.push_back({holder_name(holder, design.request),
                       [holder](const JudgedLayer& layer) { return limit_words(layer, holder); }});
  columns.push_back({"margin", [](const JudgedLayer& layer) {
                       return is_reached(layer) && std::isfinite(layer.margin)
                                  ? fmt::format("{:.3g}", layer.margin)
                                  : "-";
                     }});
  columns.push_back({"verdict", [](const JudgedLayer& layer) {
                       return layer.because.empty()
                                  ? std::string(to_string(layer.verdict))
                                  : fmt::format("{}: {}", to_string(layer.verdict), layer.because);
                     }});
  return html_table(design.layers, columns);
}

std::string needs_table(const Design& design) {
  std::vector<JudgedLayer> judged;
  std::ranges::copy_if(design.layers, std::back_inserter(judged), is_reached);
  const Holder holder = design.request.judged;
  return html_table(
      judged, {{"layer", layer_name},
               {"axis", [](const JudgedLayer& layer) { return layer.loop.axis.name; }},
               {"longest period", [holder](const JudgedLayer& layer) { return period_words(layer, holder); }},
               {"longest delay", [holder](const JudgedLayer& layer) { return delay_words(layer, holder); }},
               {"friction for any hand",
                [](const JudgedLayer& layer) {
                  return fmt::format("{:.4g} N s/m", playback::passive_damping_needed(
                                                         layer.loop.timing(), layer.total.stiffness_n_per_m,
                                                         layer.total.damping_n_s_per_m));
                }},
               {"passive below", passive_speed_words}});
}

std::string remedies_table(const Design& design) {
  return html_table(design.remedies, {{"change", &Remedy::change},
                                      {"now", &Remedy::now},
                                      {"needed", &Remedy::needed},
                                      {"limit then", [](const Remedy& r) {
                                         return r.limit_n_per_m ? stiffness_words(*r.limit_n_per_m) : "-";
                                       }}});
}

constexpr const char* kDesignNotes =
    "<h2>What the limits mean</h2>\n"
    "<p>A limit is the stiffness below which a virtual spring is stable, with the virtual damping of the "
    "layers there. "
    "<em>Computed</em>: by the eigenvalues of the exact discretisation, with the force held from tick to "
    "tick and the "
    "delay of the device; without Coulomb friction, encoder steps and force limits. <em>Proved</em>: the "
    "friction of the "
    "device dissipates at least the energy that the sampled spring and damper give, encoder steps included "
    "(Colgate and Schenkel 1997; Abbott and Okamura 2005), so that no passive hand makes it unstable. The "
    "velocity is "
    "that between two ticks; the kernel averages a slow one over more ticks, which delays a damper. Nothing "
    "here is "
    "simulated.</p>\n"
    "<p>The margin is the factor by which the stiffness and damping at that place may grow together. Longest "
    "period and "
    "delay are those of the limit that is judged.</p>\n";

}  // namespace

std::string design_verdict(const Design& design) {
  const auto unknown = std::ranges::find_if(design.layers, [](const JudgedLayer& layer) {
    return layer.verdict == Stability::not_known && layer.own.is_nothing();
  });
  const std::string rest = unknown == design.layers.end()
                               ? ""
                               : fmt::format("; not known: {}, {}", layer_name(*unknown), unknown->because);
  if (!design.first) return "no spring or damper is within reach" + rest;
  const JudgedLayer& layer = design.layers[*design.first];
  const std::string where = fmt::format("{} along {}", layer_name(layer), layer.loop.axis.name);
  if (layer.verdict == Stability::stable)
    return fmt::format("stable: {} is nearest to its limit, margin {:.3g} ({}){}", where, layer.margin,
                       layer.because, rest);
  const Holder judged = design.request.judged;
  const Holder holder = layer.verdict == Stability::unstable && is_proof(judged) ? Holder::nothing : judged;
  const double limit = layer.loop.limit(holder, layer.total.damping_n_s_per_m);
  const std::string limited =
      limit > 0 ? ", the limit is " + stiffness_words(limit) : ", and a smaller stiffness does not suffice";
  return fmt::format("{}: {} has {}{} ({}){}", to_string(layer.verdict), where, load_words(layer.total),
                     limited, layer.because, rest);
}

std::vector<schema::ResultFigure> design_figures(const Design& design) {
  const DesignRequest& request = design.request;
  std::vector<schema::ResultFigure> figures = {
      {"verdict", design_verdict(design)},
      {"judged", holder_name(request.judged, request)},
      {"rate", for_people(request.rate_hz, Dimension::frequency)},
      {"delay", for_people(request.device.delay_s, Dimension::time)}};
  for (const schema::DeviceAxis& axis : request.device.axes)
    if (axis.name != "z")
      figures.push_back(
          {"axis " + axis.name,
           fmt::format("{:.4g} kg, {:.4g} N s/m, Coulomb friction {}, encoder step {}", axis.mass_kg,
                       axis.viscous_n_s_per_m, for_people(axis.coulomb_n, Dimension::force),
                       for_people(axis.encoder_step_m, Dimension::length))});
  if (request.hand)
    figures.push_back({"hand", fmt::format("{}: {:.4g} kg, {:.4g} N s/m, {:.4g} N/m", request.hand->name,
                                           request.hand->mass_kg, request.hand->damping_n_s_per_m,
                                           request.hand->stiffness_n_per_m)});
  for (const Remedy& remedy : design.remedies)
    figures.push_back({"remedy: " + remedy.change, fmt::format("{} (now {})", remedy.needed, remedy.now)});
  return figures;
}

std::vector<LayerField> layer_fields(const JudgedLayer& layer, const DesignRequest& request) {
  const bool reached = is_reached(layer);
  const auto if_reached = [&](double value) { return reached ? value : NAN; };
  std::vector<LayerField> fields = {{"patch", layer.patch},
                                    {"layer", static_cast<double>(layer.index)},
                                    {"type", layer.type},
                                    {"stiffness_n_per_m", layer.own.stiffness_n_per_m},
                                    {"damping_n_s_per_m", layer.own.damping_n_s_per_m},
                                    {"total_stiffness_n_per_m", if_reached(layer.total.stiffness_n_per_m)},
                                    {"total_damping_n_s_per_m", if_reached(layer.total.damping_n_s_per_m)},
                                    {"axis", layer.loop.axis.name}};
  constexpr std::pair<Holder, const char*> kLimits[] = {{Holder::nothing, "free_limit_n_per_m"},
                                                        {Holder::hand, "hand_limit_n_per_m"},
                                                        {Holder::lumped, "lumped_limit_n_per_m"},
                                                        {Holder::any, "any_hand_limit_n_per_m"},
                                                        {Holder::slower, "slower_hand_limit_n_per_m"}};
  const std::vector<Holder> has = holders_of(request);
  for (const auto& [holder, key] : kLimits) {
    const bool known = reached && std::ranges::find(has, holder) != has.end();
    fields.push_back({key, known ? layer.loop.limit(holder, layer.total.damping_n_s_per_m) : NAN});
  }
  fields.push_back({"margin", if_reached(layer.margin)});
  fields.push_back({"verdict", std::string(to_string(layer.verdict))});
  fields.push_back({"because", layer.because});
  return fields;
}

std::string design_csv(const Design& design) {
  std::string csv;
  for (const auto& [key, value] : layer_fields(design.layers.front(), design.request))
    csv += (csv.empty() ? "" : ",") + key;
  const auto quoted = [](std::string text) {
    for (std::size_t at = 0; (at = text.find('"', at)) != text.npos; at += 2) text.insert(at, 1, '"');
    return '"' + text + '"';
  };
  for (const JudgedLayer& layer : design.layers) {
    char separator = '\n';
    for (const auto& [key, value] : layer_fields(layer, design.request)) {
      csv += separator;
      separator = ',';
      const auto* number = std::get_if<double>(&value);
      if (number == nullptr)
        csv += quoted(std::get<std::string>(value));
      else if (std::isfinite(*number))
        csv += fmt::format("{:.9g}", *number);
    }
  }
  return csv + '\n';
}

schema::Result<std::string> design_page(const Design& design, const std::string& scene,
                                        const std::vector<schema::ResultPicture>& pictures) {
  const auto drawn = pictures_html(pictures, "");
  TACTO_TRY(drawn);
  std::vector<schema::ResultFigure> figures = design_figures(design);
  std::erase_if(figures, [](const auto& figure) {
    return figure.name == "verdict" || figure.name.starts_with("remedy: ");
  });
  std::string body = fmt::format("<h1>{}</h1>\n", escaped(scene + " on " + design.request.device.name)) +
                     answer(design_verdict(design)) + figures_html(figures) + "<h2>Layers</h2>\n" +
                     layers_table(design);
  if (!design.remedies.empty())
    body +=
        fmt::format(
            "<h2>What would make it stable</h2>\n<p>Each change alone, for {} ({}); the limit is computed "
            "again.</p>\n",
            escaped(layer_name(design.layers[*design.first])),
            escaped(holder_name(design.request.judged, design.request))) +
        remedies_table(design);
  body += *drawn + "<h2>What each layer needs</h2>\n" + needs_table(design) + kDesignNotes;
  return html_document("Stability of " + scene, body);
}

}  // namespace tacto::analysis
