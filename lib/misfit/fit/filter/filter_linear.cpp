#include <algorithm>
#include <cmath>

#include "misfit/core/watch.h"
#include "misfit/fit/filter/filter_run.h"
#include "misfit/fit/filter/filter_sizes.h"
#include "misfit/fit/filter/filter_steps.h"
#include "misfit/fit/filter/unknown_past.h"

namespace misfit {
namespace {

template <int M, int NY>
Innovations run_linear_as(const FilterModel& model, const FilterData& data, const FilterTrace& trace, const FilterNoise& noise) {
  const int n = trace.n, ny = trace.ny;
  const std::vector<double>& t = data.signals->t;
  Innovations out;
  out.resize(trace.samples * ny, !data.steps.empty());
  Kalman<M, NY> kalman(n, ny);
  start_covariance(model, data, noise, kalman);
  UnknownPast past(model, data, n, ny);
  NoiseSteps steps(noise);
  typename Kalman<M, NY>::StateVector a = Kalman<M, NY>::StateVector::Zero(n), correction = a, shifted = a;
  typename Kalman<M, NY>::StateMatrix phi = Kalman<M, NY>::StateMatrix::Zero(n, n);
  const double old_time = model.force_time();
  const std::size_t end = std::min(trace.end, end_of_fit(data));
  for (std::size_t k = data.first; k < end; ++k) {
    look_at_watch();
    for (int o = 0; o < ny; ++o) {
      const std::size_t at = trace.place(k, o);
      if (data.use[at] == SampleRole::none) continue;
      a = trace.H_at(at);
      const double variance = kalman.variance(a, o, noise.channels[o].white);
      const double departure = trace.z[at] - a.dot(kalman.x) - kalman.j[2 * o];
      const Reading reading = out.take(at, departure, variance, data.steps.empty() ? 0.0 : data.steps[o]);
      kalman.update(reading.e, reading.S);
      past.update(a, o, kalman, reading.e, reading.S);
    }
    if (k + 1 == end) break;
    phi = trace.Phi_at(k);
    const double h = t[k + 1] - t[k];
    // The force's own response with the new correlation time, to first order of the step in the rest of the system.
    const double decay = std::exp(-h / noise.force_time) / std::exp(-h / old_time);
    const double share = noise.force_time * std::expm1(-h / noise.force_time) / (old_time * std::expm1(-h / old_time));
    shifted.setZero();  // of the reference itself: its force decays at another rate
    for (int f : model.force_states) {
      const double force = trace.predicted_at(k)[f] + trace.correction_at(k)[f];
      for (int i = 0; i < n; ++i) {
        const double change = phi(i, f) * ((i == f ? decay : share) - 1.0);
        shifted[i] += change * force;
        phi(i, f) += change;
      }
    }
    correction = kalman.x - trace.correction_at(k);
    past.recall(trace, k - data.first, shifted);
    kalman.predict(phi, steps.at(h), model);
    past.predict(phi.data(), {.row = 1, .column = phi.outerStride()}, steps.at(h), kalman);
    kalman.x = phi.lazyProduct(correction) + shifted;
  }
  return out;
}

}  // namespace

Innovations run_linear(const FilterModel& model, const FilterData& data, const FilterTrace& trace, const FilterNoise& noise) {
  return with_filter_size(trace.n, trace.ny, [&]<int M, int NY>() { return run_linear_as<M, NY>(model, data, trace, noise); });
}

double minus_loglik(const FilterData& data, const Innovations& innovations) {
  double sum = 0.0;
  for (std::size_t i = 0; i < innovations.e.size(); ++i) {
    if (data.use[i] == SampleRole::counted) sum += innovations.minus_log_density(i);
  }
  return sum;
}

}  // namespace misfit
