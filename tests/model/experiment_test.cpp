#include "misfit/model/experiment.h"

#include <gtest/gtest.h>
#include <misfit_models_registry.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "misfit/core/error.h"
#include "tests/model/declared_texts.h"

namespace misfit {
namespace {

constexpr double degree = 3.14159265358979323846 / 180.0;

Model eq_8(bool with_gravity = false) {
  static const Registry registry = [] {
    Registry r;
    misfit_models_register(r);
    return r;
  }();
  ModelRequest request;
  request.system = "parachute_planar";
  request.options.flags["induced_angle"] = false;
  request.constants = {{"D", 1.5816}, {"S", 1.9554}, {"R_cp", 3.15}, {"m", 0.206}, {"m_a", 0.294}, {"qbar", 736.0}, {"V", 35.1}};
  request.effects = {{"static_moment", "static_moment", {}, {}}};
  if (with_gravity) request.effects.push_back({"gravity", "gravity", {}, {}});
  request.curves["C_m"] = {"alpha_T", {0.1, 0.2, 0.3}, {}, {}};
  return assemble(request, registry);
}

Table recording(std::size_t samples) {
  Table table;
  table.source = "made.csv";
  std::vector<double> t, alpha, phi;
  for (std::size_t i = 0; i < samples; ++i) {
    t.push_back(0.02 * static_cast<double>(i));
    alpha.push_back(12.0 + 3.0 * std::sin(13.0 * t.back()));
    phi.push_back(std::remainder(100.0 * t.back(), 360.0));
  }
  table.add("t", "s", t);
  table.add("alpha_T", "deg", alpha);
  table.add("phi", "deg", phi);
  return table;
}

ExperimentStudy plain() {
  ExperimentStudy study;
  study.name = "made";
  return study;
}

TEST(SignalsFrom, UnitsBecomeSI) {
  const Signals s = signals_from(recording(50), eq_8(), plain());
  EXPECT_NEAR(s.measured.front().values[0], 12.0 * degree, 1e-12);
}

TEST(SignalsFrom, ATimeThatIsCalledSoIsFoundWhereNoColumnIsCalledT) {
  Table table = recording(50);
  table.columns.front().name = "time_ms";
  table.columns.front().unit = "";
  EXPECT_NEAR(signals_from(table, eq_8(), plain()).t.at(10), 0.2e-3, 1e-12) << "0.2 ms";
  for (const char* temperature : {"T", "T_degC", "x"}) {
    table.columns.front().name = temperature;
    EXPECT_THROW(std::ignore = signals_from(table, eq_8(), plain()), InputError) << temperature;
  }
}

TEST(SignalsFrom, AnInputIsUnwrappedAndMissingValuesAreBridgedButNotUsed) {
  Table table = recording(300);
  table.columns[2].values[100] = std::nan("");
  const Signals s = signals_from(table, eq_8(true), plain());
  EXPECT_NEAR(s.inputs[0].values[299], 100.0 * 0.02 * 299 * degree, 1e-9);  // past three turns
  EXPECT_NEAR(s.inputs[0].values[100], 200.0 * degree, 1e-9);
  EXPECT_TRUE(std::isnan(s.measured.front().values[100]));
  EXPECT_TRUE(s.inputs[1].values.empty());  // phi_rate: nobody needs it
}

/// Whether it acts is for discovery to ask; with gaps, its samples would not count once it does.
TEST(SignalsFrom, AnInputThatNobodyNeedsIsReadWhereItIsWhole) {
  Table table = recording(50);
  EXPECT_EQ(signals_from(table, eq_8(), plain()).inputs[0].values.size(), 50U);
  table.columns[2].values[10] = std::nan("");
  const Signals s = signals_from(table, eq_8(), plain());
  EXPECT_TRUE(s.inputs[0].values.empty());
  EXPECT_FALSE(std::isnan(s.measured.front().values[10]));
}

/// Five seconds of an input in this unit, recorded as the column `u` or, where it is called u_rate, as this level in that unit.
Signals with_angle(const std::string& input, const std::string& unit, const std::vector<double>& u, const std::string& recorded_unit) {
  const auto registry = testing_models::registry_with("[states]\nx = { unit = \"rad\" }\n[inputs]\n" + input + " = { unit = \"" + unit +
                                                      "\" }\n[parameters]\nk = { unit = \"1/s\", value = 1.0 }\nT = { unit = \"" + unit +
                                                      "\", value = 1.0 }\n[equations]\nx = \"k*" + input + "/T*1 - k*x\"\n" +
                                                      "[outputs]\nx = { unit = \"rad\", noise = 0.1 }\n");
  Table table;
  table.source = "made.csv";
  table.add("t", "s", {0.0, 1.0, 2.0, 3.0, 4.0});
  table.add("u", recorded_unit, u);
  table.add("x", "rad", {0.0, 0.0, 0.0, 0.0, 0.0});
  return signals_from(table, assemble(testing_models::request_of("text"), *registry), plain());
}

bool said_unwrapped(const Signals& s) {
  return std::any_of(s.notes.begin(), s.notes.end(), [](const auto& note) { return note.find("unwrapped") != note.npos; });
}

TEST(SignalsFrom, AStepOfARateOfAnAngleIsKept) {
  const std::vector<double> step{0.0, 0.0, 5.0, 5.0, -9.0};
  for (const char* unit : {"rad/s", "rad/s^2"}) {
    const Signals s = with_angle("u", unit, step, unit);
    EXPECT_EQ(s.inputs[0].values, step) << unit;
    EXPECT_FALSE(said_unwrapped(s)) << unit;
  }
  const Signals rate = with_angle("u_rate", "rad/s^2", step, "rad/s");
  EXPECT_EQ(rate.inputs[0].values, (std::vector<double>{2.5, 2.5, 2.5, -7.0, -7.0})) << "differentiated; its ends bridged";
}

TEST(SignalsFrom, AnAngleThatPassesAFullTurnIsUnwrappedAndSaid) {
  const Signals angle = with_angle("u", "rad", {3.0, -3.0, -2.5, 3.0, 3.1}, "rad");
  EXPECT_NEAR(angle.inputs[0].values[1], 360.0 * degree - 3.0, 1e-12);
  EXPECT_EQ(angle.inputs[0].values[4], 3.1);
  EXPECT_TRUE(said_unwrapped(angle));
  EXPECT_FALSE(said_unwrapped(with_angle("u", "rad", {1.0, 2.0, 3.0, 4.0, 5.0}, "rad"))) << "nothing is changed";
  const Signals rate = with_angle("u_rate", "rad/s", {3.0, -3.0, -2.5, 3.0, 3.1}, "rad");
  EXPECT_NEAR(rate.inputs[0].values[1], (360.0 * degree - 5.5) / 2.0, 1e-12);
  EXPECT_TRUE(said_unwrapped(rate));
}

/// Five seconds of a first-order system with the input `u`, declared with these keys.
Signals with_input(const std::vector<double>& u, const std::string& keys, const ExperimentStudy& study) {
  const auto registry = testing_models::registry_with("[states]\nx = { unit = \"m\" }\n[inputs]\nu = { unit = \"m/s\", " + keys +
                                                      " }\n[parameters]\nk = { unit = \"1/s\", value = 1.0, free = true }\n"
                                                      "[equations]\nx = \"u - k*x\"\n[outputs]\nx = { unit = \"m\", noise = 0.1 }\n");
  const Model model = assemble(testing_models::request_of("text"), *registry);
  Table table;
  table.source = "made.csv";
  table.add("t", "s", {0.0, 1.0, 2.0, 3.0, 4.0});
  table.add("u", "m/s", u);
  table.add("x", "m", {0.0, 0.0, 0.0, 0.0, 0.0});
  return signals_from(table, model, study);
}

TEST(SignalsFrom, AnInputThatChangesOnlyWhereItIsHeldOutIsSaid) {
  ExperimentStudy study = plain();
  study.validation = ExperimentStudy::Validation::last_fraction;
  study.fraction = 0.3;
  const auto said = [&](const std::vector<double>& u) {
    const Signals s = with_input(u, "hold = \"zero_order\"", study);
    return std::any_of(s.notes.begin(), s.notes.end(), [](const std::string& note) {
      return note.find("changes in the part that is held out alone") != std::string::npos;
    });
  };
  EXPECT_TRUE(said({5.0, 5.0, 5.0, 5.0, 6.0}));
  EXPECT_TRUE(said({5.0, 5.0, 5.0, 6.0, 6.0}));
  EXPECT_FALSE(said({5.0, 5.0, 6.0, 6.0, 6.0}));
  EXPECT_FALSE(said({5.0, 5.0, 5.0, 5.0, 5.0})) << "a constant";
}

TEST(SignalsFrom, AnInputWithADelayIsSeenLater) {
  const auto seen = [](const std::string& keys) { return with_input({5.0, 7.0, 11.0, 13.0, 17.0}, keys, plain()); };
  using Values = std::vector<double>;
  EXPECT_EQ(seen("delay = \"2 s\"").inputs[0].values, (Values{5.0, 5.0, 5.0, 7.0, 11.0}));
  EXPECT_EQ(seen("delay = \"500 ms\"").inputs[0].values, (Values{5.0, 6.0, 9.0, 12.0, 15.0})) << "between samples";
  EXPECT_EQ(seen("delay = 1.0, hold = \"zero_order\"").inputs[0].values, (Values{5.0, 5.0, 7.0, 11.0, 13.0}));
  EXPECT_EQ(seen("delay = 0.25, hold = \"zero_order\"").inputs[0].values, (Values{5.0, 6.5, 10.0, 12.5, 16.0}))
      << "its mean over an interval";
  EXPECT_EQ(seen("hold = \"zero_order\"").inputs[0].values, (Values{5.0, 7.0, 11.0, 13.0, 17.0}));
  EXPECT_EQ(seen("delay = 9.0").inputs[0].values, (Values{5.0, 5.0, 5.0, 5.0, 5.0})) << "longer than the record";
  const std::vector<std::string> notes = seen("delay = 2.0").notes;
  EXPECT_TRUE(std::any_of(notes.begin(), notes.end(), [](const std::string& note) { return note.find("acts 2 s after") != note.npos; }));
  EXPECT_THROW(static_cast<void>(seen("delay = -1.0")), InputError);
}

TEST(SignalsFrom, IsolatedWildSamplesAreSetAsideAndSaid) {
  Table table = recording(400);
  for (std::size_t i = 50; i < 400; i += 97) table.columns[1].values[i] += 40.0;
  const Signals s = signals_from(table, eq_8(), plain());
  for (std::size_t i = 50; i < 400; i += 97) EXPECT_TRUE(std::isnan(s.measured.front().values[i])) << i;
  EXPECT_EQ(std::count_if(s.measured.front().values.begin(), s.measured.front().values.end(), [](double v) { return std::isnan(v); }), 4);
  bool said = false;
  for (const auto& note : s.notes) said = said || note.find("4 isolated outliers") != std::string::npos;
  EXPECT_TRUE(said);
}

TEST(SignalsFrom, AFlickerOfTheLastDigitOfAStillChannelIsNotAnOutlier) {
  Table table = recording(400);
  for (std::size_t i = 0; i < 400; ++i) table.columns[1].values[i] = i == 120 ? 12.2 : i % 50 == 30 ? 12.1 : 12.0;
  const auto missing = [&] {
    const Signals s = signals_from(table, eq_8(), plain());
    const auto& values = s.measured.front().values;
    return std::count_if(values.begin(), values.end(), [](double v) { return std::isnan(v); });
  };
  EXPECT_EQ(missing(), 0);
  table.columns[1].values[200] = 30.0;
  EXPECT_EQ(missing(), 1);
}

TEST(SignalsFrom, ABurstAfterRestAndAJumpAreMotionNotWildSamples) {
  Table table = recording(400);
  for (std::size_t i = 0; i < 400; ++i) {
    const double t = table.columns[0].values[i];
    table.columns[1].values[i] = i < 350 ? 12.0 + 1e-3 * std::sin(40.0 * t) : 12.0 + 5.0 * std::sin(60.0 * t);
    if (i >= 200 && i < 350) table.columns[1].values[i] += 3.0;
  }
  const Signals s = signals_from(table, eq_8(), plain());
  EXPECT_EQ(std::count_if(s.measured.front().values.begin(), s.measured.front().values.end(), [](double v) { return std::isnan(v); }), 0);
}

TEST(SignalsFrom, TimeThatRunsBackwardsIsRefusedWithBothTimes) {
  Table table = recording(20);
  table.columns[0].values[10] = 0.1;
  EXPECT_THROW(static_cast<void>(signals_from(table, eq_8(), plain())), InputError);
}

TEST(SignalsFrom, AChannelWithoutAnyValueIsRefusedWithItsColumn) {
  Table table = recording(20);
  table.columns[1].values.assign(20, std::nan(""));
  EXPECT_THROW(static_cast<void>(signals_from(table, eq_8(), plain())), RunError) << "it was computed";
  table.line.assign(20, 2);
  try {
    static_cast<void>(signals_from(table, eq_8(), plain()));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("column '" + table.columns[1].name + "', output '"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("has no value at all"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace misfit
