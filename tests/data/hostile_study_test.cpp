// Studies that are well-formed TOML and hostile all the same: refused at their place, in a message of readable length.

#include <gtest/gtest.h>

#include <algorithm>

#include "misfit/data/study.h"
#include "tests/data/study_folder.h"

namespace misfit {
namespace {

struct Hostile {
  const char* name;
  std::string text;  ///< begins on line 3 of the study
  std::vector<const char*> expected;
};

void PrintTo(const Hostile& hostile, std::ostream* out) { *out << hostile.name; }

class HostileStudy : public StudyFolder, public testing::WithParamInterface<Hostile> {};

TEST_P(HostileStudy, IsRefusedAtItsPlace) {
  const std::string message = error_with(GetParam().text);
  expect_parts(message, {"study.toml:"});
  for (const char* part : GetParam().expected) expect_parts(message, {part});
  const auto characters = std::count_if(message.begin(), message.end(), [](char c) { return (c & '\xC0') != '\x80'; });
  EXPECT_LE(characters, 300) << message.substr(0, 500);
  const auto control = std::find_if(message.begin(), message.end(), [](char c) { return c >= '\0' && c < ' '; });
  EXPECT_EQ(control, message.end()) << message;
}

std::string long_text() { return std::string(1'000'000, 'x'); }
std::string blanks() { return std::string(1'000'000, ' '); }

const std::string track = "[[experiment]]\ntrack = \"track.csv\"\n";
const std::string data = "[[experiment]]\ndata = \"other.csv\"\n";
const std::string simulate = "[simulate]\n";
constexpr const char* nul = "cannot hold the character NUL";

std::string name_of(const testing::TestParamInfo<Hostile>& instance) { return instance.param.name; }

INSTANTIATE_TEST_SUITE_P(
    NulInAFileName, HostileStudy,
    testing::Values(
        Hostile{"Data", "[[experiment]]\ndata = \"other.csv\\u0000\"\n", {"study.toml:4", "experiment[0].data", "other.csv\\x00", nul}},
        Hostile{"DataBeforeItsEnding", "[[experiment]]\ndata = \"other\\u0000.csv\"\n", {"study.toml:4", nul}},
        Hostile{"Track", "[[experiment]]\ntrack = \"track.csv\\u0000x\"\n", {"study.toml:4", "experiment[0].track", nul}},
        Hostile{"Video", "[[experiment]]\nvideo = \"flight.mkv\\u0000\"\n", {"study.toml:4", "experiment[0].video", nul}},
        Hostile{"Validation", track + "validation = \"other.csv\\u0000.csv\"\n", {"study.toml:5", "validation", nul}},
        Hostile{"Sweep", "[camera]\nsweep = \"static_sweep.csv\\u0000\"\n", {"study.toml:4", "camera.sweep", nul}},
        Hostile{"SweepImages", "[camera]\nsweep_images = \"static_sweep.csv\\u0000\"\n", {"study.toml:4", "camera.sweep_images", nul}},
        Hostile{"Marker", "[video]\nmarker = \"template.png\\u0000.png\"\n", {"study.toml:4", "video.marker", nul}},
        Hostile{"Reference", "[reference]\nC_m = \"static_test.csv\\u0000\"\n", {"study.toml:4", "reference.C_m", nul}},
        Hostile{"CurveTable", "[curves]\nC_m = { of = \"alpha_T\", table = \"static_test.csv\\u0000\" }\n", {"study.toml:4", nul}}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Simulate, HostileStudy,
    testing::Values(
        Hostile{"ADurationOfManySamples", simulate + "duration = 1e12\n", {"study.toml:4", "simulate.duration", "samples", "1e+07"}},
        Hostile{"ATinyStep", simulate + "step = 1e-12\n", {"study.toml:4", "simulate.step", "samples"}},
        Hostile{"Both", simulate + "duration = 1e300\nstep = 1e-300\n", {"study.toml:4", "simulate.duration", "samples"}},
        Hostile{"OneSampleTooMany", simulate + "duration = 1e7\nstep = 1\n", {"study.toml:4", "simulate.duration"}},
        Hostile{"NoStep", simulate + "step = 0\n", {"study.toml:4", "simulate.step", "above 0"}},
        Hostile{"NegativeNoise", simulate + "noise = { theta = -1 }\n", {"study.toml:4", "simulate.noise.theta", "-1", "below 0"}},
        Hostile{"NegativeNoiseWithAUnit", simulate + "noise = { theta = \"-1 deg\" }\n", {"simulate.noise.theta", "below 0"}},
        Hostile{"NoiseThatIsNoNumber", simulate + "noise = { theta = nan }\n", {"simulate.noise.theta"}},
        Hostile{"NoiseThatIsText", simulate + "noise = { theta = \"" + long_text() + "\" }\n", {"simulate.noise.theta", "…"}}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Columns, HostileStudy,
    testing::Values(
        Hostile{"OfATrackThatNothingReads", track + "columns = { P_x = \"t\" }\n", {"study.toml:5:13", "columns.P_x", "'P_y'", "sigma"}},
        Hostile{"OfATrackFarFromAnyName", track + "columns = { foo = \"t\" }\n", {"study.toml:5:13", "columns.foo", "P_y"}},
        Hostile{"WithALongName", track + "columns = { " + long_text() + " = \"t\" }\n", {"study.toml:5:13", "…", "P_y"}},
        Hostile{"WithAControlCharacter", track + "columns = { \"\\u001b[2J\" = \"t\" }\n", {"\\x1b[2J", "P_y"}},
        Hostile{"ThatAreNumbers", data + "columns = { t = 1 }\n", {"study.toml:5", "columns.t", "text"}}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    ExperimentName, HostileStudy,
    testing::Values(
        Hostile{"Long", track + "name = \"" + std::string(151, 'n') + "\"\n", {"study.toml:5", "experiment[0].name", "150 bytes"}},
        Hostile{"VeryLong", track + "name = \"" + long_text() + "\"\n", {"study.toml:5", "…", "150 bytes"}},
        Hostile{"WithNul", track + "name = \"a\\u0000b\"\n", {"study.toml:5", "'a\\x00b'", "control characters"}},
        Hostile{"WithNewline", track + "name = \"a\\nb\"\n", {"study.toml:5", "'a\\nb'", "control characters"}},
        Hostile{"WithTab", track + "name = \"a\\tb\"\n", {"study.toml:5", "control characters"}},
        Hostile{"WithC1", track + "name = \"a\\u009bb\"\n", {"study.toml:5", "'a\\x9bb'", "control characters"}},
        Hostile{"OfAFolder", track + "name = \"a/b\"\n", {"study.toml:5", "'a/b'"}},
        Hostile{"Hidden", track + "name = \".a\"\n", {"study.toml:5", "'.a'", "dot"}},
        Hostile{"Empty", track + "name = \"\"\n", {"study.toml:5", "''"}}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    LongTexts, HostileStudy,
    testing::Values(
        Hostile{"ValidationOfBlanks", track + "validation = \"" + blanks() + "\"\n", {"study.toml:5", "last 25 %"}},
        Hostile{"ValidationWithBlanksInside", track + "validation = \"last" + blanks() + "25 %\"\n", {"study.toml:5", "last 25 %"}},
        Hostile{"ValidationOfDigits", track + "validation = \"last " + std::string(1'000'000, '9') + " %\"\n", {"study.toml:5", "…"}},
        Hostile{"FileName", "[[experiment]]\ndata = \"" + long_text() + "\"\n", {"study.toml:4", "no such file", "…"}},
        Hostile{"FileNameOfManyFolders",
                "[[experiment]]\ndata = \"" +
                    [] {
                      std::string s;
                      for (int i = 0; i < 100'000; ++i) s += "a/";
                      return s;
                    }() +
                    "x\"\n",
                {"study.toml:4", "no such file"}},
        Hostile{"FileNameOfControlCharacters", "[[experiment]]\ndata = \"\\u001b[2J\\u0007\"\n", {"no such file", "\\x1b[2J\\x07"}},
        Hostile{"Method", "[study]\nmethods = [\"" + long_text() + "\"]\n", {"study.toml:4", "unknown name", "filter_error"}},
        Hostile{"MethodTwice", "[study]\nmethods = [\"output_error\", \"output_error\"]\n", {"study.toml:4", "twice"}},
        Hostile{"UnknownSection", "[" + long_text() + "]\n", {"study.toml:3", "unknown section", "…"}},
        Hostile{"UnknownKey", "[study]\n" + long_text() + " = 1\n", {"study.toml:4", "unknown key", "in [study]"}},
        Hostile{"Marker", "[video]\nmarker = \"" + long_text() + "\"\n", {"study.toml:4", "video.marker", "ring"}},
        Hostile{"CameraModel", "[camera]\nmodel = \"" + long_text() + "\"\n", {"study.toml:4", "pinhole"}},
        Hostile{"Unit", "[camera]\nh_c = \"1 " + long_text() + "\"\n", {"study.toml:4", "camera.h_c", "unknown unit"}},
        Hostile{"ExperimentNames",
                track + "name = \"" + std::string(150, 'n') + "\"\n" + track + "name = \"" + std::string(150, 'n') + "\"\n",
                {"study.toml:8", "two experiments are called"}},
        Hostile{"ParameterKey", "[parameters." + long_text() + "]\nfree = 1\nx = 2\n", {"study.toml:5", "unknown key"}},
        Hostile{"InitialKind", "[initial]\nx = { kind = \"" + long_text() + "\" }\n", {"study.toml:4", "free"}},
        Hostile{"NoiseOfZero", "[noise]\nx = 0\n", {"study.toml:4", "above 0"}},
        Hostile{"ForceTimeBelowZero", "[force]\ncorrelation_time = -1\n", {"study.toml:4", "at least 0"}},
        Hostile{"ForceStrengthOfZero", "[force]\nstrength = { value = 0, sigma = 1 }\n", {"study.toml:4", "above 0"}},
        Hostile{"ForceStrengthWithoutSigma", "[force]\nstrength = { value = 1 }\n", {"study.toml:4", "sigma", "is missing"}},
        Hostile{"ForceStrengthOfTwoUnits", "[force]\nstrength = { value = \"1 N\", sigma = \"1 m\" }\n", {"study.toml:4", "no unit of"}},
        Hostile{"ForceKey", "[force]\ncorrelation = 1\n", {"study.toml:4", "correlation_time"}},
        Hostile{"NoiseOfAMisspeltKey", "[noise]\nx = { valu = 1 }\n", {"study.toml:4", "unknown key 'valu'", "'value'"}},
        Hostile{"NoiseWithoutValue", "[noise]\nx = { fixed = true }\n", {"study.toml:4", "value", "is missing"}},
        Hostile{"NoiseFixedBesideAFrequency",
                "[noise]\nx = { fixed = true, frequency = \"0.1 Hz\" }\n",
                {"study.toml:4", "fixed", "beside a frequency"}},
        Hostile{"NoiseOfAFrequencyInSeconds", "[noise]\nx = { frequency = \"8 s\" }\n", {"study.toml:4", "frequency", "Hz"}},
        Hostile{"NoiseOfAnUnknownUnit", "[noise]\nx = \"1 " + long_text() + "\"\n", {"study.toml:4", "unknown unit"}}),
    name_of);

using LargeStudy = StudyFolder;

TEST_F(LargeStudy, TenMillionSamplesAreTheMost) {
  EXPECT_NO_THROW((void)read_with("[simulate]\nduration = 9999999\nstep = 1\n"));
  EXPECT_NO_THROW((void)read_with("[simulate]\nduration = 5e-324\nstep = 1e300\n"));
}

TEST_F(LargeStudy, NoiseOfZeroIsNone) { EXPECT_NO_THROW((void)read_with("[simulate]\nnoise = { theta = 0 }\n")); }

TEST_F(LargeStudy, EveryColumnOfATrackMayBeNamed) {
  const Study study = read_with(track + "columns = { t = \"a\", P_y = \"b\", P_z = \"c\", sigma = \"d\", ok = \"e\" }\n");
  EXPECT_EQ(study.experiments[0].columns.header("ok"), "e");
}

TEST_F(LargeStudy, AnExperimentNameMayHaveLettersOfAnyScript) {
  EXPECT_EQ(read_with(track + "name = \"Flug ä 试验 😀\"\n").experiments[0].name, "Flug ä 试验 😀");
  EXPECT_EQ(read_with(track + "name = \"" + std::string(150, 'n') + "\"\n").experiments[0].name.size(), 150U);
}

TEST_F(LargeStudy, APathThatIsTooLongIsRefused) {
  for (const std::size_t length : {300, 5000, 1'000'000}) EXPECT_THROW((void)read_study(std::string(length, 'x')), InputError) << length;
}

TEST_F(LargeStudy, TenThousandParametersAreRead) {
  std::string text = "[parameters]\n";
  for (int i = 0; i < 10'000; ++i) text += "p" + std::to_string(i) + " = { free = true }\n";
  EXPECT_EQ(read_with(text).parameters.size(), 10'000U);
}

}  // namespace
}  // namespace misfit
