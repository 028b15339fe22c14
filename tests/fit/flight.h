#pragma once

// Short flights of the spherical parachute in gusts, simulated with fixed seeds, and the model that fits them.

#include <cmath>
#include <random>

#include "misfit/fit/filter/filter_estimate.h"
#include "misfit/inference/curves.h"
#include "misfit/sim/random_run.h"
#include "tests/model/requests.h"

namespace misfit::testing_flight {

using namespace testing_models;

/// Static moment, damping and gravity in gusts of 27 N m and 0.1 s, with apex jitter of 1 px at 9 Hz and 0.5 px of white noise at 59.94 Hz,
/// and what `hidden` adds with its `values`.
inline Signals fly(double seconds, unsigned seed, const std::vector<EffectRequest>& hidden = {},
                   const std::map<std::string, double>& values = {}) {
  std::vector<EffectRequest> more = {effect("gust"), effect("apex_jitter")};
  more.insert(more.end(), hidden.begin(), hidden.end());
  Model truth = assemble(spherical(more), registry());
  set_parachute_curves(truth);
  std::map<std::string, double> all = {
      {"gust_sigma", 27.0}, {"gust_tau", 0.1}, {"jitter", 1.0}, {"jitter_frequency", 9.0}, {"jitter_damping", 0.1}};
  for (const auto& [name, value] : values) all[name] = value;
  for (const auto& [name, value] : all) set(truth, name, value);
  constexpr double rate = 59.94;
  Signals s;
  s.name = "flight";
  const int before = 180, samples = static_cast<int>(seconds * rate);
  for (int i = -before; i < samples; ++i) s.t.push_back(i / rate);
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::vector<double> x(static_cast<std::size_t>(truth.states()), 0.0);
  x[0] = 0.1;
  x[1] = 0.15;
  Stepper stepper(truth);
  Segment run;
  run_randomly({stepper, s, input_table(s, truth)}, x.data(), random, run);
  s.t.erase(s.t.begin(), s.t.begin() + before);
  for (Eigen::Index o = 0; o < 2; ++o) {
    Signal channel;
    channel.name = o == 0 ? "P_y" : "P_z";
    channel.unit = "px";
    for (int i = 0; i < samples; ++i) channel.values.push_back(run.y(before + i, o) + 0.5 * normal(random));
    s.measured.push_back(std::move(channel));
  }
  return s;
}

/// What does not know of `hidden`: curves with few knots from the data.
inline ModelRequest request_for(const std::vector<Signals>& flights) {
  ModelRequest r = spherical();
  r.curves.clear();
  choose_all_knots(r, registry(), flights, 6);
  return r;
}

inline FilterEstimate fitted(const ModelRequest& request, const std::vector<Signals>& flights) {
  const Model model = assemble(request, registry());
  return estimate_filter(model, curve_penalties(model), flights);
}

}  // namespace misfit::testing_flight
