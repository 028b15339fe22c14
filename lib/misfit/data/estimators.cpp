#include "misfit/data/estimators.h"

#include <algorithm>

#include "misfit/core/text.h"

namespace misfit {
namespace {

template <class Condition>
std::vector<std::string> names_where(const Condition& holds) {
  std::vector<std::string> out;
  for (const EstimatorInfo* info : estimators::all) {
    if (holds(*info)) out.emplace_back(info->name);
  }
  return out;
}

template <class Condition>
const EstimatorInfo& first_where(const Condition& holds) {
  return **std::find_if(estimators::all.begin(), estimators::all.end(), [&](const EstimatorInfo* info) { return holds(*info); });
}

}  // namespace

std::vector<std::string> estimator_names() {
  return names_where([](const EstimatorInfo&) { return true; });
}

std::vector<std::string> default_estimators() {
  return names_where([](const EstimatorInfo& info) { return info.by_default; });
}

const EstimatorInfo* find_estimator(const std::string& name) {
  const auto found = std::find_if(estimators::all.begin(), estimators::all.end(), [&](const auto* info) { return info->name == name; });
  return found == estimators::all.end() ? nullptr : *found;
}

const EstimatorInfo& trajectory_estimator() {
  return first_where([](const EstimatorInfo& info) { return info.has_likelihood && info.deterministic; });
}

const EstimatorInfo& random_force_estimator() {
  return first_where([](const EstimatorInfo& info) { return info.has_likelihood && !info.deterministic; });
}

bool has_likelihood(const std::string& name) {
  const EstimatorInfo* info = find_estimator(name);
  return info != nullptr && info->has_likelihood;
}

std::string estimators_with_likelihood() {
  return join_words(names_where([](const EstimatorInfo& info) { return info.has_likelihood; }));
}

}  // namespace misfit
