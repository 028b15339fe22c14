// Studies that cannot be meant as written: exit status 2, and a message that leads to the place.

#include "tests/apps/program.h"

namespace {

using namespace program;

struct Mistake {
  const char* name;
  const char* pattern;  ///< in study.toml of validation …
  const char* by;       ///< … replaced by this
  std::vector<const char*> expected;
};

void PrintTo(const Mistake& mistake, std::ostream* out) { *out << mistake.name; }

class WrongStudy : public testing::TestWithParam<Mistake> {};

TEST_P(WrongStudy, IsRefusedAtItsPlaceAndLeavesNoResult) {
  const StudyCopy study("validation");
  study.change(GetParam().pattern, GetParam().by);
  const Outcome outcome = study.run();
  EXPECT_EQ(outcome.status, 2) << outcome.out;
  EXPECT_EQ(outcome.out, "");
  EXPECT_TRUE(std::regex_search(outcome.err, std::regex(R"(study\.toml:\d+:\d+: )"))) << outcome.err;
  for (const char* part : GetParam().expected) expect_parts(outcome.err, {part});
  EXPECT_FALSE(fs::exists(study.out("fit")));
}

INSTANTIATE_TEST_SUITE_P(
    EachMistake, WrongStudy,
    testing::Values(
        Mistake{"UnknownKey", "seed = 1", "sead = 1", {"'sead'", "[study]", "'seed'"}},
        Mistake{"UnknownSection", "\\[effects\\]", "[efects]", {"[efects]", "'effects'"}},
        Mistake{"UnknownSystem", "parachute_planar", "parachute_plane", {"'parachute_plane'", "'parachute_planar'"}},
        Mistake{"UnknownFlag", "induced_angle", "induced_angel", {"'induced_angel'", "'induced_angle'"}},
        Mistake{"UnknownGeometry", "R_cp = ", "R_pc = ", {"R_pc", "R_cp"}},
        Mistake{"UnknownEffect", "pitch_damping =", "pitch_dampng =", {"'pitch_dampng'", "'pitch_damping'"}},
        Mistake{"UnknownRole", "pitch_damping = \\{\\}", "pitch_damping = { rte = \"alpha_T_rate\" }", {"rte", "pitch_damping"}},
        Mistake{"UnknownParameter", "\\[curves\\]", "[parameters]\nR_cpp = { free = true }\n[curves]", {"'R_cpp'", "'R_cp'"}},
        Mistake{"UnknownKeyOfAParameter", "\\[curves\\]", "[parameters]\nR_cp = { fre = true }\n[curves]", {"'free'"}},
        Mistake{"UnknownCurve", "C_m_alphadot = \\{", "C_m_alfadot = {", {"'C_m_alfadot'", "'C_m_alphadot'"}},
        Mistake{"UnknownQuantity", "C_m = \\{ of = \"alpha_T\"", "C_m = { of = \"alphaT\"", {"'alphaT'", "'alpha_T'"}},
        Mistake{"UnknownMethod", "\"output_error\"", "\"output_eror\"", {"'output_eror'", "'output_error'"}},
        Mistake{"WrongUnit", "\"1.5816 m\"", "\"24 kg\"", {"geometry.D", "'24 kg'", "'m'"}},
        Mistake{"NoUnitThatExists", "\"1.5816 m\"", "\"24 furlong\"", {"geometry.D", "furlong"}},
        Mistake{"NegativeMass", "\"0.206 kg\"", "\"-0.206 kg\"", {"m = -0.206 kg", "bounds"}},
        Mistake{"NotANumber", "\"736 Pa\"", "nan", {"geometry.qbar"}},
        Mistake{"NegativeSigma", "\"0.294 kg\"", "{ value = 0.294, sigma = -1 }", {"m_a", "sigma"}},
        Mistake{
            "KnotsDoNotIncrease", "C_m = \\{ of = \"alpha_T\"", "C_m = { of = \"alpha_T\", knots = [8, 10, 9, 12]", {"curves.C_m.knots"}},
        Mistake{"OneKnot", "C_m = \\{ of = \"alpha_T\"", "C_m = { of = \"alpha_T\", knots = [8]", {"curves.C_m.knots"}},
        Mistake{"MissingData", "alpha_history", "alpha_histori", {"'alpha_histori.csv'", "'alpha_history.csv'"}},
        Mistake{"Syntax", "seed = 1", "seed = = 1", {"study.toml:6"}},
        Mistake{"ValidationBackwards", "columns =", "validation = [9, 3]\ncolumns =", {"validation"}},
        Mistake{"MissingReference", "figure5.csv", "figure6.csv", {"'figure6.csv'", "'figure5.csv'"}},
        Mistake{"MissingConstant", "qbar = \"736 Pa\"", "", {"qbar", "[Pa]"}}),
    [](const auto& instance) { return instance.param.name; });

TEST(WrongStudyAsAWhole, WithoutExperiments) {
  const StudyCopy study("validation");
  study.change(R"(\[\[experiment\]\]\nname.*\ndata.*\ncolumns.*\n)", "");
  const Outcome outcome = study.run();
  EXPECT_EQ(outcome.status, 2);
  expect_parts(outcome.err, {"study.toml", "[[experiment]]"});
}

TEST(WrongStudyAsAWhole, ATrackWithoutACamera) {
  const StudyCopy study("mpf_f111");
  study.start_from_track();
  study.change(R"(\[camera\]\nsweep.*\nmodel.*\n)", "");
  const Outcome outcome = study.run();
  EXPECT_EQ(outcome.status, 2);
  expect_parts(outcome.err, {"study.toml", "[camera]", "'flight'"});
}

TEST(WrongStudyAsAWhole, AFileThatIsNoText) {
  const StudyCopy study("validation");
  study.write("study.toml", std::string("\0\1\2\xff\xfe", 5));
  const Outcome outcome = study.run();
  EXPECT_EQ(outcome.status, 2);
  expect_parts(outcome.err, {"study.toml:1"});
}

TEST(WrongFolder, BelowARegularFileIsRefusedAndNothingIsLeft) {
  const StudyCopy study("validation");
  study.write("afile", "x");
  const auto before = std::distance(fs::directory_iterator(study.path("")), fs::directory_iterator());
  const Outcome outcome = study.run("run", {"--out", study.path("afile/out").string()});
  EXPECT_EQ(outcome.status, 2);
  expect_parts(outcome.err, {"afile/out", "Not a directory"});
  EXPECT_EQ(std::distance(fs::directory_iterator(study.path("")), fs::directory_iterator()), before);
  EXPECT_EQ(content(study.path("afile")), "x");
}

}  // namespace
