#include "misfit/diagnose/diagnose.h"

#include <algorithm>
#include <cmath>

#include "misfit/core/display.h"
#include "misfit/core/duration.h"
#include "misfit/core/lists.h"
#include "misfit/core/stopwatch.h"
#include "misfit/core/text.h"
#include "misfit/core/units.h"
#include "misfit/data/estimators.h"
#include "misfit/diagnose/distinct_ports.h"
#include "misfit/diagnose/features.h"
#include "misfit/diagnose/innovations.h"
#include "misfit/diagnose/pulses.h"
#include "misfit/jobs/work_queue.h"
#include "misfit/math/statistics.h"

namespace misfit {
namespace {

constexpr double significant = 0.01;  // corrected for all maps
constexpr double described = 0.01;    // 1 − R², as of an absorbed candidate: amplitudes are not of what the model has already

/// To a tenth of the first digit of `width`.
std::string place(double value, double width, const std::string& unit) {
  const double shown = display_value(width, unit);
  const double step = shown > 0.0 ? std::pow(10.0, std::floor(std::log10(shown)) - 1.0) : 1e-3;
  return with_level_unit(format_to_step(display_level(value, unit), step), unit);
}

/// A force that is the same at all hours is none that depends on the hour: what is said is beside the median.
ForceMap beside_other_hours(ForceMap map) {
  std::vector<double> known;
  for (std::size_t i = 0; i < map.x.size(); ++i) {
    if (map.sigma[i] > 0.0) known.push_back(map.amplitude[i]);
  }
  const double usual = known.empty() ? 0.0 : median(known);
  for (double& amplitude : map.amplitude) amplitude -= usual;
  return map;
}

/// Of neighbouring hats: mean by their own sigmas, and its variance with what they have in common.
struct RunMean {
  double value = 0.0, variance = 0.0;
  [[nodiscard]] double chi2() const { return variance > 0.0 ? value * value / variance : 0.0; }
};

RunMean mean_of(const ForceMap& map, const Eigen::MatrixXd& covariance, std::size_t from, std::size_t to) {
  const auto first = static_cast<Eigen::Index>(from), count = static_cast<Eigen::Index>(to - from + 1);
  const Eigen::VectorXd weights = Eigen::Map<const Eigen::VectorXd>(map.sigma.data() + first, count).array().square().inverse();
  const Eigen::VectorXd w = weights / weights.sum();
  return {w.dot(Eigen::Map<const Eigen::VectorXd>(map.amplitude.data() + first, count)),
          w.dot(covariance.block(first, first, count, count) * w)};
}

double half_step(const ForceMap& map) { return map.x.size() > 1 ? 0.5 * (map.x[1] - map.x[0]) : 0.0; }

/// Of the range of a hat; nothing was recorded beyond the first and the last time.
double lower_edge(const ForceMap& map, std::size_t hat) {
  if (map.quantity == time_of_recording && hat == 0) return map.x[hat];
  const double edge = map.x[hat] - half_step(map);
  return map.quantity == time_of_day ? std::max(edge, 0.0) : edge;  // hats at both ends go past midnight
}
double upper_edge(const ForceMap& map, std::size_t hat) {
  if (map.quantity == time_of_recording && hat + 1 == map.x.size()) return map.x[hat];
  constexpr double day = 24.0;  // [h], as features.cpp has it
  const double edge = map.x[hat] + half_step(map);
  return map.quantity == time_of_day ? std::min(edge, day) : edge;
}

}  // namespace

std::string where_it_fails(const ForceMap& map, const Eigen::MatrixXd& covariance) {
  std::size_t best_from = 0, best_to = 0;
  RunMean best;
  for (std::size_t from = 0; from < map.x.size(); ++from) {
    for (std::size_t to = from; to < map.x.size() && map.sigma[to] > 0.0 && map.amplitude[to] * map.amplitude[from] > 0.0; ++to) {
      if (std::abs(map.amplitude[to]) < 1.5 * map.sigma[to]) break;
      const RunMean mean = mean_of(map, covariance, from, to);
      if (mean.chi2() <= best.chi2()) continue;
      best = mean;
      best_from = from;
      best_to = to;
    }
  }
  std::string otherwise = "as a whole, the model's " + map.port + " depends otherwise on " + map.quantity +
                          " than the data say, though no range of it stands out by itself";
  if (!(best.chi2() > 0.0)) return otherwise;
  const std::string amount = in_display_unit(std::abs(best.value), map.port_unit, std::sqrt(best.variance)) +
                             (best.value < 0.0 ? " too high" : " too low") + " where " + map.quantity + " is between " +
                             place(lower_edge(map, best_from), half_step(map), map.quantity_unit) + " and " +
                             place(upper_edge(map, best_to), half_step(map), map.quantity_unit);
  constexpr double least_chi2 = 9.0;  // three sigmas
  return best.chi2() < least_chi2 ? otherwise + " (most: " + amount + ")" : "the model's " + map.port + " is " + amount;
}

namespace {

/// What missing forces are sought with: score test of the estimate, sensitivity to a force, and the quantities over which it may vary.
struct Search {
  const SystemSpec& spec;
  const ScoreTest& score;
  const ForceSensitivity& force;
  const std::vector<Features>& features;
  const std::vector<int>& ports;  ///< distinct_ports()
};

/// A map and the covariance of its amplitudes.
struct SolvedMap {
  ForceMap map;
  Eigen::MatrixXd covariance;
};

SolvedMap map_of(const Search& search, const Features& features, int port) {
  const SystemSpec& spec = search.spec;
  ForceMap map;
  map.port = spec.dynamic_ports[port].name;
  map.port_unit = spec.dynamic_ports[port].unit;
  map.quantity = features.quantity;
  map.quantity_unit = features.unit;
  map.x = features.centre;
  map.count = features.count;
  ScoreResult result = search.score.test(search.force.columns(port, features.f, features.ahead), nullptr, described);
  map.amplitude.assign(result.amplitude.data(), result.amplitude.data() + result.amplitude.size());
  map.sigma.assign(result.sigma.data(), result.sigma.data() + result.sigma.size());
  map.chi2 = result.chi2;
  map.dof = result.dof;
  map.p_value = result.dof > 0 ? chi_square_tail(result.chi2, result.dof) : 1.0;
  return {std::move(map), std::move(result.covariance)};
}

/// A port where no force acts shows errors of sensors, and a force elsewhere in what it does within a sample: where one shows more clearly,
/// that is as likely. `maps`: the most significant first.
void say_where_no_force_acts(const SystemSpec& spec, std::vector<ForceMap>& maps) {
  bool force_before = false;
  for (ForceMap& map : maps) {
    const bool forced = may_be_forced(spec, index_of(spec.dynamic_ports, map.port));
    force_before = force_before || (forced && !map.sentence.empty());
    if (forced || map.sentence.empty()) continue;
    map.sentence += force_before ? "; no force acts there: it may be the trace of what is missing elsewhere"
                                 : "; no force acts there: it may be an error of a sensor";
  }
}

std::vector<ForceMap> all_maps(const Search& search, const DiagnoseOptions& options) {
  const std::size_t ports = search.ports.size();
  std::vector<SolvedMap> solved(ports * search.features.size());
  run_jobs(
      solved.size(), options.threads,
      [&](std::size_t k) { solved[k] = map_of(search, search.features[k / ports], search.ports[k % ports]); }, options.progress);
  std::vector<ForceMap> maps;
  for (auto& [map, covariance] : solved) {
    map.p_corrected = sidak(map.p_value, static_cast<double>(solved.size()));
    if (map.p_corrected < significant)
      map.sentence = where_it_fails(map.quantity == time_of_day ? beside_other_hours(map) : map, covariance);
    maps.push_back(std::move(map));
  }
  std::stable_sort(maps.begin(), maps.end(), [](const ForceMap& a, const ForceMap& b) { return a.p_value < b.p_value; });
  say_where_no_force_acts(search.spec, maps);
  return maps;
}

/// Cells of the two quantities whose maps are most significant.
std::vector<PairMap> pair_maps(const Search& search, const std::vector<ForceMap>& maps) {
  const auto& [spec, score, force, features, ports] = search;
  std::vector<PairMap> out;
  if (maps.empty() || features.size() < 2) return out;
  const ForceMap& first = maps.front();
  const auto second = std::find_if(maps.begin(), maps.end(), [&](const ForceMap& m) { return m.quantity != first.quantity; });
  if (second == maps.end()) return out;
  const auto find = [&](const std::string& name) {
    return std::find_if(features.begin(), features.end(), [&](const Features& f) { return f.quantity == name; });
  };
  const Features &a = *find(first.quantity), &b = *find(second->quantity);
  PairMap map{first.port, first.port_unit, a.quantity, a.unit, b.quantity, b.unit, a.centre, b.centre, {}, {}, 0.0, 0, 1.0, 1.0};
  Eigen::MatrixXd cells(a.f.rows(), a.f.cols() * b.f.cols()), ahead = cells;
  std::vector<bool> enough;
  for (Eigen::Index i = 0; i < a.f.cols(); ++i) {
    for (Eigen::Index j = 0; j < b.f.cols(); ++j) {
      auto column = cells.col(i * b.f.cols() + j);
      column = a.f.col(i).cwiseProduct(b.f.col(j));
      auto next = ahead.col(i * b.f.cols() + j);
      next = a.ahead.col(i).cwiseProduct(b.ahead.col(j));
      constexpr double fewest_samples_of_cell = 20.0;
      enough.push_back(column.sum() >= fewest_samples_of_cell);
      if (enough.back()) continue;
      column.setZero();
      next.setZero();
    }
  }
  const int port = index_of(spec.dynamic_ports, first.port);
  const ScoreResult result = score.test(force.columns(port, cells, ahead), nullptr, described);
  for (Eigen::Index c = 0; c < cells.cols(); ++c) {
    const bool known = enough[c] && result.sigma[c] > 0.0;
    map.amplitude.push_back(known ? result.amplitude[c] : std::nan(""));
    map.sigma.push_back(known ? result.sigma[c] : std::nan(""));
  }
  map.chi2 = result.chi2;
  map.dof = result.dof;
  map.p_value = result.dof > 0 ? chi_square_tail(result.chi2, result.dof) : 1.0;
  const auto quantities = static_cast<double>(features.size());
  map.p_corrected = sidak(map.p_value, static_cast<double>(ports.size()) * quantities * (quantities - 1.0) / 2.0);
  out.push_back(std::move(map));
  return out;
}

/// A map over anything but the time of the recording says where the model fails, beyond doubt: pulses come there, if there are any. (Where
/// they happen to come a few times, as at the heights to which they lift a state, they show in a map, too.)
bool depends_on_a_quantity(const std::vector<ForceMap>& maps) {
  constexpr double beyond_doubt = 1e-6;
  return std::any_of(maps.begin(), maps.end(), [](const ForceMap& map) {
    return !map.sentence.empty() && map.quantity != time_of_recording && map.p_corrected < beyond_doubt;
  });
}

void conclude(Diagnosis& out) {
  int said = 0;
  if (out.pulses) {
    for (const ForcePulses& pulses : *out.pulses) out.sentences.push_back(pulses.sentence);
  }
  std::vector<std::string> quantities;
  for (const auto& map : out.maps) {
    const bool repeated = std::find(quantities.begin(), quantities.end(), map.port + map.quantity) != quantities.end();
    if (map.sentence.empty() || said >= 3 || repeated) continue;
    quantities.push_back(map.port + map.quantity);
    out.sentences.push_back(map.sentence + "; the map of " + map.port + " over " + map.quantity + " as a whole differs from zero with " +
                            p_equals(map.p_corrected));
    ++said;
  }
  if (said == 0) {
    const std::string best = out.maps.empty() ? ""
                                              : ": the most significant map over one quantity, " + out.maps.front().port + " over " +
                                                    out.maps.front().quantity + ", has " + p_equals(out.maps.front().p_corrected);
    out.sentences.push_back("no map of the missing force of this model differs significantly from zero" + best);
  }
  const auto time = std::find_if(out.maps.begin(), out.maps.end(), [](const ForceMap& map) { return map.quantity == "time"; });
  if (said > 0 && time != out.maps.end() && time->p_corrected > significant)
    out.sentences.push_back("no dependence on time is found: the map over time has " + p_equals(time->p_corrected));
  for (const auto& report : out.whiteness) {
    const double count = 3.0 * static_cast<double>(out.whiteness.size());
    if (sidak(report.peak_p, count) < significant) {
      out.sentences.push_back("the innovations of " + report.channel + " have a spectral line at " + format_value(report.peak_frequency) +
                              " Hz, a period of " + duration_in_words(1.0 / report.peak_frequency) + " (" +
                              format_value(report.peak_power) + " times the power of white noise)");
    }
    if (sidak(std::min(report.ljung_box_p, report.periodogram_p), count) < significant) {
      out.sentences.push_back("the innovations of " + report.channel + " are not white: Ljung-Box " + p_equals(report.ljung_box_p) +
                              ", cumulative periodogram " + p_equals(report.periodogram_p));
    }
  }
}

}  // namespace

Diagnosis diagnose(const FilterEstimate& estimate, const DiagnoseOptions& options) {
  const Stopwatch clock;
  Diagnosis out;
  out.method = random_force_estimator().name;
  const ScoreTest score(estimate);
  const ForceSensitivity force(estimate);
  const std::vector<Features> features = features_of(estimate, force);
  const std::vector<int> ports = distinct_ports(estimate.model.system->spec(), force);
  const Search search{estimate.model.system->spec(), score, force, features, ports};
  out.whiteness = whiteness_of(estimate);
  out.maps = all_maps(search, options);
  out.pairs = pair_maps(search, out.maps);
  out.nis = nis_of(estimate);
  out.missing = missing_force_of(estimate);
  std::vector<ForcePulses> pulses = depends_on_a_quantity(out.maps) ? std::vector<ForcePulses>{} : pulses_of(out.missing);
  if (!pulses.empty()) out.pulses = std::move(pulses);
  conclude(out);
  out.seconds = clock.seconds();
  return out;
}

}  // namespace misfit
