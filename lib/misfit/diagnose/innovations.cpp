#include "misfit/diagnose/innovations.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "misfit/diagnose/features.h"
#include "misfit/inference/states.h"
#include "misfit/math/statistics.h"
#include "misfit/math/whiteness.h"

namespace misfit {
namespace {

constexpr double pi = std::numbers::pi;

/// Standardised innovations of one channel that count.
struct StandardisedSeries {
  std::vector<double> t, w;
};

StandardisedSeries standardised(const FilterTrace& trace, const FilterData& data, std::size_t channel) {
  const std::size_t ny = trace.ny;
  StandardisedSeries out;
  for (std::size_t k = 0; k < trace.samples; ++k) {
    const std::size_t at = k * ny + channel;
    if (data.use[at] != SampleRole::counted) continue;
    out.t.push_back(data.signals->t[k]);
    out.w.push_back(trace.e[at] / std::sqrt(trace.S[at]));
  }
  return out;
}

struct Periodogram {
  std::vector<double> frequency, power;
};

/// Power of white noise is 1 on average. Goertzel-free: direct sums by rotation, exact enough for the few thousand samples of a recording.
Periodogram periodogram(const std::vector<double>& w, double step) {
  Periodogram out;
  const std::size_t n = w.size(), half = (n - 1) / 2;
  for (std::size_t j = 1; j <= half; ++j) {
    const double angle = 2.0 * pi * static_cast<double>(j) / static_cast<double>(n);
    const double c = std::cos(angle), s = std::sin(angle);
    double x = 1.0, y = 0.0, re = 0.0, im = 0.0;
    for (std::size_t k = 0; k < n; ++k) {
      re += w[k] * x;
      im += w[k] * y;
      const double next = c * x - s * y;
      y = s * x + c * y;
      x = next;
    }
    out.frequency.push_back(static_cast<double>(j) / (static_cast<double>(n) * step));
    out.power.push_back((re * re + im * im) / static_cast<double>(n));
  }
  return out;
}

/// Kolmogorov's tail: P(sqrt(m) D > x).
double kolmogorov_tail(double x) {
  if (x < 0.2) return 1.0;
  double sum = 0.0;
  for (int k = 1; k <= 100; ++k) sum += (k % 2 == 1 ? 2.0 : -2.0) * std::exp(-2.0 * k * k * x * x);
  return std::clamp(sum, 0.0, 1.0);
}

double sum_of(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

void judge_highest_line(const Periodogram& lines, WhitenessReport& out) {
  const double total = sum_of(lines.power);
  if (!(total > 0.0)) return;
  const auto m = static_cast<double>(lines.power.size());
  const auto highest = std::max_element(lines.power.begin(), lines.power.end());
  out.peak_frequency = lines.frequency[highest - lines.power.begin()];
  out.peak_power = *highest * m / total;
  out.peak_p = sidak(std::exp(-out.peak_power), m);
}

void judge_cumulative(WhitenessReport& out) {
  const double total = sum_of(out.power);
  if (!(total > 0.0)) return;
  const auto m = static_cast<double>(out.power.size());
  double sum = 0.0, largest = 0.0;
  for (std::size_t j = 0; j < out.power.size(); ++j) {
    sum += out.power[j];
    largest = std::max(largest, std::abs(sum / total - static_cast<double>(j + 1) / m));
  }
  out.periodogram_p = kolmogorov_tail(std::sqrt(m) * largest);
}

/// Innovations closed up over gaps are as white as without gaps, but zeros in the gaps would leave fewer independent lines than there are
/// frequencies. A line, however, has its frequency in time, gaps included (as long as they are not most of it); its largest power hardly
/// depends on them.
void judge_lines(const StandardisedSeries& of, const std::vector<double>& on_grid, WhitenessReport& out) {
  const double step = usual_step(of.t);
  Periodogram closed_up = periodogram(of.w, step);
  if (on_grid.size() > of.w.size() && on_grid.size() <= 2 * of.w.size()) {
    std::vector<double> filled = on_grid;
    for (double& v : filled) v = std::isfinite(v) ? v : 0.0;
    judge_highest_line(periodogram(filled, step), out);
  } else {
    judge_highest_line(closed_up, out);
  }
  out.frequency = std::move(closed_up.frequency);
  out.power = std::move(closed_up.power);
  judge_cumulative(out);
}

constexpr std::size_t fewest_innovations = 100;

}  // namespace

WhitenessReport whiteness_of(const std::vector<double>& t, const std::vector<double>& innovations) {
  constexpr int lags = 40;
  const std::size_t known = innovations.size();
  WhitenessReport report;
  report.lags = std::min(lags, static_cast<int>(known / 10));
  const std::vector<double> on_grid = on_even_grid(t, innovations);
  report.autocorrelation = autocorrelation(on_grid, report.lags);
  report.band = 1.96 / std::sqrt(static_cast<double>(known));
  const WhitenessTest test = whiteness(on_grid, 1, report.lags);
  report.ljung_box = test.statistic;
  report.ljung_box_p = test.p_value;
  judge_lines({t, innovations}, on_grid, report);
  return report;
}

std::vector<WhitenessReport> whiteness_of(const FilterEstimate& estimate) {
  std::vector<WhitenessReport> out;
  const auto& outputs = estimate.model.system->spec().outputs;
  for (std::size_t e = 0; e < estimate.traces.size(); ++e) {
    for (std::size_t o = 0; o < outputs.size(); ++o) {
      const StandardisedSeries counted = standardised(estimate.traces[e], estimate.data[e], o);
      if (counted.w.size() < fewest_innovations) continue;
      WhitenessReport report = whiteness_of(counted.t, counted.w);
      report.experiment = estimate.data[e].signals->name;
      report.channel = outputs[o].name;
      out.push_back(std::move(report));
    }
  }
  return out;
}

namespace {

/// Squares of standardised innovations, one after the other in time.
struct Squares {
  std::vector<double> value, t;
};

Squares squares_of(const FilterTrace& trace, const FilterData& data) {
  const std::size_t ny = trace.ny;
  Squares out;
  for (std::size_t i = data.first * ny; i < trace.samples * ny; ++i) {
    if (data.use[i] == SampleRole::none || !(trace.S[i] > 0.0)) continue;
    out.value.push_back(trace.e[i] * trace.e[i] / trace.S[i]);
    out.t.push_back(data.signals->t[i / ny]);
  }
  return out;
}

}  // namespace

std::vector<NisSeries> nis_of(const FilterEstimate& estimate) {
  std::vector<NisSeries> out;
  for (std::size_t e = 0; e < estimate.traces.size(); ++e) {
    const std::size_t channels = estimate.traces[e].ny;
    const Squares squares = squares_of(estimate.traces[e], estimate.data[e]);
    constexpr std::size_t windows = 80, fewest_per_channel = 20;
    const std::size_t count = channels * std::max(fewest_per_channel, squares.value.size() / (windows * channels));
    if (squares.value.size() < count) continue;
    NisSeries series;
    series.experiment = estimate.data[e].signals->name;
    const double spread = 1.96 * std::sqrt(2.0 / static_cast<double>(count));
    series.lower = 1.0 - spread;
    series.upper = 1.0 + spread;
    double outside = 0.0;
    for (std::size_t from = 0; from + count <= squares.value.size(); from += count) {
      const auto first = squares.value.begin() + from;
      const double nis = std::accumulate(first, first + count, 0.0) / static_cast<double>(count);
      series.t.push_back(squares.t[from + count / 2]);
      series.nis.push_back(nis);
      outside += nis < series.lower || nis > series.upper ? 1.0 : 0.0;
    }
    series.outside = outside / static_cast<double>(series.nis.size());
    out.push_back(std::move(series));
  }
  return out;
}

std::vector<MissingForce> missing_force_of(const FilterEstimate& estimate) {
  std::vector<MissingForce> out;
  const SystemSpec& spec = estimate.model.system->spec();
  FilterRunner runner(estimate.forced, false);
  runner.set_parameters(estimate.forced.model.values());
  Evaluator evaluator(estimate.forced.model);
  for (const auto& data : estimate.data) {
    FilterTrace trace;
    if (!runner.run(data, estimate.noise, trace, {.keep_P = true})) continue;
    const Smoothing smoothed = smooth_states(trace, data, estimate.noise);
    MissingForce force;
    force.experiment = data.signals->name;
    for (const auto& q : spec.quantities) {
      force.quantities.push_back(q.name);
      force.quantity_units.push_back(q.unit);
    }
    force.values.resize(spec.quantities.size());
    for (int port : estimate.forced.force_ports) {
      force.ports.push_back(spec.dynamic_ports[port].name);
      force.port_units.push_back(spec.dynamic_ports[port].unit);
    }
    force.force.resize(force.ports.size());
    force.sigma.resize(force.ports.size());
    std::vector<double> q(spec.quantities.size());
    for (std::size_t k = data.first; k < trace.samples; ++k) {
      const Eigen::Index row = k;
      force.t.push_back(data.signals->t[k]);
      for (std::size_t p = 0; p < force.ports.size(); ++p) {
        force.force[p].push_back(smoothed.x(row, estimate.forced.force_states[p]));
        force.sigma[p].push_back(std::sqrt(smoothed.variance(row, estimate.forced.force_states[p])));
      }
      evaluator.quantities(smoothed.x.row(row).data(), data.inputs.at(k), data.signals->t[k], q.data());
      for (std::size_t i = 0; i < q.size(); ++i) force.values[i].push_back(q[i]);
    }
    if (lasts_days(force.t)) {
      force.quantities.emplace_back(time_of_day);
      force.quantity_units.emplace_back("h");
      force.values.emplace_back();
      for (const double t : force.t) force.values.back().push_back(hour_of_day(t));
    }
    out.push_back(std::move(force));
  }
  return out;
}

}  // namespace misfit
