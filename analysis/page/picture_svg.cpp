// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/page/picture_svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "analysis/page/html.hpp"

namespace tacto::analysis {
namespace {

bool has_point(const schema::ResultPicture& picture) {
  return std::ranges::any_of(picture.curves, [&](const schema::ResultCurve& curve) {
    for (std::size_t i = 0; i < std::min(curve.x.size(), curve.y.size()); ++i)
      if (std::isfinite(curve.x[i]) && std::isfinite(curve.y[i]) &&
          (!picture.logarithmic_x || curve.x[i] > 0))
        return true;
    return false;
  });
}

}  // namespace

spatial::LineFigure figure_of(const schema::ResultPicture& picture, const std::string& simulated) {
  spatial::LineFigure figure;
  figure.title = picture.title;
  figure.x_label = picture.x_label;
  figure.y_label = picture.y_label;
  figure.simulated = simulated;
  if (picture.logarithmic_x) figure.x_scale = spatial::AxisScale::logarithmic;
  std::size_t colour = 0;
  for (const schema::ResultCurve& curve : picture.curves) {
    // A single mark has its name beside it, and no entry of the legend.
    const bool labelled = curve.marks && curve.x.size() == 1;
    // A curve without a name continues the previous one and has its colour.
    if (!labelled && !curve.name.empty() && !figure.series.empty()) ++colour;
    const std::string name = with_micro_signs(curve.name);
    figure.series.push_back({labelled ? "" : name, curve.x, curve.y, spatial::series_colour(colour), 1.2,
                             curve.dashed, curve.marks});
    if (labelled) figure.series.back().labels = {name};
  }
  return figure;
}

schema::Result<std::string> pictures_html(std::span<const schema::ResultPicture> pictures,
                                          const std::string& simulated) {
  std::string html;
  for (const schema::ResultPicture& picture : pictures) {
    if (!has_point(picture)) {
      html += fmt::format("<p class=\"note\">{}: there is nothing to draw</p>\n", escaped(picture.title));
      continue;
    }
    const auto svg = spatial::to_page_svg(figure_of(picture, simulated.empty() ? "" : kSimulatedOnPage));
    TACTO_TRY(svg);
    html += inline_svg(*svg, picture.title + (simulated.empty() ? "" : ", simulated"));
  }
  return html;
}

std::string figures_html(std::span<const schema::ResultFigure> figures,
                         std::initializer_list<std::string_view> stated_above) {
  std::vector<schema::ResultFigure> rows(figures.begin(), figures.end());
  std::erase_if(rows, [&](const schema::ResultFigure& figure) {
    return std::ranges::find(stated_above, figure.name) != stated_above.end();
  });
  return html_table(rows, {{"", &schema::ResultFigure::name}, {"value", &schema::ResultFigure::value}});
}

}  // namespace tacto::analysis
