#include "misfit/diagnose/features.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "misfit/core/lists.h"
#include "misfit/core/units.h"
#include "misfit/math/statistics.h"

namespace misfit {
namespace {

struct Range {
  double low = 0.0, high = 0.0;
};

Range visited_range(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t cut = values.size() / 200;
  return {values[cut], values[values.size() - 1 - cut]};
}

/// Weights of two neighbouring hats at a value, the end hats extended.
void add_hats(double value, const std::vector<double>& centre, Eigen::Index row, Eigen::MatrixXd& f) {
  const double step = centre[1] - centre[0];
  const double place = std::clamp((value - centre.front()) / step, 0.0, static_cast<double>(centre.size() - 1));
  const auto left = std::min(static_cast<Eigen::Index>(place), std::ssize(centre) - 2);
  const double share = place - static_cast<double>(left);
  f(row, left) += 1.0 - share;
  f(row, left + 1) += share;
}

constexpr double fewest_samples_of_hat = 25.0, seconds_of_a_day = 86400.0;

/// Drops hats that hardly any sample touches.
void drop_empty(Features& features) {
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < features.f.cols(); ++i) {
    if (features.f.col(i).sum() >= fewest_samples_of_hat) kept.push_back(i);
  }
  Eigen::MatrixXd f(features.f.rows(), kept.size()), ahead = f;
  std::vector<double> centre;
  for (std::size_t k = 0; k < kept.size(); ++k) {
    f.col(k) = features.f.col(kept[k]);
    ahead.col(k) = features.ahead.col(kept[k]);
    centre.push_back(features.centre[kept[k]]);
    features.count.push_back(features.f.col(kept[k]).sum());
  }
  features.f = std::move(f);
  features.ahead = std::move(ahead);
  features.centre = std::move(centre);
}

/// A quantity over the samples, and what it is one step ahead.
struct Course {
  std::string quantity, unit;
  int index = -1;  ///< Features::index
  std::vector<double> values = {}, ahead = {};
};

Features hats(const Course& course, const std::vector<bool>& used, int most) {
  const auto& [quantity, unit, index, values, ahead] = course;
  Features out;
  out.quantity = quantity;
  out.unit = unit;
  out.index = index;
  std::vector<double> visited;
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (used[k] && std::isfinite(values[k])) visited.push_back(values[k]);
  }
  if (visited.size() < 100) return out;
  const Range range = visited_range(visited);
  if (!(range.high - range.low > 1e-9 * std::max(std::abs(range.high), std::abs(range.low)))) return out;
  for (int i = 0; i < most; ++i) out.centre.push_back(range.low + (range.high - range.low) * i / (most - 1));
  out.f = out.ahead = Eigen::MatrixXd::Zero(values.size(), most);
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (!used[k] || !std::isfinite(values[k])) continue;
    add_hats(values[k], out.centre, k, out.f);
    add_hats(std::isfinite(ahead[k]) ? ahead[k] : values[k], out.centre, k, out.ahead);
  }
  drop_empty(out);
  return out;
}

/// One experiment's samples in the lists of all.
struct Samples {
  std::size_t first = 0, end = 0;
};

/// u − z of the quantity `course.index`: at each sample, and at the end of the step from it (quantities_ahead()). z begins at the first u
/// that is known and stands still where u is not.
void add_past(const ForceSensitivity& force, const Samples& samples, double intervals, Course& course) {
  const std::vector<double>& t = force.times();
  const double tau = intervals * usual_step({t.begin() + samples.first, t.begin() + samples.end});
  const auto u = [&](std::size_t k) { return force.used()[k] ? force.quantities()(k, course.index) : std::nan(""); };
  double z = std::nan("");
  for (std::size_t k = samples.first; k < samples.end; ++k) {
    if (!std::isfinite(z)) z = u(k);
    const std::size_t next = std::min(k + 1, samples.end - 1);
    course.values.push_back(u(k) - z);
    if (std::isfinite(u(k))) z += (1.0 - std::exp((t[k] - t[next]) / tau)) * (u(k) - z);
    course.ahead.push_back(force.used()[k] && next > k ? force.quantities_ahead()(k, course.index) - z : u(next) - z);
  }
}

/// Samples of the parts that are fitted: what is held out says nothing of the hours in which it lies.
std::vector<bool> not_held_out(const FilterEstimate& estimate, const ForceSensitivity& force) {
  std::vector<bool> out = force.used();
  std::size_t offset = 0;
  for (std::size_t e = 0; e < estimate.traces.size(); ++e) {
    const std::size_t samples = estimate.traces[e].samples;
    const std::vector<SampleRole>& use = estimate.data[e].use;
    const std::size_t channels = use.size() / std::max<std::size_t>(samples, 1);
    for (std::size_t k = 0; k < samples; ++k) {
      const auto first = use.begin() + static_cast<std::ptrdiff_t>(k * channels);
      if (std::find(first, first + channels, SampleRole::validation) != first + channels) out[offset + k] = false;
    }
    offset += samples;
  }
  return out;
}

/// Where enough hats are left to draw a curve.
void add_if_visited(Features features, std::vector<Features>& out) {
  if (features.centre.size() >= 3) out.push_back(std::move(features));
}

}  // namespace

bool may_be_forced(const SystemSpec& system, int port) {
  const PortSpec& spec = system.dynamic_ports[port];
  const int moved = index_of(system.states, spec.conjugate);
  const bool has_rate =
      moved >= 0 && std::any_of(system.states.begin(), system.states.end(), [&](const StateSpec& s) { return s.rate_of == moved; });
  const auto& forced = system.force_ports;
  return !has_rate || std::find(forced.begin(), forced.end(), spec.name) != forced.end();
}

bool lasts_days(const std::vector<double>& t) {
  constexpr double least = 3.0 * seconds_of_a_day;
  return !t.empty() && *std::max_element(t.begin(), t.end()) - *std::min_element(t.begin(), t.end()) >= least;
}

double hour_of_day(double t) {
  constexpr double hour = 3600.0;
  return (t - seconds_of_a_day * std::floor(t / seconds_of_a_day)) / hour;
}

std::string past_of(const std::string& quantity) { return "the past of " + quantity; }

std::vector<Features> features_of(const FilterEstimate& estimate, const ForceSensitivity& force, int most) {
  std::vector<Features> out;
  const auto& specs = estimate.model.system->spec().quantities;
  for (std::size_t q = 0; q < specs.size(); ++q) {
    if (!specs[q].explains) continue;
    Course course{specs[q].name, specs[q].unit, static_cast<int>(q)};
    for (std::size_t k = 0; k < force.used().size(); ++k) {
      course.values.push_back(force.quantities()(k, q));
      course.ahead.push_back(force.quantities_ahead()(k, q));
    }
    add_if_visited(hats(course, force.used(), most), out);
  }
  add_if_visited(hats({time_of_recording, "s", -1, force.times(), force.times()}, not_held_out(estimate, force), most), out);
  if (!lasts_days(force.times())) return out;
  constexpr int every_two_hours = 13;
  Course day{time_of_day, "h"};
  for (const double t : force.times()) day.values.push_back(hour_of_day(t));
  day.ahead = day.values;
  add_if_visited(hats(day, force.used(), std::max(most, every_two_hours)), out);
  return out;
}

std::vector<Features> features_of_pasts(const FilterEstimate& estimate, const ForceSensitivity& force, int most) {
  std::vector<Features> out;
  const SystemSpec& system = estimate.model.system->spec();
  for (std::size_t q = 0; q < system.quantities.size(); ++q) {
    const auto& spec = system.quantities[q];
    if (index_of(system.inputs, spec.name) < 0 || !spec.explains) continue;
    for (const double intervals : {2.0, 8.0, 32.0}) {
      Course course{past_of(spec.name), spec.unit, static_cast<int>(q)};
      std::size_t first = 0;
      for (const FilterTrace& trace : estimate.traces) {
        add_past(force, {first, first + trace.samples}, intervals, course);
        first += trace.samples;
      }
      add_if_visited(hats(course, force.used(), most), out);
    }
  }
  return out;
}

std::vector<Features> features_of_own_states(const FilterEstimate& estimate, const ForceSensitivity& force, const BoundEffect& effect,
                                             int most) {
  std::vector<Features> out;
  const Model& model = estimate.model;
  for (int i = effect.first_state; i < effect.first_state + int_size(effect.effect->spec().states); ++i) {
    const int state = model.system_states() + i;
    Course course{model.own_state_names[i], model.own_state_units[i], i};
    for (const FilterTrace& trace : estimate.traces) {
      for (std::size_t k = 0; k < trace.samples; ++k) course.values.push_back(trace.predicted_at(k)[state] + trace.correction_at(k)[state]);
    }
    course.ahead = course.values;
    const Eigen::VectorXd rates = force.own_rates().col(i);
    Course rate{"d(" + course.quantity + ")/dt", rate_unit(course.unit), i, {rates.begin(), rates.end()}, {rates.begin(), rates.end()}};
    add_if_visited(hats(course, force.used(), most), out);
    add_if_visited(hats(rate, force.used(), most), out);
  }
  return out;
}

Features products_of(const Features& a, const Features& b) {
  Features out;
  out.quantity = a.quantity;
  out.index = a.index;
  std::vector<std::pair<Eigen::Index, Eigen::Index>> kept;
  for (Eigen::Index i = 0; i < a.f.cols(); ++i) {
    for (Eigen::Index j = 0; j < b.f.cols(); ++j) {
      const double samples = a.f.col(i).dot(b.f.col(j));
      if (samples < fewest_samples_of_hat) continue;
      kept.emplace_back(i, j);
      out.count.push_back(samples);
    }
  }
  out.f = out.ahead = Eigen::MatrixXd(a.f.rows(), kept.size());
  for (Eigen::Index k = 0; k < out.f.cols(); ++k) {
    const auto [i, j] = kept[k];
    out.f.col(k) = a.f.col(i).cwiseProduct(b.f.col(j));
    out.ahead.col(k) = a.ahead.col(i).cwiseProduct(b.ahead.col(j));
  }
  return out;
}

}  // namespace misfit
