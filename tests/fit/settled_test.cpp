// Predictions from states that are not known yet say nothing of the model.
#include "misfit/fit/filter/settled.h"

#include <gtest/gtest.h>

namespace misfit {
namespace {

TEST(SettledPredictions, BeginWhereTheirSigmaIsAsUsual) {
  FilterTrace trace;
  trace.ny = 2;
  trace.samples = 30;
  FilterData data;
  for (std::size_t k = 0; k < trace.samples; ++k) {
    const double sigma = k == 1 ? 117.0 : k == 2 ? 8.0 : k == 20 ? 2.5 : 0.3;
    trace.y_variance.insert(trace.y_variance.end(), {sigma * sigma, 0.01});
    data.use.insert(data.use.end(), {k == 0 ? SampleRole::none : SampleRole::counted, SampleRole::counted});
  }
  const SettledPredictions predictions(trace, data);
  for (std::size_t k = 0; k < trace.samples; ++k) {
    EXPECT_EQ(predictions.settled(k, 0), k != 1 && k != 2) << k;
    EXPECT_TRUE(predictions.settled(k, 1));
    EXPECT_EQ(predictions.all_settled(k), k != 1 && k != 2) << k;
  }
}

TEST(SettledPredictions, AreAllWhereNothingIsMeasured) {
  FilterTrace trace;
  trace.ny = 1;
  trace.samples = 3;
  trace.y_variance = {1e6, 1.0, 1.0};
  FilterData data;
  data.use.assign(3, SampleRole::none);
  EXPECT_TRUE(SettledPredictions(trace, data).settled(0, 0));
}

}  // namespace
}  // namespace misfit
