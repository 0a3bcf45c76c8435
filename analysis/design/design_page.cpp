// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/design/design_page.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>

#include "analysis/page/html.hpp"
#include "analysis/page/picture_svg.hpp"
#include "data-schema/base/quantity.hpp"
#include "data-schema/report/value_text.hpp"
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
  for (const playback::CoupledBody& body : load.bodies)
    words += fmt::format("{}a body of {:.4g} kg on {} and {:.4g} N s/m", words.empty() ? "" : " and ",
                         body.mass_kg, stiffness_words(body.stiffness_n_per_m), body.damping_n_s_per_m);
  return words.empty() ? "-" : words;
}

std::string layer_name(const JudgedLayer& layer) {
  return fmt::format("{} {} of patch '{}'", layer.type, layer.index, layer.patch);
}

bool is_limit(std::string_view key) {
  return key.ends_with("_limit_n_per_m") || key.starts_with("simulated") || key.starts_with("adversary");
}

bool is_verdict(std::string_view key) {
  return !is_limit(key);
}

bool is_layer_or_limit(std::string_view key) {
  return key == "patch" || key == "layer" || is_limit(key);
}

// Columns that are empty in all rows are left out.
std::string rows_table(const std::vector<cli::Report>& rows, bool (*shown)(std::string_view key)) {
  std::vector<std::string> keys;
  for (const cli::Report& row : rows)
    for (const auto& [key, value] : cli::ReportPrinter::entries(row))
      if (shown(key) && std::ranges::find(keys, key) == keys.end()) keys.push_back(key);
  return html_table(cli::labels_of(keys), rows.size(), [&](std::size_t row, std::size_t column) {
    for (const auto& [key, value] : cli::ReportPrinter::entries(rows[row]))
      if (key == keys[column]) return cli::cell_text(key, value);
    return std::string("-");
  });
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
    "(Colgate and Schenkel 1997; Abbott and Okamura 2005), so that no passive hand makes it unstable. Both "
    "take the velocity of a damper between two ticks; the kernel averages a slow one over more ticks, which "
    "delays a damper. <em>Simulated</em> (--simulate): taps and presses on the stiffest place, with the "
    "device's kernel on the emulated device: encoder, friction, delay and force limits included; the RMS of "
    "the place (in counts of the encoder) and of the force in the last quarter of the time. An edge at which "
    "the force jumps may oscillate, too: the limits do not have it. "
    "<em>Adversary</em> (--adversary): the stiffness from which on one of the random paths gives more energy "
    "than friction dissipates.</p>\n"
    "<p>The margin is the factor by which the stiffness and damping at that place may grow together. Longest "
    "period and "
    "delay are those of the limit that is judged. A body or a lasso is a mass in the same loop: its limits "
    "are "
    "those of the springs beside it, and no proof covers it.</p>\n";

// A proof for more hands than the one that is judged has its own, smaller margin.
std::string margin_words(const JudgedLayer& layer, const DesignRequest& request) {
  std::string words =
      fmt::format("margin {:.3g} with {} ({})", layer.margin, holder_name(request.judged, request),
                  is_proof(request.judged) ? "proved" : "computed");
  for (const Holder holder : {Holder::slower, Holder::any}) {
    if (holder == request.judged || request.judged == Holder::lumped) continue;
    if (holder == Holder::slower && !request.speed_mps) continue;
    if (layer.loop.carries(holder, layer.total))
      words += fmt::format(", {:.3g} with {} (proved)", layer.loop.margin(holder, layer.total),
                           holder_name(holder, request));
  }
  return words;
}

// The answer in one sentence.
std::string design_verdict(const Design& design) {
  std::vector<std::string> unknown;
  for (const JudgedLayer& each : design.layers)
    if (each.verdict == Stability::not_known && is_nothing(each.own)) unknown.push_back(layer_name(each));
  const std::string rest = unknown.empty() ? "" : fmt::format("; not known: {}", fmt::join(unknown, ", "));
  if (!design.first) return "no spring or damper is within reach" + rest;
  const JudgedLayer& layer = design.layers[*design.first];
  const std::string where = fmt::format("{} along {}", layer_name(layer), layer.loop.axis.name);
  if (layer.verdict == Stability::stable)
    return fmt::format("stable: {} is nearest to its limit, {}{}", where, margin_words(layer, design.request),
                       rest);
  if (is_nothing(layer.total))
    return fmt::format("{}: {} ({}){}", to_string(layer.verdict), where, layer.because, rest);
  const Holder judged = design.request.judged;
  const Holder holder = layer.verdict == Stability::unstable && is_proof(judged) ? Holder::nothing : judged;
  const double limit = layer.loop.limit(holder, layer.total);
  const std::string limited = limit > 0 && !layer.total.bodies.empty()
                                  ? ", the limit of springs beside that is " + stiffness_words(limit)
                              : std::isnan(limit) ? ""
                              : limit > 0         ? ", the limit is " + stiffness_words(limit)
                                                  : ", and a smaller stiffness does not suffice";
  return fmt::format("{}: {} has {}{} ({}){}", to_string(layer.verdict), where, load_words(layer.total),
                     limited, layer.because, rest);
}

std::string damper_words(const Design& design) {
  const JudgedLayer* lowest = nullptr;
  double least = 1 - 2 * kRestingPart;
  bool any = false;
  for (const JudgedLayer& layer : design.layers) {
    if (!layer.simulated || !layer.simulated->limit_n_per_m) continue;
    any = true;
    const Holder holder = design.request.hand ? Holder::hand : Holder::nothing;
    const double part = *layer.simulated->limit_n_per_m / layer.loop.limit(holder, layer.total);
    if (part >= least) continue;
    least = part;
    lowest = &layer;
  }
  if (!any) return "";
  if (lowest == nullptr)
    return "simulated taps on layers with a virtual damper rest up to the computed limit";
  return fmt::format(
      "{}: simulated taps rest within a count up to {}, {:.2g} of the computed limit, which has no encoder "
      "and "
      "takes the velocity between two ticks; the kernel averages a slow one over more ticks",
      layer_name(*lowest), stiffness_words(*lowest->simulated->limit_n_per_m), least);
}

DesignRow layer_row(const JudgedLayer& layer, const DesignRequest& request) {
  const bool reached = layer.verdict != Stability::not_reached;
  const auto if_reached = [&](double value) { return reached ? value : NAN; };
  DesignRow row = {{"patch", layer.patch},
                   {"layer", layer.index},
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
    row.push_back({key, known ? layer.loop.limit(holder, layer.total) : NAN});
  }
  if (request.adversary_paths > 0)
    row.push_back({"adversary_from_n_per_m", layer.generating_n_per_m.value_or(NAN)});
  if (request.simulate) {
    const auto& simulated = layer.simulated;
    row.push_back({"simulated", simulated ? std::string(to_string(simulated->tap.end)) : "not simulated"});
    row.push_back({"simulated_rms_counts", simulated ? simulated->tap.rms_counts : NAN});
    row.push_back({"simulated_rms_n", simulated ? simulated->tap.rms_n : NAN});
    row.push_back({"simulated_limit_n_per_m", simulated ? simulated->limit_n_per_m.value_or(NAN) : NAN});
  }
  row.push_back({"margin", if_reached(layer.margin)});
  row.push_back({"verdict", std::string(to_string(layer.verdict))});
  row.push_back({"because", layer.because});
  return row;
}

}  // namespace

cli::Report design_head(const Design& design) {
  const DesignRequest& request = design.request;
  cli::Report head;
  head.add("verdict", design_verdict(design)).add("device", request.device.name);
  head.add("judged", holder_name(request.judged, request)).add("rate_hz", request.rate_hz);
  head.add("delay_s", request.device.delay_s);
  if (!design.simulated.empty()) head.add("simulated", design.simulated);
  if (const std::string words = damper_words(design); !words.empty()) head.add("damper", words);
  return head;
}

std::vector<schema::ResultFigure> design_figures(const Design& design) {
  const DesignRequest& request = design.request;
  std::vector<schema::ResultFigure> figures;
  const cli::Report head = design_head(design);
  for (const auto& [key, value] : cli::ReportPrinter::entries(head))
    figures.push_back({cli::labels_of({key}).front(), cli::cell_text(key, value)});
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

// Of the place at which a layer is judged; the same for all layers that act there.
DesignRow needs_of_place(const JudgedLayer& layer, const DesignRequest& request) {
  const double stiffness = layer.total.stiffness_n_per_m, damping = layer.total.damping_n_s_per_m;
  const JudgedLoop& loop = layer.loop;
  const auto above = [](double least, double value) { return value > least ? value : NAN; };
  const auto without_bodies = [&](double value) { return layer.total.bodies.empty() ? value : NAN; };
  return {{"x_m", layer.x_m},
          {"y_m", layer.y_m},
          {"greatest_period_s", above(0, loop.greatest_period_s(request.judged, layer.total))},
          {"largest_delay_s", above(-1, loop.largest_delay_s(request.judged, layer.total))},
          {"damping_for_any_hand_n_s_per_m",
           without_bodies(playback::passive_damping_needed(loop.timing(), stiffness, damping))},
          {"any_hand_below_mps",
           without_bodies(playback::largest_passive_speed_mps(loop.axis, loop.timing(), stiffness, damping))},
          {"friction_stops_swings_below_m",
           without_bodies(playback::friction_basin_m(loop.axis, loop.timing(), stiffness, damping))}};
}

cli::Report report_of(const DesignRow& row) {
  cli::Report report;
  for (const auto& [key, value] : row)
    if (const auto* number = std::get_if<double>(&value); number == nullptr || std::isfinite(*number))
      std::visit([&, k = &key](const auto& each) { report.add(*k, each); }, value);
  return report;
}

DesignTables design_tables(const Design& design) {
  DesignTables tables;
  std::map<std::vector<std::size_t>, DesignRow>
      needs;  // a period and a delay take most of the time of design
  for (const JudgedLayer& layer : design.layers) {
    tables.layers.push_back(report_of(layer_row(layer, design.request)));
    if (layer.verdict == Stability::not_reached) continue;
    const auto [found, fresh] = needs.try_emplace(layer.acting);
    if (fresh) found->second = needs_of_place(layer, design.request);
    DesignRow row = {{"patch", layer.patch}, {"layer", layer.index}};
    row.insert(row.end(), found->second.begin(), found->second.end());
    tables.needs.push_back(report_of(row));
  }
  for (const auto& [change, now, needed, limit_n_per_m] : design.remedies)
    tables.remedies.push_back(report_of({{"change", change},
                                         {"now", now},
                                         {"needed", needed},
                                         {"limit_n_per_m", limit_n_per_m.value_or(NAN)}}));
  return tables;
}

std::string design_csv(const Design& design) {
  std::string csv;
  for (const auto& [key, value] : layer_row(design.layers.front(), design.request))
    csv += (csv.empty() ? "" : ",") + key;
  const auto quoted = [](std::string text) {
    for (std::size_t at = 0; (at = text.find('"', at)) != text.npos; at += 2) text.insert(at, 1, '"');
    return '"' + text + '"';
  };
  for (const JudgedLayer& layer : design.layers) {
    char separator = '\n';
    for (const auto& [key, value] : layer_row(layer, design.request)) {
      csv += separator;
      separator = ',';
      if (const auto* text = std::get_if<std::string>(&value))
        csv += quoted(*text);
      else if (const auto* number = std::get_if<double>(&value); number == nullptr)
        csv += std::to_string(std::get<std::size_t>(value));
      else if (std::isfinite(*number))
        csv += fmt::format("{:.9g}", *number);
    }
  }
  return csv + '\n';
}

schema::Result<std::string> design_page(const Design& design, const std::string& scene,
                                        const std::vector<schema::ResultPicture>& pictures) {
  const auto drawn = pictures_html(pictures, design.simulated);
  TACTO_TRY(drawn);
  std::vector<schema::ResultFigure> figures = design_figures(design);
  std::erase_if(figures, [](const auto& figure) { return figure.name.starts_with("remedy: "); });
  const DesignTables tables = design_tables(design);
  const auto every = [](std::string_view /*key*/) { return true; };
  std::string body = fmt::format("<h1>{}</h1>\n", escaped(scene + " on " + design.request.device.name)) +
                     simulated_box(design.simulated) + answer(design_verdict(design)) +
                     figures_html(figures, {"verdict", "simulated"}) + "<h2>Layers</h2>\n" +
                     rows_table(tables.layers, is_verdict) + "<h2>Limits</h2>\n" +
                     rows_table(tables.layers, is_layer_or_limit);
  if (!tables.remedies.empty())
    body +=
        fmt::format(
            "<h2>What would make it stable</h2>\n<p>Each change alone, for {} ({}); the limit is computed "
            "again.</p>\n",
            escaped(layer_name(design.layers[*design.first])),
            escaped(holder_name(design.request.judged, design.request))) +
        rows_table(tables.remedies, every);
  body += *drawn + "<h2>What each layer needs</h2>\n" + rows_table(tables.needs, every) + kDesignNotes;
  return html_document("Stability of " + scene, body);
}

}  // namespace tacto::analysis
