// Studies and declared systems that are hostile: refused at their place, in a message of readable length.

#include <gtest/gtest.h>

#include <algorithm>

#include "misfit/data/study.h"
#include "misfit/model/declared.h"
#include "misfit/model/request.h"
#include "tests/core/temporary_folder.h"
#include "tests/model/requests.h"

namespace misfit {
namespace {

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const auto at = text.find(what);
  if (at == std::string::npos) throw std::logic_error("no '" + what + "' in the text");
  return text.replace(at, what.size(), by);
}

struct Hostile {
  const char* name;
  const char* what;  ///< of the study or the system …
  std::string by;    ///< … is replaced by this
  std::vector<const char*> expected;
};

void PrintTo(const Hostile& hostile, std::ostream* out) { *out << hostile.name; }

class HostileText : public testing::TestWithParam<Hostile> {
 protected:
  /// A study of one declared system with one recording.
  static void read(const std::string& study_text, const std::string& system_text) {
    const TemporaryFolder folder;
    folder.write("tank.toml", system_text);
    folder.write("d.csv", "t[s],u[V],level[V]\n0,1,2\n");
    const Study study = read_study(folder.write("study.toml", study_text));
    const auto known = study_registry(study, testing_models::registry());
    static_cast<void>(read_model(study, *known));
  }

  static constexpr const char* study_toml =
      "[system]\nfile = \"tank.toml\"\n[[experiment]]\ndata = \"d.csv\"\ncolumns = { t = \"t\", y = \"level\" }\n[effects]\n";
  static constexpr const char* system_toml =
      "[system]\ndoc = \"a tank\"\n[states]\nx = { unit = \"V\" }\n[inputs]\nu = { unit = \"V\" }\nu_rate = { unit = \"V/s\" }\n"
      "swell_rate = { unit = \"V/s\" }\n[parameters]\nk = { unit = \"1/s\", value = 1 }\n"
      "[equations]\nx = \"-k*x + k*u + u_rate + swell_rate\"\n[outputs]\ny = { formula = \"x\", unit = \"V\" }\n";
};

TEST_F(HostileText, KnotsHaveTheUnitOfTheirQuantity) {
  const std::string curve = "[curves]\nc = { of = \"x\", knots = [0, \"500 mV\", \"1 V\"] }\n";
  read(study_toml + curve, system_toml);
  const std::string message =
      message_of<InputError>([&] { read(study_toml + std::string("[curves]\nc = { of = \"x\", knots = [0, \"1 s\"] }\n"), system_toml); });
  expect_parts(message, {"study.toml:8", "knots need [V], not [s]"});
}

class HostileStudyOfASystem : public HostileText {};
class HostileSystem : public HostileText {};

void expect_told(const std::string& message, const Hostile& hostile) {
  for (const char* part : hostile.expected) expect_parts(message, {part});
  const auto characters = std::count_if(message.begin(), message.end(), [](char c) { return (c & '\xC0') != '\x80'; });
  EXPECT_LE(characters, 300) << message.substr(0, 500);
  const auto control = std::find_if(message.begin(), message.end(), [](char c) { return c >= '\0' && c < ' '; });
  EXPECT_EQ(control, message.end()) << message;
}

TEST_P(HostileStudyOfASystem, IsRefusedAtItsPlace) {
  const std::string text = replaced(study_toml, GetParam().what, GetParam().by);
  expect_told(message_of<InputError>([&] { read(text, system_toml); }), GetParam());
}

TEST_P(HostileSystem, IsRefusedAtItsPlace) {
  const std::string text = replaced(system_toml, GetParam().what, GetParam().by);
  expect_told(message_of<InputError>([&] { read(study_toml, text); }), GetParam());
}

TEST_F(HostileText, TheTextsAreRightAsTheyStand) { EXPECT_NO_THROW(read(study_toml, system_toml)); }

TEST_F(HostileText, EveryColumnThatMayBeReadCanBeNamed) {
  const std::string columns = "columns = { t = \"t\", y = \"l\", u = \"u\", u_rate = \"v\", swell_rate = \"w\", swell = \"s\" }";
  EXPECT_NO_THROW(read(replaced(study_toml, "columns = { t = \"t\", y = \"level\" }", columns), system_toml));
}

/// A ladder that goes on with another system keeps the columns of its recordings.
TEST_F(HostileText, AColumnOfAnotherSystemOfTheProgramMayBeNamed) {
  const std::string by_kind = replaced(study_toml, "file = \"tank.toml\"", "kind = \"cascaded_tanks\"");
  EXPECT_NO_THROW(read(replaced(by_kind, "y = \"level\"", "alpha_T = \"level\", eta = \"level\""), system_toml));
  expect_parts(message_of<InputError>([&] { read(replaced(by_kind, "y = \"level\"", "alphaT = \"level\""), system_toml); }),
               {"study.toml:5:22", "columns.alphaT", "'cascaded_tanks'"});
}

std::string long_text() { return std::string(1'000'000, 'x'); }
std::string name_of(const testing::TestParamInfo<Hostile>& instance) { return instance.param.name; }

INSTANTIATE_TEST_SUITE_P(
    EachPlace, HostileStudyOfASystem,
    testing::Values(
        Hostile{"AColumnThatNothingReads", "y = \"level\"", "foo = \"t\"", {"study.toml:5:22", "columns.foo", "no such signal", "u_rate"}},
        Hostile{"AForceOfAnotherUnit",
                "[effects]\n",
                "[force]\nstrength = { value = \"1 N\", sigma = \"1 N\" }\n[effects]\n",
                {"study.toml:7", "[force] strength needs the unit", "(V/s)", "not [N]"}},
        Hostile{"AColumnMisspelt", "y = \"level\"", "u_rat = \"t\"", {"study.toml:5:22", "did you mean 'u_rate'"}},
        Hostile{"AStateThatIsNoOutput", "y = \"level\"", "x = \"level\"", {"study.toml:5:22", "columns.x", "valid: t, y, u"}},
        Hostile{"AColumnOfALongName", "y = \"level\"", long_text() + " = \"t\"", {"study.toml:5:22", "…", "valid: t, y"}},
        Hostile{"AColumnWithNul", "y = \"level\"", "\"y\\u0000\" = \"t\"", {"study.toml:5:22", "y\\x00", "'y'"}},
        Hostile{
            "AnEffectOfALongName", "[effects]\n", "[effects]\n" + long_text() + " = {}\n", {"study.toml:7", "unknown effect", "… and "}},
        Hostile{
            "AKindOfALongName", "[effects]\n", "[effects]\ne = { kind = \"" + long_text() + "\" }\n", {"study.toml:7", "unknown effect"}},
        Hostile{"AKindWithEscape", "[effects]\n", "[effects]\ne = { kind = \"\\u001b[2J\" }\n", {"study.toml:7", "'\\x1b[2J'"}},
        Hostile{"ASystemFileWithNul", "tank.toml", "tank.toml\\u0000", {"study.toml:2", "system.file", "NUL"}},
        Hostile{"ARateThatIsNoInput", "y = \"level\"", "y_rate = \"t\"", {"study.toml:5:22", "columns.y_rate"}}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    EachPlace, HostileSystem,
    testing::Values(
        Hostile{"NegativeRate", "doc = \"a tank\"", "fastest_rate = -1", {"tank.toml:2", "fastest_rate", "above 0"}},
        Hostile{"NegativeRateWithAUnit", "doc = \"a tank\"", "fastest_rate = \"-1 1/s\"", {"tank.toml:2", "fastest_rate", "above 0"}},
        Hostile{"RateOfZero", "doc = \"a tank\"", "fastest_rate = 0", {"tank.toml:2", "fastest_rate", "above 0"}},
        Hostile{"RateThatIsNoNumber", "doc = \"a tank\"", "fastest_rate = nan", {"tank.toml:2", "fastest_rate", "finite"}},
        Hostile{"UnitOfALongName", "unit = \"1/s\"", "unit = \"" + long_text() + "\"", {"tank.toml:10", "unknown unit", "…"}},
        Hostile{"UnitWithBell", "unit = \"1/s\"", "unit = \"1/s\\u0007\"", {"tank.toml:10", "\\x07"}},
        Hostile{"ALongNameInAFormula", "-k*x", "-" + std::string(3000, 'q') + "*x", {"tank.toml:12", "there is no 'qqq", "…"}},
        Hostile{"ALongFunctionInAFormula", "-k*x", "-" + std::string(3000, 'q') + "(x)", {"tank.toml:12", "there is no function 'qqq"}},
        Hostile{"AStateOfALongName",
                "x = { unit = \"V\" }",
                "x = { unit = \"V\" }\n" + long_text() + " = { unit = \"V\" }",
                {"tank.toml", "…"}},
        Hostile{"AKeyOfALongName", "value = 1", "value = 1, " + long_text() + " = 1", {"tank.toml:10", "unknown key", "…"}},
        Hostile{"ATableInTables",
                "value = 1",
                "value = " +
                    [] {
                      std::string s;
                      for (int i = 0; i < 10'000; ++i) s += "{ a = ";
                      return s;
                    }(),
                {"tank.toml:10", "at most 64"}}),
    name_of);

}  // namespace
}  // namespace misfit
