#include "misfit/diagnose/innovations.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "misfit/core/lists.h"
#include "misfit/diagnose/features.h"
#include "misfit/inference/states.h"
#include "misfit/math/statistics.h"
#include "misfit/math/whiteness.h"

namespace misfit {
namespace {

constexpr double pi = std::numbers::pi;

/// Standardised innovations of one channel; NaN where there is none.
std::vector<double> standardised(const FilterTrace& trace, const FilterData& data, std::size_t channel) {
  const std::size_t ny = trace.ny;
  std::vector<double> out(trace.samples, std::nan(""));
  for (std::size_t k = 0; k < trace.samples; ++k) {
    const std::size_t at = k * ny + channel;
    if (data.use[at] == SampleRole::counted) out[k] = trace.e[at] / std::sqrt(trace.S[at]);
  }
  return out;
}

/// Power of white noise is 1 on average. Goertzel-free: direct sums by rotation, exact enough for the few thousand samples of a recording.
void periodogram(const std::vector<double>& w, double step, WhitenessReport& out) {
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
}

/// Kolmogorov's tail: P(sqrt(m) D > x).
double kolmogorov_tail(double x) {
  if (x < 0.2) return 1.0;
  double sum = 0.0;
  for (int k = 1; k <= 100; ++k) sum += (k % 2 == 1 ? 2.0 : -2.0) * std::exp(-2.0 * k * k * x * x);
  return std::clamp(sum, 0.0, 1.0);
}

void judge_lines(WhitenessReport& out) {
  double total = 0.0;
  for (double p : out.power) total += p;
  if (!(total > 0.0)) return;
  const auto m = static_cast<double>(out.power.size());
  const auto highest = std::max_element(out.power.begin(), out.power.end());
  out.peak_frequency = out.frequency[highest - out.power.begin()];
  out.peak_power = *highest * m / total;
  out.peak_p = sidak(std::exp(-out.peak_power), m);
  double sum = 0.0, largest = 0.0;
  for (std::size_t j = 0; j < out.power.size(); ++j) {
    sum += out.power[j];
    largest = std::max(largest, std::abs(sum / total - static_cast<double>(j + 1) / m));
  }
  out.periodogram_p = kolmogorov_tail(std::sqrt(m) * largest);
}

}  // namespace

std::vector<WhitenessReport> whiteness_of(const FilterEstimate& estimate) {
  constexpr int lags = 40;
  std::vector<WhitenessReport> out;
  const auto& outputs = estimate.model.system->spec().outputs;
  for (std::size_t e = 0; e < estimate.traces.size(); ++e) {
    for (std::size_t o = 0; o < outputs.size(); ++o) {
      std::vector<double> w = standardised(estimate.traces[e], estimate.data[e], o);
      const std::size_t known = count_finite(w);
      if (known < 100) continue;
      WhitenessReport report;
      report.experiment = estimate.data[e].signals->name;
      report.channel = outputs[o].name;
      report.lags = std::min(lags, static_cast<int>(known / 10));
      const std::vector<double> even = on_even_grid(estimate.data[e].signals->t, w);
      report.autocorrelation = autocorrelation(even, report.lags);
      report.band = 1.96 / std::sqrt(static_cast<double>(known));
      const WhitenessTest test = whiteness(even, 1, report.lags);
      report.ljung_box = test.statistic;
      report.ljung_box_p = test.p_value;
      for (double& v : w) {
        if (!std::isfinite(v)) v = 0.0;
      }
      periodogram(w, usual_step(estimate.data[e].signals->t), report);
      judge_lines(report);
      out.push_back(std::move(report));
    }
  }
  return out;
}

std::vector<NisSeries> nis_of(const FilterEstimate& estimate) {
  std::vector<NisSeries> out;
  for (std::size_t e = 0; e < estimate.traces.size(); ++e) {
    const FilterTrace& trace = estimate.traces[e];
    const FilterData& data = estimate.data[e];
    const std::size_t ny = trace.ny;
    NisSeries series;
    series.experiment = data.signals->name;
    const std::size_t window = std::max<std::size_t>(20, trace.samples / 80);
    double outside = 0.0;
    for (std::size_t from = data.first; from + window <= trace.samples; from += window) {
      double sum = 0.0, count = 0.0;
      for (std::size_t i = from * ny; i < (from + window) * ny; ++i) {
        if (data.use[i] == SampleRole::none || !(trace.S[i] > 0.0)) continue;
        sum += trace.e[i] * trace.e[i] / trace.S[i];
        count += 1.0;
      }
      if (count < static_cast<double>(window)) continue;
      series.t.push_back(data.signals->t[from + window / 2]);
      series.nis.push_back(sum / count);
    }
    const double spread = 1.96 * std::sqrt(2.0 / static_cast<double>(window * ny));
    series.lower = 1.0 - spread;
    series.upper = 1.0 + spread;
    for (double v : series.nis) outside += v < series.lower || v > series.upper ? 1.0 : 0.0;
    series.outside = series.nis.empty() ? 0.0 : outside / static_cast<double>(series.nis.size());
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
