// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>

#include "analysis/design/boundary.hpp"
#include "analysis/design/design.hpp"
#include "data-schema/base/quantity.hpp"

namespace tacto::analysis {
namespace {

using schema::Dimension;

std::string amount_words(double value, const char* unit) {
  return fmt::format("{:.4g} {}", value, unit);
}

// One layer's loop and the changes to it.
class LayerChanges {
 public:
  LayerChanges(const JudgedLayer& layer, const DesignRequest& request)
      : loop_(layer.loop), load_(layer.total), request_(request), judged_(request.judged) {}

  std::vector<Remedy> all() const {
    std::vector<Remedy> remedies = {stiffness(), rate(), device_damping(), virtual_damping()};
    if (loop_.delay_s > 0) remedies.push_back(delay());
    if (is_proof(judged_)) remedies.push_back(encoder());
    return remedies;
  }

 private:
  double limit_with(JudgedLoop loop, double damping) const { return loop.limit(judged_, damping); }

  Remedy none(std::string change, std::string now, std::string why) const {
    return {std::move(change), std::move(now), std::move(why), std::nullopt};
  }

  Remedy stiffness() const {
    const double limit = loop_.limit(judged_, load_.damping_n_s_per_m);
    const std::string now = amount_words(load_.stiffness_n_per_m, "N/m");
    if (limit <= 0) return none("stiffness", now, "none is small enough");
    return {"stiffness", now, "below " + amount_words(limit, "N/m"), limit};
  }

  JudgedLoop at_rate(double rate_hz) const {
    JudgedLoop loop = loop_;
    loop.period_s = 1 / rate_hz;
    return loop;
  }

  Remedy rate() const {
    const std::string now = schema::for_people(request_.rate_hz, Dimension::frequency);
    for (const double rate_hz : request_.device.rates_hz)
      if (rate_hz > request_.rate_hz && loop_.delay_s * rate_hz <= kMostDelayTicks &&
          at_rate(rate_hz).carries(judged_, load_))
        return {"rate", now, schema::for_people(rate_hz, Dimension::frequency),
                limit_with(at_rate(rate_hz), load_.damping_n_s_per_m)};
    const double period_s = loop_.greatest_period_s(judged_, load_);
    if (period_s <= 0) return none("rate", now, "none is high enough");
    return none("rate", now,
                fmt::format("above {}, which the device does not have",
                            schema::for_people(1 / period_s, Dimension::frequency)));
  }

  Remedy device_damping() const {
    const auto with = [&](double damping) {
      JudgedLoop loop = loop_;
      loop.axis.viscous_n_s_per_m = damping;
      return loop;
    };
    const double now = loop_.axis.viscous_n_s_per_m;
    const auto needed = first_above(std::max(now, 1e-3), 1e5,
                                    [&](double damping) { return with(damping).carries(judged_, load_); });
    if (!needed) return none("viscous friction of the device", amount_words(now, "N s/m"), "none suffices");
    return {"viscous friction of the device", amount_words(now, "N s/m"),
            "above " + amount_words(*needed, "N s/m"), limit_with(with(*needed), load_.damping_n_s_per_m)};
  }

  Remedy virtual_damping() const {
    const double now = load_.damping_n_s_per_m;
    const auto needed = first_above(std::max(now, 1e-3), 1e4, [&](double damping) {
      return loop_.carries(judged_, {load_.stiffness_n_per_m, damping});
    });
    if (!needed) return none("damper of the scene", amount_words(now, "N s/m"), "none suffices");
    return {"damper of the scene", amount_words(now, "N s/m"), "above " + amount_words(*needed, "N s/m"),
            limit_with(loop_, *needed)};
  }

  Remedy delay() const {
    const std::string now = schema::for_people(loop_.delay_s, Dimension::time);
    JudgedLoop loop = loop_;
    loop.delay_s = loop_.largest_delay_s(judged_, load_);
    if (loop.delay_s < 0) return none("delay", now, "not even without delay");
    return {"delay", now, "below " + schema::for_people(loop.delay_s, Dimension::time),
            limit_with(loop, load_.damping_n_s_per_m)};
  }

  Remedy encoder() const {
    const std::string now = schema::for_people(loop_.axis.encoder_step_m, Dimension::length);
    JudgedLoop loop = loop_;
    const double needed_m = last_good(loop_.axis.encoder_step_m, 1e-12, 1, [&](double step_m) {
      loop.axis.encoder_step_m = step_m;
      return loop.carries(judged_, load_);
    });
    if (needed_m <= 0) return none("encoder step", now, "none is fine enough");
    loop.axis.encoder_step_m = needed_m;
    return {"encoder step", now, "below " + schema::for_people(needed_m, Dimension::length),
            limit_with(loop, load_.damping_n_s_per_m)};
  }

  JudgedLoop loop_;
  VirtualLoad load_;
  const DesignRequest& request_;
  Holder judged_;
};

}  // namespace

std::vector<Remedy> remedies_for(const JudgedLayer& layer, const DesignRequest& request) {
  return LayerChanges(layer, request).all();
}

}  // namespace tacto::analysis
