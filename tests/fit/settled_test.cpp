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

/// One state that doubles with every sample, shown as three times itself, each prediction of one sample with a variance of 19. Of a run
/// from k, four samples ahead: 3^2 8^2 P + 19 = 576 P + 19, one sample ahead 9 P + 19. P = 1: sigma 24.4 and 5.3; P = 10 at sample 5: 78.2,
/// above three times 24.4, and 10.4, below three times 5.3.
TEST(SettledAhead, GrowWithWhatTheStateIsUnsureOfAndTheStepsUntilThen) {
  FilterTrace trace;
  trace.n = trace.ny = 1;
  trace.samples = 40;
  trace.Phi.assign(trace.samples, 2.0);
  trace.H.assign(trace.samples, 3.0);
  trace.y_variance.assign(trace.samples, 19.0);
  for (std::size_t k = 0; k < trace.samples; ++k) trace.P.insert(trace.P.end(), {k == 5 ? 10.0 : k == 6 ? 9.0 : 1.0, 0.0, 0.0});
  const SettledAhead ahead(trace, 0, 1);
  constexpr std::size_t one = 0, four = 2;
  EXPECT_TRUE(ahead.settled(4, one, 0));
  EXPECT_FALSE(ahead.settled(4, four, 0)) << "78.2 of at most 73.2: behind sample 4 the state is that of sample 5";
  EXPECT_TRUE(ahead.settled(5, four, 0)) << "72.1";
  EXPECT_TRUE(ahead.settled(20, four, 0));
  EXPECT_FALSE(ahead.settled(38, four, 0)) << "the recording ends before";
}

TEST(SettledAhead, AreAllWhereNoCovarianceIsKept) {
  FilterTrace trace;
  trace.n = trace.ny = 1;
  trace.samples = 10;
  EXPECT_TRUE(SettledAhead(trace, 0, 1).settled(3, 2, 0));
}

}  // namespace
}  // namespace misfit
