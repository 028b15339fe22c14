// Laws over every registered effect by itself. The author of an effect writes nothing here. Laws inside a system: effect_systems_test.cpp.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <set>

#include "misfit/core/units.h"
#include "misfit/model/role_units.h"
#include "tests/model/differences.h"
#include "tests/model/requests.h"
#include "tests/paths.h"

namespace misfit {
namespace {

using namespace testing_models;

/// Inputs of one evaluation, owned. All in one row: quantities, coefficients, states, constants, as the seeds of a linearisation.
struct Inputs {
  std::vector<double> row;
  std::size_t nq, nc, nz, nk;
  double t;
  RecordedInputs past;
  std::vector<int> input;  // of `past`: of it every quantity is the only one

  explicit Inputs(const Example& e)
      : nq(e.quantities.size()),
        nc(e.coefficients.size()),
        nz(e.states.size()),
        nk(e.constants.size()),
        t(e.t),
        past(e.past()),
        input(nq, 0) {
    for (const auto* part : {&e.quantities, &e.coefficients, &e.states, &e.constants}) row.insert(row.end(), part->begin(), part->end());
  }
  /// Calls use(reads): what it reads lives as long as the call.
  template <class Use>
  void read(const Use& use) const {
    const InputsAt now{row.data(), past.t.empty() ? nullptr : &past};
    use(Reads<double, double>{row.data(), row.data() + nq, row.data() + nq + nc, row.data() + nq + nc + nz, t, {&now, input.data()}});
  }
};

/// The file of an effect, whose stem is its key.
std::string file_of(const std::string& key) {
  for (const char* folder : {"models", "tests/effects"}) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(paths::source() / folder)) {
      if (entry.path().filename() == key + ".cpp") return std::filesystem::relative(entry.path(), paths::source()).string();
    }
  }
  return "the file of " + key;
}

class EffectLaws : public testing::TestWithParam<std::string> {
 protected:
  const Effect& effect_ = registry().effect(GetParam());
  const EffectSpec& spec_ = effect_.spec();
  const std::vector<Example> examples_ = effect_.examples();
  const std::size_t outputs_ = spec_.ports.size() + spec_.states.size();
  const std::string file_ = file_of(GetParam());

  /// What to write, with the names that each list stands for.
  [[nodiscard]] std::string example_line() const {
    const auto names = [](const auto& list) {
      std::vector<std::string> out;
      for (const auto& item : list) out.emplace_back(item.name);
      return fmt::format("{{{}}}", fmt::join(out, ", "));
    };
    std::string line = fmt::format("{{.constants = {{{}}}, .quantities = {}, .coefficients = {}", fmt::join(spec_.constants, ", "),
                                   names(spec_.quantities), names(spec_.coefficients));
    if (!spec_.states.empty()) line += fmt::format(", .states = {0}, .drifts = {0}", names(spec_.states));
    return line + fmt::format(", .ports = {}, .source = \"…\"}}", names(spec_.ports));
  }

  [[nodiscard]] Eigen::VectorXd outputs(const Inputs& in) const {
    Eigen::VectorXd out = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(outputs_), std::nan(""));
    in.read([&](const auto& reads) { effect_.evaluate(reads, out.data()); });
    return out;
  }

  [[nodiscard]] double fastest_rate(const Inputs& in) const {
    double rate = std::nan("");
    in.read([&](const auto& reads) { rate = effect_.fastest_rate(reads, 1.0); });
    return rate;
  }

  struct Linear {
    Eigen::VectorXd out;
    Eigen::MatrixXd J;
  };
  [[nodiscard]] Linear linear(const Inputs& in, bool constants_too) const {
    const std::size_t width = in.row.size() - (constants_too ? 0 : in.nk);
    std::vector<double> J(std::max<std::size_t>(outputs_ * width, 1), std::nan(""));
    Linear l{Eigen::VectorXd::Constant(static_cast<Eigen::Index>(outputs_), std::nan("")), {}};
    in.read([&](const auto& reads) { effect_.linearise(reads, l.out.data(), J.data(), constants_too); });
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    l.J = Eigen::Map<const Rows>(J.data(), static_cast<Eigen::Index>(outputs_), static_cast<Eigen::Index>(width));
    return l;
  }

  void expect_derivatives(const Inputs& in, const std::string& where) const {
    const Linear all = linear(in, true), fixed = linear(in, false);
    const Eigen::VectorXd plain = outputs(in);
    EXPECT_LE((all.out - plain).norm(), 1e-13 * plain.norm()) << where;
    EXPECT_LE((fixed.J - all.J.leftCols(fixed.J.cols())).norm(), 1e-13 * all.J.norm()) << where;
    for (std::size_t i = 0; i < in.row.size(); ++i) {
      const Eigen::VectorXd difference = central_difference(
          [&](double value) {
            Inputs moved = in;
            moved.row[i] = value;
            return outputs(moved);
          },
          in.row[i]);
      for (Eigen::Index o = 0; o < difference.size(); ++o) {
        const double jet = all.J(o, static_cast<Eigen::Index>(i));
        EXPECT_NEAR(jet, difference[o], 1e-6 * std::abs(jet) + 1e-8 * (1.0 + std::abs(plain[o])))
            << where << ": output " << o << ", input " << i;
      }
    }
  }
};

TEST_P(EffectLaws, SaysWhatItIsInSixLinesAndEveryCoefficientHasItsOwn) {
  for (const auto* line : {&spec_.formula, &spec_.symbols, &spec_.valid, &spec_.size, &spec_.source, &spec_.excludes})
    EXPECT_FALSE(line->empty());
  for (const auto& c : spec_.coefficients) EXPECT_NE(std::string(c.doc), "") << c.name;
  EXPECT_EQ(spec_.key, GetParam());
  EXPECT_FALSE(spec_.ports.empty()) << "an effect must act on something";
}

TEST_P(EffectLaws, UnitsParseAndNameOnlyItsOwnRoles) {
  std::map<std::string, std::string> roles;
  for (const auto* list : {&spec_.quantities, &spec_.ports}) {
    for (const auto& role : *list) {
      const bool generic = role.unit[0] == '*' || role.unit[0] == '{';
      if (!generic) {
        EXPECT_NO_THROW(static_cast<void>(parse_unit(role.unit))) << role.name;
      }
      roles[role.name] = generic ? "-" : role.unit;
    }
  }
  const auto check = [&](const std::string& unit, const std::string& of) {
    EXPECT_NO_THROW(static_cast<void>(parse_unit(bind_unit(unit, roles)))) << of;
    for (auto open = unit.find('{'); open != std::string::npos; open = unit.find('{', open + 1)) {
      const std::string role = unit.substr(open + 1, unit.find('}', open) - open - 1);
      EXPECT_TRUE(roles.contains(role)) << of << " [" << unit << "] names '" << role << "', which is no role of the effect";
    }
  };
  for (const auto* list : {&spec_.quantities, &spec_.ports}) {
    for (const auto& role : *list) {
      if (role.unit[0] == '{') check(role.unit, role.name);
    }
  }
  for (const auto& c : spec_.coefficients) check(c.unit, c.name);
  for (const auto& z : spec_.states) check(z.unit, z.name);
}

TEST_P(EffectLaws, NamesAreUnique) {
  const auto expect_unique = [](const auto& list, const char* what) {
    std::set<std::string> names;
    for (const auto& item : list) {
      EXPECT_NE(std::string(item.name), "") << what;
      EXPECT_TRUE(names.insert(item.name).second) << what << " '" << item.name << "' twice";
    }
  };
  expect_unique(spec_.coefficients, "coefficient");
  expect_unique(spec_.states, "own state");
  expect_unique(spec_.quantities, "quantity");
  expect_unique(spec_.ports, "port");
  EXPECT_EQ(std::set<std::string>(spec_.constants.begin(), spec_.constants.end()).size(), spec_.constants.size());
}

TEST_P(EffectLaws, ScansNameWhatTheyAreSharesOfAndLieInsideBounds) {
  for (const auto& c : spec_.coefficients) {
    const std::string over = c.scan.over;
    if (c.scan.count <= 0) continue;
    EXPECT_EQ(c.kind, CoefficientKind::shape) << c.name;
    EXPECT_LE(c.scan.from, c.scan.to) << c.name;
    if (over.empty()) {
      EXPECT_GE(c.scan.from, c.lower) << c.name;
      EXPECT_LE(c.scan.to, c.upper) << c.name;
      continue;
    }
    EXPECT_GT(c.scan.from, 0.0) << c.name << ": shares of a size";
    const auto role_of = [](std::string text) {
      if (text.ends_with("|/step")) text.erase(text.size() - 5);
      if (text.front() == '|') return text.substr(1, text.size() - 2);
      return text.starts_with("+-") || text.starts_with("0 ") ? text.substr(2) : text;
    };
    const std::string role = role_of(over);
    EXPECT_TRUE(role == "step" || role == "1/step" ||
                std::any_of(spec_.quantities.begin(), spec_.quantities.end(), [&](const Role& r) { return role == r.name; }))
        << c.name << " is looked for over '" << over << "'";
  }
}

/// A refit moves what is free: where the screen has not looked at other values of a shape its p-value is too small, and it may look at the
/// wrong end. What has no strength, or is driven by noise, is no candidate.
TEST_P(EffectLaws, EveryShapeOfACandidateIsScannedHeldOrBorrowed) {
  bool candidate = false;
  for (const auto& c : spec_.coefficients) candidate = candidate || (c.kind == CoefficientKind::strength && !c.shared);
  for (const auto& example : examples_) {
    std::vector<double> intensity(spec_.states.size() + 1, 0.0);
    const Inputs in(example);
    in.read([&](const auto& reads) { effect_.diffusion(reads, intensity.data()); });
    for (double value : intensity) candidate = candidate && !(value > 0.0);
  }
  if (!candidate) return;
  for (const auto& c : spec_.coefficients) {
    EXPECT_TRUE(c.kind == CoefficientKind::strength || c.shared || c.fixed || c.scan.count != 0)
        << GetParam() << ": '" << c.name << "' is free in a refit but neither scanned nor held";
  }
}

TEST_P(EffectLaws, DefaultsLieInsideBoundsAndStrengthsMayBeZero) {
  for (const auto& c : spec_.coefficients) {
    EXPECT_LT(c.lower, c.upper) << c.name;
    EXPECT_GE(c.value, c.lower) << c.name;
    EXPECT_LE(c.value, c.upper) << c.name;
    EXPECT_GT(c.scale, 0.0) << c.name;
    if (c.kind == CoefficientKind::strength) {
      EXPECT_LE(c.lower, 0.0) << c.name << " is a strength: 0 is off";
      EXPECT_GE(c.upper, 0.0) << c.name;
    }
  }
}

TEST_P(EffectLaws, WorkedExamplesAreCompleteAndMeetTheFormula) {
  ASSERT_FALSE(examples_.empty()) << file_ << ": add to examples() a line computed by hand,\n  " << example_line();
  for (std::size_t e = 0; e < examples_.size(); ++e) {
    const Example& x = examples_[e];
    ASSERT_EQ(x.quantities.size(), spec_.quantities.size())
        << file_ << ", example " << e << ": .quantities = {…} has one number for each of `quantities`";
    ASSERT_EQ(x.coefficients.size(), spec_.coefficients.size())
        << file_ << ", example " << e << ": .coefficients = {…} has one number for each of `coefficients`";
    ASSERT_EQ(x.states.size(), spec_.states.size()) << file_ << ", example " << e << ": .states = {…} has one number for each of `states`";
    ASSERT_EQ(x.constants.size(), spec_.constants.size())
        << file_ << ", example " << e << ": .constants = {…} has one number for each of `constants`";
    ASSERT_EQ(x.ports.size(), spec_.ports.size()) << file_ << ", example " << e << ": .ports = {…} has one number for each of `ports`";
    ASSERT_EQ(x.drifts.size(), spec_.states.size()) << file_ << ", example " << e << ": .drifts = {…} has one number for each of `states`";
    EXPECT_NE(std::string(x.source), "") << file_ << ", example " << e << ": .source = \"…\" says how it was computed";
    std::vector<double> expected = x.ports;
    expected.insert(expected.end(), x.drifts.begin(), x.drifts.end());
    const Eigen::VectorXd out = outputs(Inputs(x));
    for (std::size_t o = 0; o < expected.size(); ++o)
      EXPECT_NEAR(out[static_cast<Eigen::Index>(o)], expected[o], 1e-6 * std::abs(expected[o]))
          << file_ << ", example " << e << ", output " << o << ": the formula and the number of .ports or .drifts differ";
  }
}

TEST_P(EffectLaws, EveryInputAndOutputIsNonZeroInSomeExample) {
  const auto covered = [&](const char* what, std::size_t count, const std::vector<double> Example::*part) {
    for (std::size_t i = 0; i < count; ++i) {
      bool seen = false;
      for (const auto& e : examples_) seen = seen || (e.*part).at(i) != 0.0;
      EXPECT_TRUE(seen) << file_ << ": " << what << " " << i << " is 0 in every example: give it another value in one of examples()";
    }
  };
  covered("coefficient", spec_.coefficients.size(), &Example::coefficients);
  covered("quantity", spec_.quantities.size(), &Example::quantities);
  covered("own state", spec_.states.size(), &Example::states);
  covered("constant", spec_.constants.size(), &Example::constants);
  covered("port", spec_.ports.size(), &Example::ports);
  covered("drift", spec_.states.size(), &Example::drifts);
}

TEST_P(EffectLaws, JetDerivativesAreCentralDifferencesAtTheExamples) {
  for (std::size_t e = 0; e < examples_.size(); ++e) expect_derivatives(Inputs(examples_[e]), "example " + std::to_string(e));
}

TEST_P(EffectLaws, JetDerivativesAreCentralDifferencesNearZeroOfEachQuantity) {
  for (const auto& example : examples_) {
    for (std::size_t i = 0; i < spec_.quantities.size(); ++i) {
      if (spec_.quantities[i].positive) continue;
      for (double value : {0.0, 1e-9, -1e-6, 1e-3}) {
        Inputs in(example);
        in.row[i] = value;
        expect_derivatives(in,
                           fmt::format("{} = {:g} (a root or a quotient? .positive, or math/regular.h)", spec_.quantities[i].name, value));
      }
    }
  }
}

TEST_P(EffectLaws, IsFiniteWithFiniteDerivativesWhenAllQuantitiesAndStatesAreZero) {
  for (const auto& example : examples_) {
    Inputs in(example);
    for (std::size_t i = 0; i < in.nq; ++i) in.row[i] = spec_.quantities[i].positive ? in.row[i] : 0.0;
    for (std::size_t i = 0; i < in.nz; ++i) in.row[in.nq + in.nc + i] = 0.0;
    EXPECT_TRUE(outputs(in).allFinite());
    EXPECT_TRUE(linear(in, true).J.allFinite());
    EXPECT_TRUE(std::isfinite(fastest_rate(in)));
  }
}

TEST_P(EffectLaws, IsFiniteAtItsDefaultsWhereEveryFitStarts) {
  for (const auto& example : examples_) {
    Inputs in(example);
    for (std::size_t i = 0; i < in.nc; ++i) in.row[in.nq + i] = spec_.coefficients[i].value;
    EXPECT_TRUE(outputs(in).allFinite());
    EXPECT_TRUE(linear(in, true).J.allFinite());
    EXPECT_GE(fastest_rate(in), 0.0);
  }
}

TEST_P(EffectLaws, AddsNothingWhenAllStrengthsAreZero) {
  const bool has_strengths =
      std::any_of(spec_.coefficients.begin(), spec_.coefficients.end(), [](const auto& c) { return c.kind == CoefficientKind::strength; });
  if (!has_strengths) return;  // coning, gravity: on or left out
  for (const auto& example : examples_) {
    Inputs in(example);
    for (std::size_t i = 0; i < in.nc; ++i) {
      if (spec_.coefficients[i].kind == CoefficientKind::strength) in.row[in.nq + i] = 0.0;
    }
    const Eigen::VectorXd out = outputs(in);
    for (std::size_t p = 0; p < spec_.ports.size(); ++p) EXPECT_EQ(out[static_cast<Eigen::Index>(p)], 0.0) << spec_.ports[p].name;
  }
}

TEST_P(EffectLaws, StrengthsActFromTheFirstBit) {
  for (std::size_t c = 0; c < spec_.coefficients.size(); ++c) {
    if (spec_.coefficients[c].kind != CoefficientKind::strength) continue;
    bool acts = false;
    for (const auto& example : examples_) {
      Inputs in(example);
      in.row[in.nq + c] = 0.0;
      const Eigen::MatrixXd J = linear(in, false).J;
      acts = acts || J.col(static_cast<Eigen::Index>(in.nq + c)).head(static_cast<Eigen::Index>(spec_.ports.size())).norm() > 0.0;
    }
    EXPECT_TRUE(acts) << spec_.coefficients[c].name << ": a score test at 0 could not see it";
  }
}

TEST_P(EffectLaws, DiffusionIsFiniteAndNotNegative) {
  for (const auto& example : examples_) {
    std::vector<double> intensity(spec_.states.size() + 1, 0.0);
    const Inputs in(example);
    in.read([&](const auto& reads) { effect_.diffusion(reads, intensity.data()); });
    for (double value : intensity) EXPECT_TRUE(std::isfinite(value) && value >= 0.0);
  }
}

INSTANTIATE_TEST_SUITE_P(Every, EffectLaws, testing::ValuesIn(registry().effect_keys()), [](const auto& key) { return key.param; });

}  // namespace
}  // namespace misfit
