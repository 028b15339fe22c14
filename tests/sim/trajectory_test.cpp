#include "misfit/sim/trajectory.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "misfit/math/decompositions.h"
#include "tests/model/cases.h"
#include "tests/model/differences.h"

namespace misfit {
namespace {

using namespace testing_models;

/// Uneven samples with inputs that move, from which a model is run.
Signals recording(const Model& model, std::size_t samples) {
  Signals s;
  s.name = "made up";
  for (std::size_t i = 0; i < samples; ++i) s.t.push_back(2.0 + static_cast<double>(i) / 60.0 + (i % 3 == 0 ? 0.002 : 0.0));
  const auto& inputs = model.system->spec().inputs;
  for (std::size_t k = 0; k < inputs.size(); ++k) {
    Signal signal{inputs[k].name, inputs[k].unit, {}, 0.0};
    for (double t : s.t) signal.values.push_back(k == 0 ? 0.4 + 0.8 * t : 0.8);
    s.inputs.push_back(signal);
  }
  return s;
}

std::vector<double> start_of(const Model& model) {
  std::vector<double> x(static_cast<std::size_t>(model.states()), 0.13);
  x[1] = 0.4;
  return x;
}

class SegmentOf : public testing::TestWithParam<Case> {
 protected:
  const Model model_ = GetParam().model();
  Stepper stepper_{model_};
  const std::vector<int> free_ = model_.free_parameters();
  static constexpr std::size_t samples = 14, last = 12;
  const Signals signals_ = recording(model_, samples);
  const InputTable inputs_ = input_table(signals_, model_);

  Segment run(const std::vector<double>& x0, bool sensitivities) {
    Segment out;
    run_segment({stepper_, signals_, inputs_}, {1, last, x0.data(), sensitivities}, out);
    EXPECT_TRUE(out.finite);
    return out;
  }
  /// All outputs, sample-major, then the end state.
  Eigen::VectorXd outputs_and_end(const std::vector<double>& x0) {
    const Segment s = run(x0, false);
    Eigen::VectorXd all(s.y.size() + s.end.size());
    all << Eigen::Map<const Eigen::VectorXd>(s.y.data(), s.y.size()), s.end;
    return all;
  }
  static void expect_column(const Eigen::VectorXd& linear, const Eigen::VectorXd& difference, const std::string& name) {
    // How outputs move with the clock is taken from the rate of the motion, not from the step map: equal to the accuracy of a step
    // (sim/trajectory.cpp).
    const double relative = (name == "clock_offset" || name == "sensor_offset" || name == "clock_rate") ? 1e-4 : 1e-5;
    for (Eigen::Index i = 0; i < linear.size(); ++i)
      EXPECT_NEAR(linear[i], difference[i], relative * std::abs(difference[i]) + 1e-8 * (1.0 + difference.lpNorm<Eigen::Infinity>()))
          << name << ", row " << i;
  }
};

TEST_P(SegmentOf, DerivativesAreCentralDifferencesInTheStartAndAllFreeParameters) {
  const std::vector<double> x0 = start_of(model_);
  const Segment s = run(x0, true);
  const auto stacked = [](const auto& outputs, const auto& end) {
    Eigen::VectorXd all(outputs.size() + end.size());
    all << outputs, end;
    return all;
  };
  const auto columns = static_cast<Eigen::Index>(free_.size());
  for (int j = 0; j < model_.states(); ++j) {
    const auto moved = [&](double value) {
      std::vector<double> from = x0;
      from[static_cast<std::size_t>(j)] = value;
      return outputs_and_end(from);
    };
    expect_column(stacked(s.y_rows.col(columns + j), s.end_rows.col(columns + j)),
                  central_difference(moved, x0[static_cast<std::size_t>(j)]), "start " + std::to_string(j));
  }
  std::vector<double> p = model_.values();
  for (std::size_t c = 0; c < free_.size(); ++c) {
    double& value = p[static_cast<std::size_t>(free_[c])];
    const double nominal = value;
    const auto moved = [&](double to) {
      value = to;
      stepper_.evaluator().set_parameters(p.data());
      return outputs_and_end(x0);
    };
    const auto column = static_cast<Eigen::Index>(c);
    expect_column(stacked(s.y_rows.col(column), s.end_rows.col(column)), central_difference(moved, nominal),
                  model_.parameters[static_cast<std::size_t>(free_[c])].name);
    value = nominal;
    stepper_.evaluator().set_parameters(p.data());
  }
}

TEST_P(SegmentOf, GivesTheSameOutputsWithAndWithoutDerivatives) {
  const std::vector<double> x0 = start_of(model_);
  const Segment plain = run(x0, false), linear = run(x0, true);
  EXPECT_LE((plain.y - linear.y).norm(), 1e-12);
  EXPECT_LE((plain.end - linear.end).norm(), 1e-12);
}

TEST_P(SegmentOf, TwoSegmentsInARowAreOneTrajectory) {
  const std::vector<double> x0 = start_of(model_);
  Segment first, second;
  run_segment({stepper_, signals_, inputs_}, {1, 6, x0.data()}, first);
  ASSERT_TRUE(first.finite);
  run_segment({stepper_, signals_, inputs_}, {6, last, first.end.data()}, second);
  ASSERT_TRUE(second.finite);
  const Segment whole = run(x0, false);
  // Sub-steps are chosen anew where a segment begins, so equal to the accuracy of a step, not to the bit.
  EXPECT_LE((whole.y.bottomRows(6) - second.y).norm(), 1e-5 * whole.y.norm());
  EXPECT_LE((whole.y.topRows(5) - first.y).norm(), 0.0);
}

INSTANTIATE_TEST_SUITE_P(Every, SegmentOf, testing::ValuesIn(cases()), [](const auto& c) { return c.param.name; });

TEST(TrajectoryTest, ANonFiniteStateIsReportedWithTheFirstSampleThatIsNotFinite) {
  const Model model = Case{"", parachute(true)}.model();
  Signals signals = recording(model, 30);
  signals.inputs[1].values[17] = std::nan("");  // the step 16 → 17 meets it
  const InputTable inputs = input_table(signals, model);
  Stepper stepper(model);
  const std::vector<double> x0 = start_of(model);
  for (bool sensitivities : {false, true}) {
    Segment out;
    run_segment({stepper, signals, inputs}, {3, 30, x0.data(), sensitivities}, out);
    EXPECT_FALSE(out.finite);
    EXPECT_EQ(out.failed_at, 17U);
  }
  const RowMatrix states = run_states({stepper, signals, inputs}, {3, 30, x0.data()});
  EXPECT_EQ(states.rows(), 17 - 3) << "only the finite ones";
  EXPECT_TRUE(states.allFinite());
}

TEST(TrajectoryTest, AnExplodingModelIsReportedNotReturned) {
  Model model = Case{"", parachute(false)}.model();
  set_line(model, "C_m_alphadot", 0.0, 45.0, 0.0);  // feeds in energy without bound
  const Signals signals = recording(model, 400);
  const InputTable inputs = input_table(signals, model);
  Stepper stepper(model);
  Segment out;
  run_segment({stepper, signals, inputs}, {0, 400, start_of(model).data(), true}, out);
  ASSERT_FALSE(out.finite);
  EXPECT_GT(out.failed_at, 10U);
  const RowMatrix states = run_states({stepper, signals, inputs}, {0, 400, start_of(model).data()});
  EXPECT_EQ(states.rows(), static_cast<Eigen::Index>(out.failed_at));
}

TEST(TrajectoryTest, TheSameStepperGivesTheSameBitsTwice) {
  const Model model = Case{"", parachute(true, {effect("lag"), effect("coulomb_friction")})}.model();
  const Signals signals = recording(model, 20);
  const InputTable inputs = input_table(signals, model);
  Stepper stepper(model);
  Segment once, twice;
  run_segment({stepper, signals, inputs}, {0, 20, start_of(model).data(), true}, once);
  run_segment({stepper, signals, inputs}, {5, 9, start_of(model).data(), true}, twice);
  run_segment({stepper, signals, inputs}, {0, 20, start_of(model).data(), true}, twice);
  EXPECT_EQ(once.y, twice.y);
  EXPECT_EQ(once.y_rows, twice.y_rows);
  EXPECT_EQ(once.end_rows, twice.end_rows);
}

TEST(TrajectoryTest, AClockThatRunsAheadReadsTheMotionThatComesLater) {
  Model model = assemble(with_values(parachute(false, {effect("time_offset")}), {{"clock_offset", 0.0}}), registry());
  set_parachute_curves(model);
  Signals signals = recording(model, 40);
  for (std::size_t i = 0; i < signals.t.size(); ++i) {  // even samples and a clock angle that rests: the motion does not depend on inputs
    signals.t[i] = static_cast<double>(i) / 60.0;
    signals.inputs[0].values[i] = 0.7;
    signals.inputs[1].values[i] = 0.0;
  }
  const InputTable inputs = input_table(signals, model);
  const std::vector<double> x0 = {0.3, 0.0};
  Segment now, later;
  Stepper on_time(model);
  run_segment({on_time, signals, inputs}, {0, 40, x0.data()}, now);
  set(model, "clock_offset", 2.0 / 60.0);
  Stepper ahead(model);
  run_segment({ahead, signals, inputs}, {0, 40, x0.data()}, later);
  ASSERT_TRUE(now.finite && later.finite);
  // One step over two samples instead of two steps over one: equal to the accuracy of a step.
  EXPECT_LE((later.y.topRows(38) - now.y.bottomRows(38)).lpNorm<Eigen::Infinity>(), 2e-5);
  EXPECT_GT((later.y - now.y).lpNorm<Eigen::Infinity>(), 1e-2);
}

/// Angle against time of the parachute with 20 N m of dry friction at the swivel, in steps far below anything the friction needs.
Signals with_true_friction(double friction) {
  Model model =
      assemble(with_values(parachute(false, {effect("coulomb_friction")}), {{"friction", friction}, {"width", 0.01}}), registry());
  set_parachute_curves(model);
  Signals signals;
  signals.name = "friction";
  constexpr int finer = 200, frames = 150;
  std::vector<double> x = {20.0 * degree, 0.0};
  const double u[] = {0.0, 0.0};
  Stepper stepper(model);
  signals.measured.push_back({"alpha_T", "rad", {}, 0.0});
  signals.inputs = {{"phi", "rad", std::vector<double>(frames, 0.0), 0.0}, {"phi_rate", "rad/s", std::vector<double>(frames, 0.0), 0.0}};
  const double h = 1.0 / 60.0 / finer;
  for (int i = 0; i < frames; ++i) {
    signals.t.push_back(i / 60.0);
    signals.measured[0].values.push_back(x[0]);
    for (int k = 0; k < finer; ++k) EXPECT_TRUE(stepper.step(x.data(), {signals.t.back() + k * h, signals.t.back() + (k + 1) * h, u, u}));
  }
  return signals;
}

struct Frictions {
  double dry, viscous;
};

/// Dry and viscous friction fitted together to the frames by Gauss–Newton on the whole trajectory; all else known.
Frictions recovered_frictions(const std::string& dry, const Signals& signals, double start) {
  ModelRequest request = with_values(parachute(false, {effect(dry), effect("viscous_friction")}), {{"friction", start}, {"width", 0.01}});
  request.parameters["C_m"].free = request.parameters["C_m_alphadot"].free = false;
  Model model = assemble(request, registry());
  set_parachute_curves(model);
  const InputTable inputs = input_table(signals, model);
  const std::vector<int> free = model.free_parameters();  // friction, viscosity: the width is fixed unless a study frees it
  EXPECT_EQ(free.size(), 2U);
  const std::vector<double> x0 = {20.0 * degree, 0.0};
  Segment s;
  for (int iteration = 0; iteration < 40; ++iteration) {
    Stepper stepper(model);
    run_segment({stepper, signals, inputs}, {0, signals.samples(), x0.data(), true}, s);
    EXPECT_TRUE(s.finite);
    const Eigen::MatrixXd J = s.y_rows.leftCols(2);
    const Eigen::VectorXd residual = Eigen::Map<const Eigen::VectorXd>(signals.measured[0].values.data(), s.y.rows()) - s.y.col(0);
    const Eigen::VectorXd change = symmetric_solve(J.transpose() * J, Eigen::VectorXd(J.transpose() * residual));
    for (std::size_t c = 0; c < 2; ++c) model.parameters[static_cast<std::size_t>(free[c])].value += change[static_cast<Eigen::Index>(c)];
  }
  return {model.parameters[static_cast<std::size_t>(free[0])].value, model.parameters[static_cast<std::size_t>(free[1])].value};
}

TEST(SubSteps, RecoverAFrictionOf20NewtonMetresFromFramesFarTooSlowForIt) {
  const Signals signals = with_true_friction(20.0);
  for (double start : {15.0, 20.0, 25.0}) {
    const Frictions f = recovered_frictions("coulomb_friction", signals, start);
    EXPECT_NEAR(f.dry, 20.0, 0.01) << "from " << start;
    EXPECT_NEAR(f.viscous, 0.0, 0.01) << "from " << start;
  }
}

TEST(SubSteps, AreWhatKeepsTheFriction) {
  // The same formula whose author does not announce its fastest rate: even from the truth a quarter of the friction leaves.
  const Frictions f = recovered_frictions("hasty_friction", with_true_friction(20.0), 20.0);
  EXPECT_GT(std::abs(f.dry - 20.0), 3.0);
  EXPECT_GT(std::abs(f.viscous), 3.0);
}

/// What a run reads at its samples is what predict_at() reads at their states, the shift of the clock included.
TEST(PredictAt, SeesTheShiftOfTheClock) {
  Model model = assemble(with_values(parachute(false, {effect("time_offset")}), {{"clock_offset", 0.02}}), registry());
  set_parachute_curves(model);
  const Signals signals = recording(model, 20);
  const InputTable inputs = input_table(signals, model);
  const std::vector<double> x0 = {0.3, 0.1};
  Stepper stepper(model);
  Segment run;
  run_segment({stepper, signals, inputs}, {0, 20, x0.data()}, run);
  const RowMatrix states = run_states({stepper, signals, inputs}, {0, 20, x0.data()});
  std::array<double, kMaxOutputs + 1> y{}, unshifted{};
  double moved = 0.0;
  for (Eigen::Index i = 0; i < states.rows(); ++i) {
    const auto sample = static_cast<std::size_t>(i);
    ASSERT_TRUE(predict_at({stepper, signals, inputs}, sample, states.row(i).data(), y.data()));
    stepper.evaluator().predict(states.row(i).data(), inputs.at(sample), signals.t[sample], unshifted.data());
    for (Eigen::Index o = 0; o < run.y.cols(); ++o) {
      EXPECT_EQ(y[static_cast<std::size_t>(o)], run.y(i, o));
      moved = std::max(moved, std::abs(y[static_cast<std::size_t>(o)] - unshifted[static_cast<std::size_t>(o)]));
    }
  }
  EXPECT_GT(moved, 1e-3);
}

}  // namespace
}  // namespace misfit
