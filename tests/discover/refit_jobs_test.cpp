// Refits as jobs that survive the process: what comes back from the disk is what was made, to the last bit.
#include "misfit/discover/refit_jobs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "misfit/core/error.h"
#include "misfit/core/files.h"
#include "misfit/discover/candidate_model.h"
#include "misfit/discover/discover.h"
#include "tests/core/temporary_folder.h"
#include "tests/discover/record.h"

namespace misfit {
namespace {

using namespace testing_records;

class RefitJobs : public testing::Test {
 protected:
  RefitJobs() : RefitJobs("coulomb_friction", {{"friction", 3.0}}) {}
  RefitJobs(const std::string& hidden, const std::map<std::string, double>& values)
      : signals_{record_of_cart({testing_models::effect(hidden)}, values)} {
    request_.parameters["stiffness"].free = true;
    estimate_ = estimate_filter(assemble(request_, registry()), {}, signals_);
    score_.emplace(estimate_);
    list_ = candidate_models(estimate_, request_, registry(), nullptr);
    screening_ = screen({estimate_, *score_, ForceSensitivity(estimate_)}, list_);
  }

  [[nodiscard]] const ScreeningResult& effect(const std::string& key) const {
    for (const auto& s : screening_) {
      if (s.candidate_model->effect == key) return s;
    }
    throw std::runtime_error(key + " is not offered");
  }
  [[nodiscard]] RefitWork work(int threads = 0) const { return {estimate_, signals_, registry(), threads}; }
  [[nodiscard]] std::vector<const ScreeningResult*> three() const {
    return {&effect("coulomb_friction"), &effect("quadratic_drag"), &effect("cubic_stiffness")};
  }
  [[nodiscard]] std::vector<std::string> packed(const std::optional<std::vector<SteppedRefit>>& refits) const {
    std::vector<std::string> out;
    for (std::size_t k = 0; refits && k < refits->size(); ++k) out.push_back(pack((*refits)[k], *three()[k]));
    return out;
  }

  std::vector<Signals> signals_;
  ModelRequest request_ = cart({testing_models::effect("viscous_friction")});
  FilterEstimate estimate_;
  std::optional<ScoreTest> score_;
  std::vector<CandidateModel> list_;
  std::vector<ScreeningResult> screening_;
};

TEST_F(RefitJobs, AreTheSameInMemoryOnDiskAndOnAnyThreads) {
  const std::vector<std::string> plain = packed(refit_all(work(1), *score_, three()));
  ASSERT_EQ(plain.size(), 3U);
  EXPECT_EQ(packed(refit_all(work(2), *score_, three())), plain);
  const TemporaryFolder folder;
  EXPECT_EQ(packed(refit_all(work(2), *score_, three(), {StoredJobs{folder.path(), "digest", 0, 0}})), plain);
}

TEST_F(RefitJobs, WhatComesBackCanBeGoneOnWith) {
  const ScreeningResult& friction = effect("coulomb_friction");
  const auto made = refit_all(work(0), *score_, {&friction});
  ASSERT_TRUE(made && made->front().refit.ok);
  const Refit& before = made->front().refit;
  const Refit after = unpack_refit(pack(made->front(), friction), work(), friction).refit;
  EXPECT_EQ(after.drop, before.drop);
  EXPECT_EQ(after.estimate.model.values(), before.estimate.model.values());
  EXPECT_EQ(after.estimate.model.free_parameters(), before.estimate.model.free_parameters());
  EXPECT_EQ(after.parameters.at("friction").value, before.parameters.at("friction").value);
  HeldOut held_out(estimate_, signals_, 0);
  EXPECT_EQ(held_out.gain(after.estimate), held_out.gain(before.estimate));
  const ScreeningResult& other = effect("quadratic_drag");
  const auto score_in = [&](const Refit& in) {
    const std::vector<CandidateModel> list = candidate_models(in.estimate, in.request, registry(), nullptr);
    const auto found =
        std::find_if(list.begin(), list.end(), [&](const CandidateModel& s) { return s.effect == other.candidate_model->effect; });
    return score_cell(in.estimate, ScoreTest(in.estimate), *found, other.cell).result.chi2;
  };
  EXPECT_EQ(score_in(after), score_in(before));
}

class RefitOfAWholeLag : public RefitJobs {
 protected:
  RefitOfAWholeLag() : RefitJobs("input_lag", {{"lagged_gain", 1.0}, {"input_tau", 0.06}}) {}
};

TEST_F(RefitOfAWholeLag, ComesBackWithItsGainHeld) {
  const ScreeningResult& lag = effect("input_lag");
  const auto made = refit_all(work(0), *score_, {&lag});
  ASSERT_TRUE(made && made->front().refit.ok);
  const std::vector<int> held = made->front().refit.estimate.model.free_parameters();
  const Model& model = made->front().refit.estimate.model;
  ASSERT_FALSE(model.parameters[model.find_parameter("lagged_gain")].free);
  const Refit after = unpack_refit(pack(made->front(), lag), work(), lag).refit;
  EXPECT_EQ(after.estimate.model.free_parameters(), held);
  EXPECT_EQ(after.estimate.forced.model.free_parameters(), made->front().refit.estimate.forced.model.free_parameters());
  EXPECT_EQ(after.estimate.covariance.rows(), std::ssize(held));
}

TEST_F(RefitJobs, AreNotMadeAgain) {
  const TemporaryFolder folder;
  const StoredJobs stored{folder.path(), "digest", 0, 1};
  const auto first = refit_all(work(1), *score_, three(), {stored});
  const std::string bytes = read_file(folder.path() / "checkpoint_0.bin");
  EXPECT_EQ(packed(refit_all(work(1), *score_, three(), {stored})), packed(first));
  EXPECT_EQ(read_file(folder.path() / "checkpoint_0.bin"), bytes);
  std::atomic<bool> stop{true};
  EXPECT_TRUE(refit_all(work(1), *score_, three(), {stored, {}, &stop})) << "nothing is left to be stopped";
  EXPECT_FALSE(refit_all(work(1), *score_, three(), {StoredJobs{folder.path(), "other", 0, 1}, {}, &stop}));
}

TEST_F(RefitJobs, OfAnotherEffectOrCutOffAreRefused) {
  const ScreeningResult &friction = effect("coulomb_friction"), &drag = effect("quadratic_drag");
  const std::string bytes = pack(refit_all(work(0), *score_, {&friction})->front(), friction);
  EXPECT_THROW(static_cast<void>(unpack_refit(bytes, work(), drag)), RunError);
  EXPECT_THROW(static_cast<void>(unpack_refit(bytes.substr(0, bytes.size() - 1), work(), friction)), RunError);
  EXPECT_THROW(static_cast<void>(unpack_refit(bytes + "x", work(), friction)), RunError);
}

TEST_F(RefitJobs, ThatFailedSayWhy) {
  const ScreeningResult& friction = effect("coulomb_friction");
  SteppedRefit failed;
  failed.predicted_drop = 4.0;
  failed.refit.why = "it cannot be run";
  const SteppedRefit back = unpack_refit(pack(failed, friction), work(), friction);
  EXPECT_FALSE(back.refit.ok);
  EXPECT_EQ(back.refit.why, "it cannot be run");
  EXPECT_EQ(back.predicted_drop, 4.0);
}

TEST_F(RefitJobs, ASearchThatKeepsThemFindsTheSame) {
  const TemporaryFolder folder;
  DiscoverOptions options;
  const Discovery plain = discover({estimate_, request_, registry(), signals_}, options);
  options.refits = {folder.path(), "digest", 0, 0};
  const Discovery kept = discover({estimate_, request_, registry(), signals_}, options);
  ASSERT_EQ(kept.candidates.size(), plain.candidates.size());
  EXPECT_EQ(kept.verdict, plain.verdict);
  EXPECT_TRUE(kept.candidates.front().accepted);
  EXPECT_EQ(kept.candidates.front().actual_drop, plain.candidates.front().actual_drop);
  EXPECT_EQ(kept.candidates.front().held_out_gain, plain.candidates.front().held_out_gain);
}

TEST_F(RefitJobs, ASearchThatIsStoppedSaysSo) {
  const std::atomic<bool> stop{true};
  DiscoverOptions options;
  options.stop = &stop;
  EXPECT_THROW(static_cast<void>(discover({estimate_, request_, registry(), signals_}, options)), RunError);
}

}  // namespace
}  // namespace misfit
