// Where the screen looks: between the cells of a grid, and over several experiments at once.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "misfit/discover/screen.h"
#include "tests/discover/record.h"

namespace misfit {
namespace {

using namespace testing_records;

struct Screening {
  std::vector<Signals> signals;
  ModelRequest request = cart({effect("viscous_friction")});
  FilterEstimate estimate;
  std::vector<CandidateModel> list;
  std::vector<ScreeningResult> found;

  Screening(std::vector<Signals> recorded, const std::string& key) : signals(std::move(recorded)) {
    request.parameters["stiffness"].free = true;
    estimate = estimate_filter(assemble(request, registry()), {}, signals);
    for (auto& s : candidate_models(estimate, request, registry(), nullptr)) {
      if (s.effect == key) list.push_back(std::move(s));
    }
    found = screen({estimate, ScoreTest(estimate), ForceSensitivity(estimate)}, list);
  }
};

/// The grid of a lag goes from 1 to 20 steps of 0.05 s in four equal ratios: 0.05, 0.14, 0.37 and 1 s.
TEST(ScreenCells, AShapeBetweenGeometricCellsIsLookedForBetweenThem) {
  constexpr double tau = 0.22;
  const Screening s({record_of_cart({effect("lag")}, {{"lag_stiffness", 8.0}, {"tau", tau}})}, "lag");
  ASSERT_EQ(s.list.size(), 1U);
  const std::vector<std::vector<double>>& cells = s.list[0].cells;
  ASSERT_EQ(cells.size(), 4U);
  EXPECT_NEAR(cells[2][0] / cells[1][0], cells[1][0] / cells[0][0], 1e-9);
  const ScoreTest score(s.estimate);
  double nearest = 1e9, most = 0.0;
  for (const auto& cell : cells) {
    nearest = std::min(nearest, std::abs(std::log(cell[0] / tau)));
    most = std::max(most, score_cell(s.estimate, score, s.list[0], cell).result.chi2);
  }
  EXPECT_GT(s.found[0].result.chi2, most);
  EXPECT_LT(std::abs(std::log(s.found[0].cell[0] / tau)), 0.6 * nearest) << s.found[0].cell[0] << " s";
  EXPECT_LE(s.found[0].cells_effective, 4.0) << "what lies between two cells is not another chance";
}

/// A line too weak for one record is the same line in both: their scores add before the power is taken.
TEST(ScreenCells, ALineIsLookedForInAllExperimentsAtOnce) {
  const std::map<std::string, double> line = {{"cosine", 0.02}, {"sine", 0.012}, {"frequency", 1.3}};
  const Signals first = record_of_cart({effect("periodic_forcing")}, line, 51),
                second = record_of_cart({effect("periodic_forcing")}, line, 52);
  const Screening both({first, second}, "periodic_forcing"), one({first}, "periodic_forcing"), other({second}, "periodic_forcing");
  const double half_width = 1.0 / (4.0 * first.t.back());
  EXPECT_NEAR(both.found[0].frequencies.step, half_width, 1e-12) << "the length of one experiment, not of both";
  EXPECT_NEAR(both.found[0].cell.back(), 1.3, half_width);
  EXPECT_LT(both.found[0].p_value, one.found[0].p_value);
  EXPECT_LT(both.found[0].p_value, other.found[0].p_value);
  EXPECT_LT(both.found[0].p_value, 1e-4);
}

}  // namespace
}  // namespace misfit
