#include "misfit/fit/filter/likelihood_drop.h"

#include <algorithm>

#include "misfit/fit/filter/reading.h"
#include "misfit/model/whole_steps.h"

namespace misfit {

std::vector<double> steps_of_one_alone(const FilterEstimate& with, const FilterEstimate& without) {
  std::vector<double> steps = steps_of_outputs(with.model);
  const std::vector<double> known = steps_of_outputs(without.model);
  for (std::size_t o = 0; o < std::min(steps.size(), known.size()); ++o) {
    if (known[o] > 0.0) steps[o] = 0.0;
  }
  return steps;
}

double change_in_cells(const FilterData& data, const FilterTrace& trace, const std::vector<double>& steps) {
  double sum = 0.0;
  for (std::size_t at = 0; !steps.empty() && at < data.use.size(); ++at) {
    const double step = steps[at % steps.size()];
    if (!(step > 0.0) || data.use[at] != SampleRole::counted) continue;
    sum += trace.minus_log_density(at) - read_in_steps(trace.departure(at), trace.variance(at), step).minus_log;
  }
  return sum;
}

double likelihood_drop(const FilterEstimate& with, const FilterEstimate& without) {
  const std::vector<double> steps = steps_of_one_alone(with, without);
  double change = 0.0;
  for (std::size_t e = 0; e < without.data.size(); ++e) change += change_in_cells(without.data[e], without.traces[e], steps);
  return 2.0 * (with.objective - without.objective - change);
}

}  // namespace misfit
