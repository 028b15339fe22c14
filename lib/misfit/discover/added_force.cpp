#include "misfit/discover/added_force.h"

#include <algorithm>

#include "misfit/math/decompositions.h"

namespace misfit {
namespace {

/// One model twice: as it is, and with some strengths at 0 (or as near as their bounds let them).
class WithAndWithout {
 public:
  WithAndWithout(const FilterModel& forced, const std::vector<int>& strengths)
      : forced_(forced),
        with_(forced.model),
        without_(forced.model),
        states_(forced.model.system->spec().states.size()),
        dx_(with_.states()),
        dx_without_(with_.states()),
        D_(with_.states(), kRowStride) {
    std::vector<double> values = forced.model.values();
    with_.set_parameters(values.data());
    for (int s : strengths) {
      const Parameter& p = forced.model.parameters[s];
      values[s] = std::clamp(0.0, p.lower, p.upper);
    }
    without_.set_parameters(values.data());
  }

  /// Per force port of the filter.
  Eigen::VectorXd difference(const Instant& at) {
    slots_.clear();
    with_.linearise_rates(at, slots_, dx_.data(), D_.data());
    without_.rates(at.x, at.u, at.t, dx_without_.data());
    Eigen::MatrixXd by_force(states_, std::ssize(forced_.force_states));
    for (Eigen::Index p = 0; p < by_force.cols(); ++p) by_force.col(p) = D_.col(forced_.force_states[p]).head(states_);
    return least_squares(by_force, (dx_ - dx_without_).head(states_));
  }

 private:
  const FilterModel& forced_;
  Evaluator with_, without_;
  Eigen::Index states_;  ///< of the system, which come first
  Eigen::VectorXd dx_, dx_without_;
  RowMatrix D_;
  Slots slots_;
};

AddedForce at_samples(const FilterModel& forced, const FilterData& data, const RowMatrix& smoothed, WithAndWithout& models) {
  AddedForce out;
  out.experiment = data.signals->name;
  for (int port : forced.force_ports) {
    const PortSpec& spec = forced.model.system->spec().dynamic_ports[port];
    out.ports.push_back(spec.name);
    out.port_units.push_back(spec.unit);
  }
  out.force.resize(out.ports.size());
  for (std::size_t k = data.first; k < static_cast<std::size_t>(smoothed.rows()); ++k) {
    const double t = data.signals->t[k];
    const Eigen::VectorXd force = models.difference({smoothed.row(static_cast<Eigen::Index>(k)).data(), data.inputs.at(k), t});
    out.t.push_back(t);
    for (std::size_t p = 0; p < out.force.size(); ++p) out.force[p].push_back(force[p]);
  }
  return out;
}

bool is_zero(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return v == 0.0; });
}

/// Ports on which it adds nothing at any time are left out.
void remove_idle_ports(AddedForce& added) {
  for (std::size_t p = added.ports.size(); p-- > 0;) {
    if (!is_zero(added.force[p])) continue;
    const auto at = static_cast<std::ptrdiff_t>(p);
    added.ports.erase(added.ports.begin() + at);
    added.port_units.erase(added.port_units.begin() + at);
    added.force.erase(added.force.begin() + at);
  }
}

}  // namespace

std::vector<AddedForce> added_force_of(const FilterEstimate& estimate, const std::vector<int>& strengths) {
  std::vector<AddedForce> out;
  const FilterModel& forced = estimate.forced;
  FilterRunner runner(forced, false);
  runner.set_parameters(forced.model.values());
  WithAndWithout models(forced, strengths);
  for (const FilterData& data : estimate.data) {
    FilterTrace trace;
    if (!runner.run(data, estimate.noise, trace, {.keep_P = true})) continue;
    AddedForce added = at_samples(forced, data, smooth_states(trace, data, estimate.noise).x, models);
    remove_idle_ports(added);
    if (!added.ports.empty()) out.push_back(std::move(added));
  }
  return out;
}

std::map<std::string, Estimate> random_force(const FilterEstimate& estimate) {
  std::map<std::string, Estimate> out;
  for (std::size_t i = 0; i < estimate.forced.force_ports.size(); ++i) {
    const PortSpec& spec = estimate.model.system->spec().dynamic_ports[estimate.forced.force_ports[i]];
    out[spec.name] = {estimate.noise.force_of(estimate.forced.force_group[i]), 0.0, spec.unit};
  }
  return out;
}

}  // namespace misfit
