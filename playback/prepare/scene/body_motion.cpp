// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/prepare/scene/body_motion.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "playback/stability/free_limit.hpp"

namespace tacto::playback {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

namespace {

// (z - 1 + e^-z) / z^2; below 1e-3 by its series, whose next term is z^4 / 720.
double second_integral(double z) {
  return z < 1e-3 ? 0.5 - z / 6 + z * z / 24 - z * z * z / 120 : (z + std::expm1(-z)) / (z * z);
}

struct Coupling {
  double stiffness_n_per_m = 0, damping_n_s_per_m = 0;
};

std::optional<Coupling> coupling_of(const schema::ForceLayer& layer) {
  using Found = std::optional<Coupling>;
  return layer.visit(
      [](const schema::BodyLayer& body) -> Found {
        return {{largest_value(body.stiffness_n_per_m), least_value(body.damping_n_s_per_m)}};
      },
      [](const schema::LassoLayer& lasso) -> Found {
        return {{largest_value(lasso.stiffness_n_per_m), lasso.damping_n_s_per_m.value}};
      },
      [](const auto& /*other*/) -> Found { return std::nullopt; });
}

Result<void> check_coupling(const schema::ForceLayer& layer, const std::string& where, double rate_hz) {
  const auto coupling = coupling_of(layer);
  if (!coupling) return {};
  const double stiffest = stiffest_coupling_n_per_m(layer, 1 / rate_hz);
  if (coupling->stiffness_n_per_m < stiffest) return {};
  return fail(
      ErrorKind::unsuitable,
      fmt::format("{:.4g} N/m are too stiff for {:g} Hz: with this mass and a damping of {:.4g} N s/m "
                  "the stiffness has to be below {:.6g} N/m",
                  coupling->stiffness_n_per_m, rate_hz, coupling->damping_n_s_per_m, stiffest),
      where + "/stiffness_n_per_m",
      "choose less stiffness, more damping_n_s_per_m (for a body above stiffness / (2 rate) and below "
      "2 mass rate) or a higher rate");
}

}  // namespace

core::BodyTable body_table(double mass_kg, double damping_n_s_per_m, double tick_s) {
  const double z = damping_n_s_per_m * tick_s / mass_kg;
  const double by_speed_s = z > 0 ? -tick_s * std::expm1(-z) / z : tick_s;
  return {static_cast<float>(std::expm1(-z)), static_cast<float>(by_speed_s),
          static_cast<float>(by_speed_s / mass_kg),
          static_cast<float>(tick_s * tick_s / mass_kg * second_integral(z))};
}

double stiffest_coupling_n_per_m(const schema::ForceLayer& layer, double tick_s) {
  return layer.visit(
      [&](const schema::BodyLayer& body) {
        const bool carries = largest_value(body.damping_n_s_per_m) < 2 * body.mass_kg.value / tick_s;
        return carries ? 2 * least_value(body.damping_n_s_per_m) / tick_s : 0;
      },
      [&](const schema::LassoLayer& lasso) {
        return free_stiffness_limit(lasso.mass_kg.value, lasso.damping_n_s_per_m.value, tick_s, 0);
      },
      [](const auto& /*without a body*/) { return static_cast<double>(INFINITY); });
}

Result<void> check_bodies(const schema::Scene& scene, const std::string& where, double rate_hz) {
  std::size_t bodies = 0;
  for (std::size_t i = 0; i < scene.patches.size(); ++i)
    for (std::size_t j = 0; j < scene.patches[i].layers.size(); ++j) {
      const schema::ForceLayer& layer = scene.patches[i].layers[j];
      const std::string place = fmt::format("{}#/patches/{}/layers/{}", where, i, j);
      TACTO_TRY(check_coupling(layer, place, rate_hz));
      if (coupling_of(layer) && ++bodies > core::kMostSceneBodies)
        return fail(ErrorKind::unsuitable,
                    fmt::format("the scene has more than {} bodies and lassos", core::kMostSceneBodies),
                    place, "make two scenes of it");
    }
  return {};
}

}  // namespace tacto::playback
