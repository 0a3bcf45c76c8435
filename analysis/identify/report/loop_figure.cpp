// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/report/loop_figure.hpp"

#include <fmt/format.h>

namespace tacto::analysis {
namespace {

constexpr double kMicrometresAMetre = 1e6;

spatial::Series loop_series(const char* name, const LoopFit& fit, const std::vector<double>& displacement_m,
                            std::size_t colour) {
  spatial::Series series{name, fit.loop_v, displacement_m, spatial::series_colour(colour)};
  for (double& value : series.y) value *= kMicrometresAMetre;
  return series;
}

}  // namespace

spatial::LineFigure loop_figure(const LoopFit& fit, const schema::Transducer& found) {
  spatial::LineFigure figure;
  figure.title = found.identification->usable() ? "Hysteresis" : "Hysteresis: THE MODEL DOES NOT FIT";
  figure.subtitle = fmt::format(
      "a loop of {:.3g} %; the operator leaves {:.2g} % of the displacement, a line "
      "{:.3g} %",
      100 * fit.opening, 100 * fit.residual_part, 100 * fit.linear_residual_part);
  figure.x_label = "drive (V)";
  figure.y_label = "displacement (\u00b5m)";
  figure.simulated = found.identification->simulated;
  figure.series = {loop_series("measured", fit, fit.loop_m, 0),
                   loop_series("operator", fit, fit.loop_model_m, 1)};
  figure.series[1].dashed = true;
  figure.size = {480, 440};
  return figure;
}

}  // namespace tacto::analysis
