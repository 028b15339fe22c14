#include "misfit/data/study.h"

#include <gtest/gtest.h>

#include <numbers>

#include "misfit/data/bin_size.h"
#include "misfit/data/study_keys.h"
#include "tests/data/study_folder.h"

namespace misfit {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

/// A study with every section. "[study]" is line 2.
constexpr const char* whole = R"(
[study]
name = "Parachute"
question = "What is missing?"
methods = ["sliding_bin", "output_error"]
seed = 7
[system]
kind = "parachute_planar"
induced_angle = false
step = "20 ms"
order = 4
[geometry]
D = "24 in"
R = { value = 1.2, sigma = 0.05 }
[camera]
sweep = "static_sweep.csv"
model = "plane_by_plane"
offer = ["camera_roll"]
free = ["image_centre"]
[[experiment]]
name = "flight"
track = "track.csv"
columns = { t = "t_s", P_y = "col[px]" }
validation = "last 25 %"
exclude = 5
[[experiment]]
data = "other.csv"
validation = [1, "2 min"]
[video]
fields = "top_first"
marker = "ring"
[effects]
gravity = {}
[effects.bearing]
kind = "coulomb_friction"
rate = "omega"
port = "moment_y"
[parameters]
m_a = { free = true, value = "0.1 kg", bounds = [0, 1], sigma = 0.1 }
[curves]
C_m = { of = "alpha_T", knots = [0, 5, 12.5], roughness = 1e-3 }
C_mq = { of = "alpha_T", knots = "auto", roughness = "auto" }
[reference]
C_m = "static_test.csv"
[uncertainty]
runs = 1000
perturb = { R = "0.1524 m", K = "1.969 px/m", x = 0.1 }
[sliding_bin]
width = "1.5 deg"
step = "0.1 deg"
)";

TEST_F(StudyFolder, AWholeStudyGivesHeadAndSystem) {
  const Study study = read(whole);
  EXPECT_EQ(study.name, "Parachute");
  EXPECT_EQ(study.question, "What is missing?");
  EXPECT_EQ(study.methods, (std::vector<std::string>{"sliding_bin", "output_error"}));
  EXPECT_EQ(study.seed, 7UL);
  EXPECT_EQ(study.system_kind, "parachute_planar");
  EXPECT_FALSE(study.system_flags.at("induced_angle"));
  EXPECT_DOUBLE_EQ(study.system_numbers.at("step").value, 0.02);
  EXPECT_EQ(study.system_numbers.at("step").unit, "ms");
  EXPECT_EQ(study.system_numbers.at("order").unit, "");
  EXPECT_EQ(study.system_where.at("induced_angle").line, 9);
}

TEST_F(StudyFolder, AWholeStudyGivesGeometryAndCamera) {
  const Study study = read(whole);
  EXPECT_DOUBLE_EQ(study.geometry->number("D", "m")->value, 0.6096);
  EXPECT_EQ(study.geometry->number("R", "m", true)->sigma, 0.05);
  EXPECT_TRUE(study.has_camera);
  EXPECT_EQ(study.camera.sweep->filename(), "static_sweep.csv");
  EXPECT_EQ(study.camera.model, "plane_by_plane");
  EXPECT_EQ(study.camera.offer, (std::vector<std::string>{"camera_roll"}));
  EXPECT_EQ(study.camera.free, (std::vector<std::string>{"image_centre"}));
}

TEST_F(StudyFolder, AWholeStudyGivesExperiments) {
  const Study study = read(whole);
  ASSERT_EQ(study.experiments.size(), 2U);
  EXPECT_EQ(study.experiments[0].name, "flight");
  EXPECT_EQ(study.experiments[0].columns.header("P_y"), "col[px]");
  EXPECT_EQ(study.experiments[0].columns.header("P_z"), "P_z");
  EXPECT_EQ(study.experiments[0].validation, ExperimentStudy::Validation::last_fraction);
  EXPECT_DOUBLE_EQ(study.experiments[0].fraction, 0.25);
  EXPECT_EQ(study.experiments[0].exclude, 5);
  EXPECT_EQ(study.experiments[1].name, "other");
  EXPECT_EQ(study.experiments[1].validation, ExperimentStudy::Validation::interval);
  EXPECT_EQ(study.experiments[1].to, 120.0);
}

TEST_F(StudyFolder, AWholeStudyGivesEffectsParametersAndCurves) {
  const Study study = read(whole);
  ASSERT_EQ(study.effects.size(), 2U);
  EXPECT_EQ(study.effects[0].kind, "gravity");
  EXPECT_EQ(study.effects[1].name, "bearing");
  EXPECT_EQ(study.effects[1].kind, "coulomb_friction");
  EXPECT_EQ(study.effects[1].roles.at("rate"), "omega");
  EXPECT_EQ(study.effects[1].roles.at("port"), "moment_y");
  EXPECT_EQ(study.parameters.at("m_a").free, true);
  EXPECT_DOUBLE_EQ(study.parameters.at("m_a").section->number("value", "kg")->value, 0.1);
  std::vector<double> knots;
  for (const config::Number& knot : *study.curves.at("C_m").knots) knots.push_back(knot.value);
  EXPECT_EQ(knots, (std::vector<double>{0.0, 5.0, 12.5}));
  EXPECT_EQ(study.curves.at("C_m").roughness, 1e-3);
  EXPECT_FALSE(study.curves.at("C_mq").knots.has_value() || study.curves.at("C_mq").roughness.has_value());
  EXPECT_EQ(study.reference.at("C_m").filename(), "static_test.csv");
  EXPECT_DOUBLE_EQ(study.bin_width, 1.5 * degree);
  EXPECT_DOUBLE_EQ(study.bin_step, 0.1 * degree);
  EXPECT_EQ(study.text, read_study(folder_.path()).text);
}

TEST_F(StudyFolder, WhatIsLeftOutHasTheDefaultsOfTheContract) {
  const Study study = read_with("");
  EXPECT_EQ(study.name, folder_.path().filename());
  EXPECT_EQ(study.methods, (std::vector<std::string>{"sliding_bin", "equation_error", "output_error"}));
  EXPECT_EQ(study.seed, 1UL);
  EXPECT_FALSE(study.has_camera || study.geometry.has_value());
  EXPECT_TRUE(study.experiments.empty() && study.effects.empty());
  EXPECT_EQ(study.bin_width, 0.0);
  EXPECT_EQ(read_with("[camera]\nsweep = \"static_sweep.csv\"\n").camera.offer.size(), 5U);
  EXPECT_TRUE(read_with("[camera]\nsweep = \"static_sweep.csv\"\noffer = []\n").camera.offer.empty());
  EXPECT_EQ(read_with("[camera]\nsweep = \"static_sweep.csv\"\n").camera.model, "pinhole");
}

/// What `misfit help study` and resolved.toml say is made of the structs that hold what was read.
TEST_F(StudyFolder, DefaultsOfKeysAreThoseOfTheStructs) {
  const auto fallback = [](const char* group, const char* key) { return config::group_of(study_keys(), group).key(key).fallback; };
  EXPECT_EQ(fallback("sliding_bin", "width"), "\"1.5 deg\"");
  EXPECT_EQ(fallback("sliding_bin", "step"), "\"0.1 deg\"");
  EXPECT_EQ(fallback("study", "seed"), "1");
  EXPECT_EQ(fallback("experiment", "exclude"), "0");
  EXPECT_EQ(fallback("video", "check_fields"), "true");
  EXPECT_EQ(fallback("noise.NAME", "fixed"), "true");
  EXPECT_EQ(fallback("uncertainty.distribution", "NAME"), "\"3 sigma\"");
  const Study study = read_with("[sliding_bin]\n");
  EXPECT_DOUBLE_EQ(study.bin_width, BinSize{}.width);
  EXPECT_DOUBLE_EQ(study.bin_step, BinSize{}.step);
}

TEST_F(StudyFolder, AMissingOrBrokenStudyNamesThePlace) {
  expect_parts(message_of<InputError>([&] { (void)read_study(folder_.path()); }), {"study.toml: no such file"});
  expect_parts(error_of("[system]\nkind = \n"), {"study.toml:2:", "not valid TOML"});
}

TEST_F(StudyFolder, AParameterOfAnEffectNeedsNoQuotes) {
  for (const std::string name : {"bearing.friction", "\"bearing.friction\"", "bearing . \"friction\""}) {
    const Study study = read("[system]\nkind = \"x\"\n[parameters]\n" + name + " = { value = \"3 N m\", free = false }\n");
    ASSERT_TRUE(study.parameters.contains("bearing.friction")) << name;
    EXPECT_EQ(study.parameters.at("bearing.friction").free, false);
    EXPECT_DOUBLE_EQ(study.parameters.at("bearing.friction").section->number("value", "N m")->value, 3.0);
  }
  expect_parts(error_with("[parameters]\nbearing.friction = { valeu = 3 }\n"),
               {"study.toml:4", "parameters.bearing.friction.valeu", "'value'"});
  expect_parts(error_with("[parameters]\nbearing = { value = 3, friction = { value = 3 } }\n"), {"study.toml:4", "'value'"});
}

TEST_F(StudyFolder, AParameterOfAnEffectWithQuotesAndWithoutIsRefused) {
  expect_parts(error_with("[parameters]\n\"bearing.friction\" = { value = 3 }\nbearing.friction.free = false\n"),
               {"study.toml:", "bearing.friction is there twice"});
}

TEST_F(StudyFolder, AnUnknownSectionOrKeyNamesTheNearest) {
  expect_parts(error_with("[geometri]\nD = 1\n"), {"study.toml:3:2", "[geometri]", "did you mean 'geometry'", "reference"});
  expect_parts(error_with("[study]\nsede = 1\n"), {"study.toml:4:1", "'sede' in [study]", "did you mean 'seed'"});
  expect_parts(error_with("[camera]\nsweap = \"static_sweep.csv\"\n"), {"study.toml:4:1", "'sweap'", "'sweep'"});
  expect_parts(error_with("[[experiment]]\ntrack = \"track.csv\"\nexlude = 1\n"),
               {"study.toml:5:1", "'exlude'", "'exclude'", "validation"});
  expect_parts(error_with("[curves]\nC_m = { of = \"alpha_T\", knot = \"auto\" }\n"),
               {"study.toml:4", "'knot' in [curves.C_m]", "'knots'"});
  expect_parts(error_with("[parameters]\nm = { fre = true }\n"), {"study.toml:4", "parameters.m.fre", "'free'"});
  expect_parts(error_with("[sliding_bin]\nwidht = \"1 deg\"\n"), {"study.toml:4:1", "'widht'", "'width'"});
  expect_parts(error_with("[uncertainty]\nrun = 1\n"), {"study.toml:4:1", "'run'", "'runs'"});
  expect_parts(error_with("[video]\nfeilds = \"auto\"\n"), {"study.toml:4:1", "'feilds'", "'fields'"});
}

TEST_F(StudyFolder, TheSystemIsOneKindOrOneFile) {
  EXPECT_EQ(read("[system]\nfile = \"model.toml\"\n").system_file->filename(), "model.toml");
  expect_parts(error_of("[study]\nseed = 1\n"), {"study.toml", "[system] is missing"});
  expect_parts(error_of("[system]\ninduced_angle = true\n"), {"study.toml:1", "exactly one of kind and file"});
  expect_parts(error_of("[system]\nkind = \"x\"\nfile = \"model.toml\"\n"), {"exactly one of kind and file"});
  expect_parts(error_of("[system]\nfil = \"model.toml\"\n"), {"study.toml:2", "unknown key 'fil' in [system]", "did you mean 'file'"});
  expect_parts(error_with("order = [1]\n"), {"study.toml:3:1", "system.order"});
  expect_parts(error_with("step = \"20 mss\"\n"), {"study.toml:3", "system.step", "'mss'", "'ms'"});
  expect_parts(error_with("order = nan\n"), {"study.toml:3", "system.order"});
}

TEST_F(StudyFolder, AWrongMethodOrSeedIsRefused) {
  expect_parts(error_with("[study]\nmethods = [\"output_eror\"]\n"), {"study.toml:4", "study.methods", "did you mean 'output_error'"});
  expect_parts(error_with("[study]\nmethods = [\"output_error\", \"output_error\"]\n"), {"given twice"});
  expect_parts(error_with("[study]\nmethods = []\n"), {"study.toml:4", "at least one method"});
  expect_parts(error_with("[study]\nseed = -1\n"), {"study.toml:4", "study.seed = -1", "from 0"});
  EXPECT_EQ(read_with("[study]\nseed = 0\n").seed, 0UL);
}

TEST_F(StudyFolder, ACameraIsGivenOrCalibrated) {
  const Study study = read_with("[camera]\nh_c = { value = \"10 in\", sigma = 0.01 }\nK = \"100 px/m\"\ncamera_roll = \"3 deg\"\n");
  EXPECT_DOUBLE_EQ(study.camera.given.at("h_c").value, 0.254);
  EXPECT_EQ(study.camera.given.at("h_c").sigma, 0.01);
  EXPECT_DOUBLE_EQ(study.camera.given.at("camera_roll").value, 3.0 * degree);
  EXPECT_FALSE(study.camera.sweep.has_value());
  expect_parts(error_with("[camera]\nh_c = 0.2\n"), {"study.toml:3", "both h_c and K"});
  expect_parts(error_with("[camera]\nsweep = \"static_sweep.csv\"\nK = 100\n"), {"study.toml:5", "camera.K", "either calibrated"});
  expect_parts(error_with("[camera]\nh_c = 0.2\nK = 100\noffer = [\"lens_k1\"]\n"), {"study.toml:6", "without sweep"});
  expect_parts(error_with("[camera]\nh_c = \"24 kg\"\nK = 100\n"), {"study.toml:4:7", "camera.h_c", "'kg'", "'m'"});
  expect_parts(error_with("[camera]\nsweep = \"static_sweep.csv\"\nmodel = \"pin_hole\"\n"), {"study.toml:5", "did you mean 'pinhole'"});
  expect_parts(error_with("[camera]\nsweep = \"static_sweep.csv\"\noffer = [\"roll\"]\n"), {"camera.offer", "did you mean 'camera_roll'"});
}

TEST_F(StudyFolder, AFileThatIsMissingNamesLineAndNearest) {
  expect_parts(error_with("[camera]\nsweep = \"static_sweeps.csv\"\n"),
               {"study.toml:4:1", "no such file 'static_sweeps.csv'", "'static_sweep.csv'"});
  expect_parts(error_with("[[experiment]]\ntrack = \"trak.csv\"\n"), {"study.toml:4:1", "no such file 'trak.csv'", "'track.csv'"});
  expect_parts(error_with("[[experiment]]\nvideo = \"fligth.mkv\"\n"), {"study.toml:4:1", "'flight.mkv'"});
  expect_parts(error_with("[reference]\nC_m = \"static_tset.csv\"\n"), {"study.toml:4:1", "reference.C_m", "'static_test.csv'"});
  expect_parts(error_with("[[experiment]]\ndata = \"nowhere/x.csv\"\n"), {"study.toml:4:1", "no such file 'nowhere/x.csv'"});
  expect_parts(error_with("[[experiment]]\ndata = \".\"\n"), {"study.toml:4:1", "is no file"});
  expect_parts(error_with("[[experiment]]\ndata = \"\"\n"), {"study.toml:4:1", "no such file"});
}

TEST_F(StudyFolder, AnEffectIsATableOfTexts) {
  expect_parts(error_with("[effects]\ngravity = true\n"), {"study.toml:4:1", "effects.gravity", "gravity = {}"});
  expect_parts(error_with("[effects]\ngravity = { rate = 1 }\n"), {"study.toml:4", "effects.gravity.rate", "text"});
  expect_parts(error_with("[effects]\ngravity = { fixd = [\"m\"] }\n"),
               {"study.toml:4", "'fixd' in [effects.gravity]", "did you mean 'fixed'"});
  expect_parts(error_with("[effects]\ngravity = { strt = { m = 1 } }\n"), {"study.toml:4", "'strt'", "did you mean 'start'"});
}

TEST_F(StudyFolder, ACurveWithKnotsOrATableNeedsItsQuantityAndKnotsIncrease) {
  for (const char* curve : {"{ knots = [1, 2] }", "{ table = \"c.csv\" }", "{ of = \"\" }"})
    expect_parts(error_with(std::string("[curves]\nC_m = ") + curve + "\n"), {"study.toml:4", "curves.C_m.of"});
  for (const char* knots : {"[1]", "[1, 1]", "[2, 1]"}) {
    expect_parts(error_with(std::string("[curves]\nC_m = { of = \"alpha_T\", knots = ") + knots + " }\n"),
                 {"study.toml:4", "curves.C_m.knots"});
  }
  expect_parts(error_with("[curves]\nC_m = { of = \"alpha_T\", knots = \"atuo\" }\n"), {"study.toml:4", "'auto'"});
  expect_parts(error_with("[curves]\nC_m = { of = \"alpha_T\", roughness = -1 }\n"), {"study.toml:4", "curves.C_m.roughness"});
  expect_parts(error_with("[curves]\nC_m = { of = \"alpha_T\", roughness = inf }\n"), {"study.toml:4", "finite"});
}

TEST_F(StudyFolder, ABinInDegreesWithoutUnitIsNoticed) {
  expect_parts(error_with("[sliding_bin]\nwidth = 1.5\n"), {"study.toml:4", "sliding_bin.width", "30 deg"});
  expect_parts(error_with("[sliding_bin]\nstep = \"0 deg\"\n"), {"study.toml:4", "sliding_bin.step"});
  expect_parts(error_with("[sliding_bin]\nstep = \"1 m\"\n"), {"study.toml:4", "'m'", "'rad'"});
}

TEST_F(StudyFolder, TheVideoSectionIsChecked) {
  EXPECT_NO_THROW((void)read_with("[video]\nfields = \"auto\"\nmarker = \"template.png\"\n"));
  expect_parts(error_with("[video]\nfields = \"top\"\n"), {"study.toml:4", "did you mean 'top_first'"});
  expect_parts(error_with("[video]\nmarker = \"rng\"\n"), {"study.toml:4", "'ring'"});
  expect_parts(error_with("[video]\nmarker = \"templat.png\"\n"), {"study.toml:4", "'template.png'"});
}

TEST_F(StudyFolder, ThePerturbationsAreChecked) {
  expect_parts(error_with("[uncertainty]\nruns = 0\n"), {"study.toml:4", "uncertainty.runs", "from 1"});
  expect_parts(error_with("[uncertainty]\nperturb = { R = \"1 mx\" }\n"), {"study.toml:4", "uncertainty.perturb.R", "'mx'"});
  expect_parts(error_with("[uncertainty]\nperturb = { R = \"0 m\" }\n"), {"study.toml:4", "uncertainty.perturb.R", "above 0"});
  expect_parts(error_with("[uncertainty]\nperturb = { R = [1] }\n"), {"study.toml:4", "uncertainty.perturb.R", "a number is expected"});
  expect_parts(error_with("[uncertainty]\ndistribution = \"4 sigma\"\n"), {"study.toml:4", "'4 sigma'", "'3 sigma'"});
  expect_parts(error_with("[uncertainty]\nperturb = { R = 1 }\ndistribution = { S = \"sigma\" }\n"),
               {"study.toml:5", "'S' is not in perturb"});
  expect_parts(error_with("[uncertainty]\ncamera = \"given\"\n"), {"study.toml:4", "valid: calibration"});
}

TEST_F(StudyFolder, AKeyThatHadAnotherNameIsRefusedWithTheNewOne) {
  expect_parts(error_with("[uncertainty]\nreadings = \"sigma\"\n"),
               {"study.toml:4", "uncertainty.readings: this key is called distribution now"});
  expect_parts(error_with("[camera]\nsweep = \"static_sweep.csv\"\ntake_in = [\"camera_roll\"]\n"),
               {"study.toml:5", "camera.take_in: this key is called free now"});
}

TEST_F(StudyFolder, ThePerturbationsKeepTheirOrderUnitsAndDistributions) {
  const Study study = read_with("[uncertainty]\nperturb = { R = \"6 in\", K = 2, m_a = \"0.1 kg\" }\ndistribution = { K = \"uniform\" }\n");
  ASSERT_TRUE(study.uncertainty);
  const UncertaintyStudy& u = *study.uncertainty;
  EXPECT_EQ(u.runs, 1000);
  EXPECT_FALSE(u.calibrated_camera);
  ASSERT_EQ(u.perturb.size(), 3U);
  EXPECT_EQ(u.perturb[0].name, "R");
  EXPECT_NEAR(u.perturb[0].number.value, 0.1524, 1e-12);
  EXPECT_EQ(u.perturb[0].distribution, "3 sigma");
  EXPECT_EQ(u.perturb[1].number.unit, "");
  EXPECT_EQ(u.perturb[1].distribution, "uniform");
  EXPECT_EQ(u.perturb[2].name, "m_a");
  EXPECT_EQ(read_with("[uncertainty]\nperturb = { R = 1 }\ndistribution = \"sigma\"\n").uncertainty->perturb[0].distribution, "sigma");
  EXPECT_TRUE(read_with("[uncertainty]\ncamera = \"calibration\"\n").uncertainty->calibrated_camera);
  EXPECT_FALSE(read_with("").uncertainty);
}

}  // namespace
}  // namespace misfit
