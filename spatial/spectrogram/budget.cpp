// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/spectrogram/budget.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "spatial/texture/make_texture.hpp"

namespace tacto::spatial {
namespace {

using schema::ErrorKind;
using schema::Result;

constexpr double kBytesPerSample = 4;
// The monotone cubics are not linear: the error of a mixture can exceed that of the sine at its upper edge by
// a little (1 % in 700 draws of spatial_budget_test).
constexpr double kMargin = 1.1;
constexpr double kMaxTextureError = 0.1;
constexpr std::array kMethods = {ResampleMethod::hermite, ResampleMethod::sinc};

Result<schema::MeasuredChoice> measured(const schema::TradeTable& table, const char* stage,
                                        std::string_view name) {
  for (const schema::MeasuredChoice& choice : table.choices)
    if (choice.stage == stage && choice.name == name && !choice.errors.empty()) return choice;
  return schema::fail(ErrorKind::unsuitable, fmt::format("contains no errors for {} by {}", stage, name),
                      "the table of measured choices", "measure again with 'tactograph trade --calibrate'");
}

std::vector<ResampleMethod> methods_for(const TextureNeed& need) {
  if (need.method) return {*need.method};
  return {kMethods.begin(), kMethods.end()};
}

std::vector<double> pitches_for(const TextureNeed& need) {
  if (need.pitch_m) return {*need.pitch_m};
  return {std::begin(kGrids_m), std::end(kGrids_m)};
}

TextureChoice choice_of(ResampleMethod method, double pitch_m, const TextureNeed& need,
                        const schema::MeasuredChoice& resampling, const schema::MeasuredChoice& grid) {
  const double period_m = kPromisedSpeed * need.slowest_mps / need.highest_hz;
  const auto finer = static_cast<double>(finer_grid(pitch_m, need.highest_hz, need.slowest_mps));
  return {method, pitch_m,
          kMargin * (resampling.error_at(need.sample_rate_hz / need.highest_hz) +
                     grid.error_at(period_m / pitch_m)),
          resampling.cost_ns * finer / pitch_m + grid.cost_ns / pitch_m, kBytesPerSample / pitch_m};
}

Result<std::vector<TextureChoice>> tried_for(const schema::TradeTable& table, const TextureNeed& need) {
  const auto grid = measured(table, kGridStage, "hermite");
  TACTO_TRY(grid);
  std::vector<TextureChoice> tried;
  for (const ResampleMethod method : methods_for(need)) {
    const auto resampling = measured(table, kResamplingStage, name_of(method));
    TACTO_TRY(resampling);
    for (const double pitch_m : pitches_for(need))
      tried.push_back(choice_of(method, pitch_m, need, *resampling, *grid));
  }
  std::ranges::stable_sort(tried, {}, &TextureChoice::cost_ns_per_m);
  return tried;
}

}  // namespace

Result<TextureChoices> choose_texture(const schema::TradeTable& table, const TextureNeed& need,
                                      const schema::Budget& budget) {
  if (budget.max_error && !(*budget.max_error > 0 && *budget.max_error <= kMaxTextureError))
    return schema::fail(ErrorKind::usage,
                        fmt::format("an error of {:g} % is not possible", 100 * *budget.max_error),
                        "--max-error", "use a value above 0 and at most 10%");
  auto tried = tried_for(table, need);
  TACTO_TRY(tried);
  const auto least = std::ranges::min_element(*tried, {}, &TextureChoice::error);
  const auto keeps = [&](const TextureChoice& choice) { return choice.error <= budget.most_error(); };
  const auto taken = budget.most_exact() ? least : std::ranges::find_if(*tried, keeps);
  if (taken == tried->end())
    return schema::fail(
        ErrorKind::unsuitable,
        fmt::format("no {} keeps the error below {:.3g} %: the smallest is {:.3g} %, by {} on a grid of {}",
                    need.method || need.pitch_m ? "choice with the given options" : "choice",
                    100 * budget.most_error(), 100 * least->error, name_of(least->method),
                    schema::length_for_people(least->pitch_m)),
        {}, "allow a larger error, lower the upper edge of the band, or record at a higher rate");
  return TextureChoices{*taken, *tried};
}

Result<std::vector<ResolutionChoice>> resolutions_of(const schema::TradeTable& table) {
  std::vector<ResolutionChoice> choices;
  for (const auto& [name, resolution] :
       {std::pair{"auto", Resolution::automatic}, std::pair{"whole", Resolution::whole}}) {
    const auto found = measured(table, kSpectrogramStage, name);
    TACTO_TRY(found);
    constexpr double kAnyPoints = 1e9;
    choices.push_back({resolution, found->error_at(kAnyPoints), found->cost_ns});
  }
  std::ranges::stable_sort(choices, {}, &ResolutionChoice::cost_ns_per_cell);
  return choices;
}

Result<ResolutionChoice> choose_resolution(const schema::TradeTable& table, std::optional<Resolution> named,
                                           const schema::Budget& budget) {
  auto choices = resolutions_of(table);
  TACTO_TRY(choices);
  if (named) std::erase_if(*choices, [&](const ResolutionChoice& each) { return each.resolution != *named; });
  const auto least = std::ranges::min_element(*choices, {}, &ResolutionChoice::error);
  const auto keeps = [&](const ResolutionChoice& choice) { return choice.error <= budget.most_error(); };
  const auto taken = budget.most_exact() ? least : std::ranges::find_if(*choices, keeps);
  if (taken != choices->end()) return *taken;
  return schema::fail(
      ErrorKind::unsuitable,
      fmt::format("no method keeps the error below {:.3g} %: single precision leaves {:.2g} %",
                  100 * budget.most_error(), 100 * least->error),
      {}, "allow a larger error");
}

}  // namespace tacto::spatial
