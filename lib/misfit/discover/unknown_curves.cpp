#include "misfit/discover/unknown_curves.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <tuple>
#include <utility>

#include "misfit/core/lists.h"
#include "misfit/diagnose/distinct_ports.h"
#include "misfit/discover/bindings.h"
#include "misfit/jobs/work_queue.h"
#include "misfit/math/statistics.h"

namespace misfit {

std::vector<int> ports_of_unknown_curves(const SystemSpec& system) {
  std::vector<int> out;
  for (int p = 0; p < int_size(system.dynamic_ports); ++p) {
    if (may_be_forced(system, p)) out.push_back(p);
  }
  return out;
}

ForceSensitivity sensitivity_of_forces_and_parameters(const FilterEstimate& estimate) {
  const SystemSpec& system = estimate.model.system->spec();
  std::vector<int> parameters;
  for (const std::string& name : ports_of_parameters(system, true)) parameters.push_back(index_of(system.quantity_ports, name));
  return ForceSensitivity(estimate, std::move(parameters));
}

std::vector<int> parameters_of_unknown_curves(const Model& model) {
  if (Evaluator(model).shifts_time()) return {};
  const SystemSpec& system = model.system->spec();
  const std::vector<int> free = model.free_parameters();
  std::vector<int> out;
  for (const std::string& name : ports_of_parameters(system, true)) {
    if (place_of(free, index_of(model.parameters, name)) >= 0) out.push_back(index_of(system.quantity_ports, name));
  }
  return out;
}

std::string UnknownCurve::label() const {
  if (!memory.empty()) return memory;
  if (kind == PortKind::sensor) return in_words();
  return other.empty() ? "an unknown curve " + port + "(" + quantity + ")"
                       : "an unknown surface " + port + "(" + quantity + ", " + other + ")";
}

std::string UnknownCurve::in_words() const {
  return unexplained_place(port, kind == PortKind::sensor, kind == PortKind::quantity) + " that depends on " + quantities();
}

std::string UnknownCurve::quantities() const { return other.empty() ? quantity : quantity + " and " + other; }

namespace {

/// Score test of a force, or an error of an output, that is a sum of these functions of a quantity; `columns`: what each adds to the
/// residuals.
UnknownCurve unknown_form(const ScoreWork& work, const std::string& port, const Features& f, const Eigen::MatrixXd& columns) {
  UnknownCurve out;
  out.port = port;
  out.quantity = f.quantity;
  out.quantity_index = f.index;
  out.result = work.score.test(columns);
  if (out.result.dof == 0) return out;
  out.log_p = log_chi_square_tail(out.result.chi2, out.result.dof);
  out.p_value = std::exp(out.log_p);
  return out;
}

/// A place where curves of unknown form are looked for.
struct UnknownPlace {
  PortKind kind;
  int index;  ///< of the dynamic port, the parameter of ScoreWork::force, the output
};

std::vector<UnknownPlace> places_of_unknown_curves(const ScoreWork& work) {
  const SystemSpec& system = work.estimate.model.system->spec();
  std::vector<UnknownPlace> out;
  const std::vector<int> sought = sought_at(system, work.force);
  for (const int port : ports_of_unknown_curves(system)) {
    if (sought[port] == port || !may_be_forced(system, sought[port])) out.push_back({PortKind::dynamic, port});
  }
  for (const int port : parameters_of_unknown_curves(work.estimate.model)) {
    if (const int i = place_of(work.force.parameters(), port); i >= 0) out.push_back({PortKind::quantity, i});
  }
  if (work.calibrated) return out;
  for (int o = 0; o < int_size(system.outputs); ++o) out.push_back({PortKind::sensor, o});
  return out;
}

const std::string& name_of(const UnknownPlace& place, const ScoreWork& work) {
  const SystemSpec& system = work.estimate.model.system->spec();
  if (place.kind == PortKind::dynamic) return system.dynamic_ports[place.index].name;
  return place.kind == PortKind::sensor ? system.outputs[place.index].name
                                        : system.quantity_ports[work.force.parameters()[place.index]].name;
}

bool is_tested(const UnknownPlace& place, const std::string& quantity, const ScoreWork& work) {
  if (place.kind != PortKind::quantity) return true;
  return is_more_than_a_force(work.estimate.model.system->spec().quantity_ports[work.force.parameters()[place.index]], quantity);
}

UnknownCurve unknown_curve_at(const ScoreWork& work, const UnknownPlace& place, const Features& f) {
  UnknownCurve out = unknown_form(work, name_of(place, work), f, work.force.columns_at(place.kind, place.index, f.f, f.ahead));
  out.kind = place.kind;
  out.index = place.index;
  out.centre = f.centre;
  return out;
}

/// Of the own state of an effect to which the features belong.
UnknownCurve unknown_own_rate(const ScoreWork& work, const BoundEffect& effect, const Features& f) {
  const Model& model = work.estimate.model;
  const std::vector<std::string> ports = names_of_ports(model.system->spec(), effect);
  UnknownCurve out = unknown_form(work, ports.empty() ? effect.name : ports.front(), f, work.force.own_rate_columns(f.index, f.f));
  out.kind = effect.kind;
  out.memory = "another dependence of d(" + model.own_state_names[f.index] + ")/dt on " + f.quantity;
  out.quantity = past_read_by(model.system->spec(), effect);
  return out;
}

/// A family of functions of a quantity, to be tested at a place.
struct UnknownTest {
  const Features* features;
  UnknownPlace place;
};

/// What they are functions of, and where each is tested: a parameter for what it depends on now, all others for pasts, too.
struct UnknownTests {
  std::vector<Features> features, pasts;
  std::vector<UnknownTest> tests;
};

UnknownTests tests_of_unknown_curves(const ScoreWork& work) {
  UnknownTests out{.features = features_of(work.estimate, work.force, hats_of_unknown_curves),
                   .pasts = features_of_pasts(work.estimate, work.force, hats_of_unknown_curves),
                   .tests = {}};
  const std::vector<UnknownPlace> places = places_of_unknown_curves(work);
  for (const Features& f : out.features) {
    for (const UnknownPlace& place : places) {
      if (is_tested(place, f.quantity, work)) out.tests.push_back({&f, place});
    }
  }
  for (const Features& f : out.pasts) {
    for (const UnknownPlace& place : places) {
      if (place.kind != PortKind::quantity) out.tests.push_back({&f, place});
    }
  }
  return out;
}

/// The best of those of one quantity (features of its past) at one place, corrected for their number. In the order of the list.
std::vector<UnknownCurve> best_of_each(const std::vector<UnknownCurve>& all) {
  std::vector<UnknownCurve> out;
  std::vector<double> count;
  for (const UnknownCurve& curve : all) {
    const auto same = std::find_if(out.begin(), out.end(), [&](const UnknownCurve& c) { return is_of_the_same(c, curve); });
    if (same == out.end()) {
      out.push_back(curve);
      count.push_back(1.0);
    } else {
      if (curve.log_p < same->log_p) *same = curve;
      ++count[same - out.begin()];
    }
  }
  for (std::size_t k = 0; k < out.size(); ++k) {
    out[k].p_value = sidak(out[k].p_value, count[k]);
    out[k].log_p += std::log(count[k]);
  }
  return out;
}

std::vector<UnknownCurve> curves_of(const ScoreWork& work, const std::vector<UnknownTest>& tests, const ProgressFn& progress = {}) {
  std::vector<UnknownCurve> out(tests.size());
  run_jobs(
      out.size(), work.threads, [&](std::size_t k) { out[k] = unknown_curve_at(work, tests[k].place, *tests[k].features); }, progress);
  return out;
}

}  // namespace

bool is_of_the_same(const UnknownCurve& a, const UnknownCurve& b) {
  return a.kind == b.kind && a.port == b.port && a.quantity == b.quantity;
}

std::string past_read_by(const SystemSpec& system, const BoundEffect& effect) {
  const int q = effect.quantities.empty() ? -1 : effect.quantities.front();
  if (q < 0) return past_of(effect.name);
  return past_of(q < int_size(system.quantities) ? system.quantities[q].name : system.outputs[q - int_size(system.quantities)].name);
}

std::size_t count_of_unknown_curves(const ScoreWork& work) {
  std::set<std::tuple<std::string, PortKind, int>> known;
  const UnknownTests tests = tests_of_unknown_curves(work);
  for (const auto& [features, place] : tests.tests) known.emplace(features->quantity, place.kind, place.index);
  return known.size();
}

std::vector<UnknownCurve> unknown_curves(const ScoreWork& work, const ProgressFn& progress) {
  const UnknownTests tests = tests_of_unknown_curves(work);
  return best_of_each(curves_of(work, tests.tests, progress));
}

std::vector<UnknownCurve> narrow_curves(const ScoreWork& work) {
  constexpr std::array narrow = {24, 72};
  std::vector<UnknownPlace> places = places_of_unknown_curves(work);
  std::erase_if(places, [](const UnknownPlace& place) { return place.kind == PortKind::quantity; });
  std::vector<UnknownCurve> all;
  for (const int hats : narrow) {
    const std::vector<Features> features = features_of(work.estimate, work.force, hats);
    std::vector<UnknownTest> tests;
    for (const Features& f : features) {
      for (const UnknownPlace& place : places) {
        if (f.index != kTime) tests.push_back({&f, place});
      }
    }
    for (UnknownCurve& curve : curves_of(work, tests)) {
      curve.hats = hats;
      all.push_back(std::move(curve));
    }
  }
  return best_of_each(all);
}

bool is_clearly_better(const UnknownCurve& narrow, const UnknownCurve& usual) { return narrow.order() < usual.order() - 0.5 * tied_drops; }

std::vector<UnknownCurve> with_narrow_ones(std::vector<UnknownCurve> usual, std::vector<UnknownCurve> narrow) {
  for (UnknownCurve& curve : narrow) {
    const auto same = std::find_if(usual.begin(), usual.end(), [&](const UnknownCurve& c) { return is_of_the_same(c, curve); });
    if (same != usual.end() && is_clearly_better(curve, *same)) *same = std::move(curve);
  }
  return usual;
}

std::vector<UnknownCurve> curves_alike(const UnknownCurve& curve, const std::vector<UnknownCurve>& all, const ScoreWork& work,
                                       double p_accept) {
  const std::vector<Features> features = features_of(work.estimate, work.force, curve.hats);
  const auto columns = [&](const UnknownCurve& c) {
    const auto of = std::find_if(features.begin(), features.end(), [&](const Features& f) { return f.quantity == c.quantity; });
    return of == features.end() ? Eigen::MatrixXd() : work.force.columns_at(c.kind, c.index, of->f, of->ahead);
  };
  const auto adds_nothing = [&](const ScoreResult& both, const ScoreResult& one) {
    return both.dof <= one.dof || !(chi_square_tail(both.chi2 - one.chi2, both.dof - one.dof) < p_accept);
  };
  const Eigen::MatrixXd own = columns(curve);
  std::vector<UnknownCurve> out;
  for (const UnknownCurve& other : all) {
    const bool same = other.kind == curve.kind && other.index == curve.index && other.quantity == curve.quantity;
    if (own.size() == 0 || same || other.result.dof == 0 || other.hats != curve.hats ||
        std::abs(other.log_p - curve.log_p) > 0.5 * tied_drops)
      continue;
    const Eigen::MatrixXd others = columns(other);
    if (others.size() == 0) continue;
    Eigen::MatrixXd joint(own.rows(), own.cols() + others.cols());
    joint << own, others;
    const ScoreResult both = work.score.test(joint);
    if (adds_nothing(both, curve.result) && adds_nothing(both, other.result)) out.push_back(other);
  }
  return out;
}

std::vector<UnknownCurve> unknown_own_rates(const ScoreWork& work, int effects) {
  const std::vector<BoundEffect>& all = work.estimate.model.effects;
  std::vector<std::pair<const BoundEffect*, Features>> tests;
  for (std::size_t e = all.size() - std::min<std::size_t>(effects, all.size()); e < all.size(); ++e) {
    for (Features& f : features_of_own_states(work.estimate, work.force, all[e], hats_of_unknown_curves))
      tests.emplace_back(&all[e], std::move(f));
  }
  std::vector<UnknownCurve> out(tests.size());
  run_jobs(out.size(), work.threads, [&](std::size_t k) { out[k] = unknown_own_rate(work, *tests[k].first, tests[k].second); });
  return out;
}

std::vector<UnknownCurve> unknown_surfaces(const ScoreWork& work, const std::vector<int>& read) {
  constexpr int hats = 4;
  const std::vector<Features> features = features_of(work.estimate, work.force, hats);
  const auto is_read = [&](const Features& f) { return place_of(read, f.index) >= 0; };
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t a = 0; a < features.size(); ++a) {
    for (std::size_t b = a + 1; b < features.size(); ++b) {
      if (is_read(features[a]) || is_read(features[b])) pairs.emplace_back(a, b);
    }
  }
  const std::vector<int> ports = ports_of_unknown_curves(work.estimate.model.system->spec());
  std::vector<UnknownCurve> out(pairs.size() * ports.size());
  run_jobs(out.size(), work.threads, [&](std::size_t k) {
    const auto [a, b] = pairs[k / ports.size()];
    out[k] = unknown_curve_at(work, {PortKind::dynamic, ports[k % ports.size()]}, products_of(features[a], features[b]));
    out[k].other = features[b].quantity;
  });
  return out;
}

}  // namespace misfit
