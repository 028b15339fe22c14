#include "misfit/uncertainty/scatter.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "misfit/math/statistics.h"

namespace misfit {
namespace {

struct Numbers {
  std::string method, name, unit;
  std::vector<double> value, sigma;
};

void add(const BatchRow& row, const std::string& name, const Estimate& e, std::vector<Numbers>& all) {
  if (!std::isfinite(e.value)) return;
  auto found =
      std::find_if(all.begin(), all.end(), [&](const Numbers& n) { return n.method == row.method && n.name == name && n.unit == e.unit; });
  if (found == all.end()) found = all.insert(all.end(), {row.method, name, e.unit, {}, {}});
  found->value.push_back(e.value);
  found->sigma.push_back(std::isfinite(e.sigma) ? e.sigma : 0.0);
}

BatchSummary summary_of(const Numbers& n) {
  BatchSummary out;
  out.method = n.method;
  out.name = n.name;
  out.unit = n.unit;
  out.count = n.value.size();
  const auto count = static_cast<double>(n.value.size());
  const bool known = std::all_of(n.sigma.begin(), n.sigma.end(), [](double s) { return s > 0.0; });
  double weights = 0.0, sum = 0.0, plain = 0.0, squares = 0.0, chi2 = 0.0;
  for (std::size_t i = 0; i < n.value.size(); ++i) {
    const double w = known ? 1.0 / (n.sigma[i] * n.sigma[i]) : 1.0;
    weights += w;
    sum += w * n.value[i];
    plain += n.value[i] / count;
    out.own_sigma += n.sigma[i] * n.sigma[i] / count;
  }
  out.mean = sum / weights;
  for (std::size_t i = 0; i < n.value.size(); ++i) {
    squares += (n.value[i] - plain) * (n.value[i] - plain);
    if (known) chi2 += std::pow((n.value[i] - out.mean) / n.sigma[i], 2);
  }
  out.scatter = std::sqrt(squares / (count - 1.0));
  out.own_sigma = known ? std::sqrt(out.own_sigma) : 0.0;
  if (!known) return out;
  out.mean_sigma = 1.0 / std::sqrt(weights);
  out.p_value = chi_square_tail(chi2, count - 1.0);
  return out;
}

}  // namespace

std::vector<BatchSummary> summarise(const std::vector<BatchRow>& rows) {
  std::vector<Numbers> all;
  for (const BatchRow& row : rows) {
    if (row.status != to_string(FitStatus::converged)) continue;  // where it stopped is no maximum, and its sigmas none of it
    for (const auto& [name, e] : row.values) add(row, name, e, all);
  }
  std::vector<BatchSummary> out;
  for (const Numbers& n : all) {
    if (n.value.size() > 1) out.push_back(summary_of(n));
  }
  return out;
}

}  // namespace misfit
