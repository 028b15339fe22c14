// Laws of assembled models: the chain rule over effects gives the derivatives of what rates() and predict() compute.
#include "misfit/model/evaluator.h"

#include <gtest/gtest.h>

#include "tests/model/cases.h"
#include "tests/model/differences.h"

namespace misfit {
namespace {

using namespace testing_models;

class AssembledModel : public testing::TestWithParam<Case> {
 protected:
  const Model model_ = GetParam().model();
  Evaluator evaluator_{model_};
  const std::vector<int> free_ = model_.free_parameters();
  const int n_ = model_.states(), columns_ = static_cast<int>(free_.size()), outputs_ = evaluator_.sensor_ports();

  Eigen::VectorXd rates(const Sample& at) {
    Eigen::VectorXd dx(n_);
    evaluator_.rates(at.x.data(), at.inputs(), at.t, dx.data());
    return dx;
  }
  Eigen::VectorXd outputs(const Sample& at) {
    Eigen::VectorXd y(outputs_);
    evaluator_.predict(at.x.data(), at.inputs(), at.t, y.data());
    return y;
  }

  struct Linear {
    Eigen::VectorXd value;
    Eigen::MatrixXd D;
  };
  static Linear linear_rates(Evaluator& evaluator, const Sample& at, Slots& slots) {
    const int n = evaluator.states();
    std::vector<double> rows(static_cast<std::size_t>(n) * kRowStride, std::nan(""));
    Linear l{Eigen::VectorXd(n), {}};
    evaluator.linearise_rates({at.x.data(), at.inputs(), at.t}, slots, l.value.data(), rows.data());
    l.D = dense(rows, n, n, slots, evaluator.columns());
    return l;
  }
  static Linear linear_outputs(Evaluator& evaluator, const Sample& at, Slots& slots) {
    const int outputs = evaluator.sensor_ports();
    std::vector<double> rows(static_cast<std::size_t>(outputs) * kRowStride, std::nan(""));
    Linear l{Eigen::VectorXd(outputs), {}};
    evaluator.linearise_outputs({at.x.data(), at.inputs(), at.t}, slots, l.value.data(), rows.data());
    l.D = dense(rows, outputs, evaluator.states(), slots, evaluator.columns());
    return l;
  }

  template <class F>
  Eigen::MatrixXd differences(const Sample& at, const F& f) {
    Eigen::MatrixXd D(f(at).size(), n_ + columns_);
    for (int j = 0; j < n_; ++j) {
      const auto moved = [&](double value) {
        Sample sample = at;
        sample.x[static_cast<std::size_t>(j)] = value;
        return f(sample);
      };
      D.col(j) = central_difference(moved, at.x[static_cast<std::size_t>(j)]);
    }
    for (int c = 0; c < columns_; ++c) {
      std::vector<double> p = model_.values();
      double& value = p[static_cast<std::size_t>(free_[static_cast<std::size_t>(c)])];
      const double nominal = value;
      const auto moved = [&](double to) {
        value = to;
        evaluator_.set_parameters(p.data());
        return f(at);
      };
      D.col(n_ + c) = central_difference(moved, nominal);
      value = nominal;
      evaluator_.set_parameters(p.data());
    }
    return D;
  }

  void expect_equal(const Linear& linear, const Eigen::MatrixXd& difference, const Eigen::VectorXd& plain, const std::string& where) const {
    ASSERT_TRUE(linear.D.allFinite()) << where;
    EXPECT_LE((linear.value - plain).norm(), 1e-12 * (1.0 + plain.norm())) << where;
    for (int i = 0; i < difference.rows(); ++i) {
      for (int j = 0; j < difference.cols(); ++j) {
        const std::string column = j < n_ ? "state " + std::to_string(j)
                                          : model_.parameters[static_cast<std::size_t>(free_[static_cast<std::size_t>(j - n_)])].name;
        EXPECT_NEAR(linear.D(i, j), difference(i, j), 2e-6 * std::abs(difference(i, j)) + 1e-7 * (1.0 + std::abs(plain[i])))
            << where << ": row " << i << ", " << column;
      }
    }
  }
};

TEST_P(AssembledModel, DerivativesOfRatesAreCentralDifferencesInStatesAndAllFreeParameters) {
  for (const Sample& at : samples_of(model_, 6)) {
    Slots slots;
    const Linear linear = linear_rates(evaluator_, at, slots);
    expect_equal(linear, differences(at, [&](const Sample& s) { return rates(s); }), rates(at), "t = " + std::to_string(at.t));
  }
}

TEST_P(AssembledModel, DerivativesOfOutputsAreCentralDifferencesInStatesAndAllFreeParameters) {
  for (const Sample& at : samples_of(model_, 6)) {
    Slots slots;
    const Linear linear = linear_outputs(evaluator_, at, slots);
    expect_equal(linear, differences(at, [&](const Sample& s) { return outputs(s); }), outputs(at), "t = " + std::to_string(at.t));
  }
}

TEST_P(AssembledModel, EveryFreeParameterMovesARateOrAnOutput) {
  Eigen::VectorXd effect = Eigen::VectorXd::Zero(columns_);
  for (const Sample& at : samples_of(model_, 60)) {
    Slots slots;
    effect += linear_rates(evaluator_, at, slots).D.rightCols(columns_).cwiseAbs().colwise().sum().transpose();
    effect += linear_outputs(evaluator_, at, slots).D.rightCols(columns_).cwiseAbs().colwise().sum().transpose();
  }
  for (int c = 0; c < columns_; ++c)
    EXPECT_GT(effect[c], 0.0) << model_.parameters[static_cast<std::size_t>(free_[static_cast<std::size_t>(c)])].name;
}

TEST_P(AssembledModel, AUsedEvaluatorGivesTheSameBitsAsAFreshOne) {
  const auto samples = samples_of(model_, 5);
  Slots kept;  // not cleared: as over the stages of one step
  for (const Sample& warm : samples) {
    static_cast<void>(linear_rates(evaluator_, warm, kept));
    static_cast<void>(linear_outputs(evaluator_, warm, kept));
  }
  for (const Sample& at : samples) {
    Evaluator fresh(model_);
    Slots own;
    const Linear used = linear_rates(evaluator_, at, kept), first = linear_rates(fresh, at, own);
    EXPECT_EQ(used.value, first.value);
    EXPECT_EQ(used.D, first.D);
    Slots own_outputs;
    const Linear used_y = linear_outputs(evaluator_, at, kept), first_y = linear_outputs(fresh, at, own_outputs);
    EXPECT_EQ(used_y.value, first_y.value);
    EXPECT_EQ(used_y.D, first_y.D);
  }
}

TEST_P(AssembledModel, RestAtZeroIsFiniteWithFiniteDerivatives) {
  const Sample rest = samples_of(model_, 1).front();
  Slots slots;
  EXPECT_TRUE(rates(rest).allFinite());
  EXPECT_TRUE(linear_rates(evaluator_, rest, slots).D.allFinite());
  EXPECT_TRUE(linear_outputs(evaluator_, rest, slots).D.allFinite());
}

INSTANTIATE_TEST_SUITE_P(Every, AssembledModel, testing::ValuesIn(cases()), [](const auto& c) { return c.param.name; });

TEST(EvaluatorTest, AWanderingSolverThatArrivesAtNotANumberGetsNotANumberBack) {
  const Model model = Case{"", parachute(true, {effect("lag"), effect("dynamic_pressure_drift")})}.model();
  Evaluator evaluator(model);
  const double x[3] = {std::nan(""), 1e300, 0.0}, u[2] = {0.0, 0.0};
  double dx[3];
  evaluator.rates(x, u, 0.0, dx);
  EXPECT_FALSE(std::isfinite(dx[1]));
  Slots slots;
  std::vector<double> D(3 * static_cast<std::size_t>(kRowStride));
  evaluator.linearise_rates({x, u, 0.0}, slots, dx, D.data());
  EXPECT_FALSE(std::isfinite(dx[1]));
}

TEST(EvaluatorTest, FreeConstantsLeaveTheRatesTheirFastDerivativesAndEffectsOnQuantitiesDoNot) {
  const auto is_fast = [](const ModelRequest& request) {
    const Model model = Case{"", request}.model();
    Evaluator evaluator(model);
    const double x[8] = {0.1, 0.2, 0.3, 0.4};
    double dx[8];
    Slots slots;
    std::vector<double> D(8 * static_cast<std::size_t>(kRowStride));
    return evaluator.linearise_rates_sparsely({x, nullptr, 0.0}, slots, dx, D.data());
  };
  EXPECT_TRUE(is_fast(free_camera(spherical())));
  EXPECT_TRUE(is_fast(free_camera(spherical({effect("viscous_friction", {{"rate", "image_scale"}})}))));
  ModelRequest heavier = free_camera(spherical());
  heavier.parameters["m_a"].free = true;
  EXPECT_TRUE(is_fast(heavier));
  EXPECT_FALSE(is_fast(spherical({effect("dynamic_pressure_drift")})));
}

TEST(EvaluatorTest, QuantitiesAreThoseOfTheStateWithTheEffectsOnThem) {
  Model model = assemble(with_values(parachute(true, {effect("dynamic_pressure_drift")}), {{"pressure_drift", 10.0}}), registry());
  Evaluator evaluator(model);
  const double x[2] = {0.2, 0.5}, u[2] = {0.3, 0.4};
  std::vector<double> q(model.system->spec().quantities.size());
  evaluator.quantities(x, u, 7.36, q.data());
  const auto value = [&](const std::string& name) {
    for (std::size_t i = 0; i < q.size(); ++i) {
      if (model.system->spec().quantities[i].name == name) return q[i];
    }
    throw std::logic_error(name);
  };
  EXPECT_NEAR(value("dynamic_pressure"), 736.0 * 1.1, 1e-10);
  EXPECT_NEAR(value("wind_speed"), 35.1 * std::sqrt(1.1), 1e-10);
  const double V = 35.1 * std::sqrt(1.1), along = V * std::cos(0.2), in_plane = V * std::sin(0.2) + 3.15 * 0.5,
               across = 3.15 * 0.4 * std::sin(0.2);
  EXPECT_NEAR(std::tan(value("alpha_T")), std::hypot(in_plane, across) / along, 1e-12);
  EXPECT_NEAR(value("inertia"), 0.5 * 3.15 * 3.15, 1e-12);
}

}  // namespace
}  // namespace misfit
