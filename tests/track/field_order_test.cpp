#include "misfit/track/field_order.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace misfit {
namespace {

PixelPoint path(double field) { return {300.0 + 200.0 * std::sin(0.07 * field), 300.0 + 150.0 * std::cos(0.05 * field)}; }

std::vector<FieldPair> pairs(double even_at, double odd_at, double speed = 1.0) {
  std::vector<FieldPair> out;
  for (long n = 0; n < 30; ++n) {
    const double t = 2.0 * static_cast<double>(n);
    out.push_back({n, path(speed * (t + even_at)), path(speed * (t + odd_at))});
  }
  return out;
}

TEST(FieldEvidence, TellsTheThreeWaysApart) {
  EXPECT_EQ(field_evidence(pairs(0.0, 1.0)).order, FieldOrder::top_first);
  EXPECT_EQ(field_evidence(pairs(1.0, 0.0)).order, FieldOrder::bottom_first);
  EXPECT_EQ(field_evidence(pairs(0.0, 0.0)).order, FieldOrder::progressive);
  EXPECT_TRUE(field_evidence(pairs(0.0, 1.0)).decisive);
  EXPECT_TRUE(field_evidence(pairs(1.0, 0.0)).decisive);
  EXPECT_TRUE(field_evidence(pairs(0.0, 0.0)).decisive);
  EXPECT_NEAR(field_evidence(pairs(0.0, 1.0)).asymmetry, 0.5, 0.05);
}

TEST(FieldEvidence, SaysNothingOfAMarkerThatHardlyMoves) {
  const FieldEvidence e = field_evidence(pairs(0.0, 1.0, 0.01));
  EXPECT_EQ(e.order, FieldOrder::unknown);
  EXPECT_FALSE(e.decisive);
  EXPECT_THAT(e.text(), testing::HasSubstr("hardly moves"));
}

TEST(FieldEvidence, NeedsSuccessiveFramesWithTheMarkerInBothFields) {
  auto gaps = pairs(0.0, 1.0);
  for (std::size_t k = 0; k < gaps.size(); ++k)
    if (k % 2 == 0) gaps[k].odd.reset();
  EXPECT_EQ(field_evidence(gaps).pairs, 0U);
  EXPECT_EQ(field_evidence({}).order, FieldOrder::unknown);
  auto few = pairs(0.0, 1.0);
  few.resize(4);
  EXPECT_EQ(field_evidence(few).order, FieldOrder::top_first);
  EXPECT_FALSE(field_evidence(few).decisive);
}

}  // namespace
}  // namespace misfit
