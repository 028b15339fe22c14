// The law of nested models: with one effect more, on the same measurements and with the same roughness, a model never fits worse than
// without it. Over every effect that suits a system, at its first place.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "misfit/discover/candidate_model.h"
#include "misfit/fit/filter/contained_start.h"
#include "tests/discover/record.h"
#include "tests/fit/flight.h"
#include "tests/fit/planar_model.h"

namespace misfit {
namespace {

using namespace testing_models;

/// A study's model without the effect and its record.
struct Parent {
  std::vector<Signals> signals;
  ModelRequest request;
  FilterEstimate estimate;
  Parent(Signals record, ModelRequest asked) : signals{std::move(record)}, request(std::move(asked)), estimate(fit()) {}

 private:
  [[nodiscard]] FilterEstimate fit() {
    request.curves.clear();
    choose_all_knots(request, registry(), signals, 5);
    const Model model = assemble(request, registry());
    return estimate_filter(model, curve_penalties(model), signals);
  }
};

/// As the ladder compares (lib/misfit/README.md, 6.6): 2 [log L(with) − log L(without)], each from its own estimate, the larger model also
/// from the smaller one's.
double drop(const Parent& parent, const Model& child) {
  FilterOptions options;
  options.around = parent.estimate.around;
  options.choose_roughness = false;
  options.use.emplace();
  for (const auto& data : parent.estimate.data) options.use->push_back(data.use);
  const FilterStart own{parent.estimate.model, parent.estimate.penalties, parent.estimate.noise};
  const FilterEstimate without = estimate_filter(std::vector<FilterStart>{own}, parent.signals, options);
  options.plans = plans_of(without);
  const std::vector<FilterStart> starts = starts_from(contained_fit(without), child);
  EXPECT_FALSE(starts.empty());
  return 2.0 * (estimate_filter(starts, parent.signals, options).objective - without.objective);
}

/// Names and drops of the effects that lose; all are tried.
std::vector<std::string> losers(const Parent& parent, std::size_t fewest) {
  constexpr double rounding = 1e-6;
  std::vector<std::string> out;
  std::set<std::string> tried;
  for (const CandidateModel& candidate : candidate_models(parent.estimate, parent.request, registry(), nullptr)) {
    if (!tried.insert(candidate.effect).second) continue;
    const double gained = drop(parent, assemble(candidate.request, registry()));
    if (!(gained > -2.0 * rounding)) out.push_back(candidate.effect + ": " + std::to_string(gained));
  }
  EXPECT_GE(tried.size(), fewest);
  return out;
}

TEST(LargerModels, NeverLoseOnAFlight) {
  const Parent parent(testing_flight::fly(5.0, 61), spherical());
  EXPECT_THAT(losers(parent, 10), testing::IsEmpty());
}

/// The first samples of a record.
Signals shortened(Signals record, std::size_t samples) {
  record.t.resize(samples);
  for (auto* channels : {&record.measured, &record.inputs})
    for (auto& channel : *channels) channel.values.resize(samples);
  return record;
}

TEST(LargerModels, NeverLoseOnAPlanarMotion) {
  const Parent parent(shortened(testing_planar::validation_signals(), 300), testing_planar::eq_8());
  EXPECT_THAT(losers(parent, 8), testing::IsEmpty());
}

TEST(LargerModels, NeverLoseOnASystemGivenAsText) {
  const ModelRequest duffing = declared("duffing", {});
  const Signals record = testing_records::record(duffing, {}, 1.0 / 610.0, 0.15, {1e-3, 0.5}, 62);
  EXPECT_THAT(losers({shortened(record, 500), duffing}, 5), testing::IsEmpty());
}

}  // namespace
}  // namespace misfit
