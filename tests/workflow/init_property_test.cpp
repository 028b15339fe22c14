// Whatever the header, the units, the file's name and the shape of the data: init refuses in words, or its study is read and its model
// built.
#include <fmt/format.h>
#include <misfit_models_registry.h>

#include <random>

#include "misfit/core/error.h"
#include "misfit/core/files.h"
#include "misfit/model/declared.h"
#include "misfit/model/experiment.h"
#include "misfit/model/limits.h"
#include "misfit/model/request.h"
#include "misfit/workflow/init/names.h"
#include "misfit/workflow/init/text.h"
#include "tests/apps/program.h"

namespace {

using namespace misfit;
using program::run;
namespace fs = std::filesystem;

const Registry& registry() {
  static const Registry all = [] {
    Registry r;
    misfit_models_register(r);
    return r;
  }();
  return all;
}

/// What init does without its figures, and what fit does before it fits.
void study_is_built(const fs::path& data, const fs::path& folder) {
  const RecordingSurvey survey = survey_recording(data, names_of_formulas());
  const GuessedModel model = guess_model(survey);
  const std::vector<std::string> names = part_names(data, survey.parts.size());
  for (std::size_t i = 0; i < names.size(); ++i) write_csv(folder / (names[i] + ".csv"), survey.parts[i], 12);
  write_atomically(folder / "model.toml", model_text(model, survey));
  write_atomically(folder / "study.toml", study_text(study_name(data), names, survey));
  try {
    const Study study = read_study(folder / "study.toml");
    const auto declared = study_registry(study, registry());
    const Model assembled = assemble(read_model(study, *declared).request, *declared);
    ASSERT_EQ(study.experiments.size(), names.size());
    for (const auto& experiment : study.experiments) {
      try {
        EXPECT_GT(signals_from(read_csv(*experiment.data), assembled, experiment).samples(), 0U);
      } catch (const RunError&) {  // a part without a measurement of something
      }
    }
  } catch (const InputError& error) {
    ADD_FAILURE() << "init wrote what fit refuses: " << error.what() << "\n" << program::content(folder / "model.toml").substr(0, 3000);
  }
}

class Draws {
 public:
  explicit Draws(unsigned seed) : random_(seed) {}
  std::size_t below(std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random_); }
  double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  bool one_in(std::size_t n) { return below(n) == 0; }
  template <class T>
  const T& of(const std::vector<T>& all) {
    return all[below(all.size())];
  }

  std::string name() {
    static const std::vector<std::string> odd{
        "max",    "min",         "exp",       "log",     "sin",    "if",        "pi",           "and",      "or",   "not",   "sign",
        "t",      "t2",          "y",         "y_rate",  "y_tau",  "rest",      "gain",         "u",        "u1",   "valve", "y_gain_u",
        "y_rest", "y_stiffness", "y_damping", "u_given", "1y",     "y y",       "\xC3\xBF",     "...",      "$(x)", "y'z",   "y\\",
        "y{",     "=cmd()",      "y#z",       "y~",      "<b>",    "__proto__", "time",         "y_rate_2", "e",    "nan",   "inf",
        "true",   "segment",     "dx/dt",     "y[",      "column", "x",         "\xE8\xAF\x95", "y\x07z"};
    if (one_in(12)) return std::string(1 + below(3000), static_cast<char>('a' + below(3)));
    if (one_in(8)) {
      std::string bytes;
      for (std::size_t k = 0, n = 1 + below(12); k < n; ++k) {
        const char c = static_cast<char>(1 + below(255));
        if (std::string("\n\r\",;\t ").find(c) == std::string::npos) bytes += c;
      }
      return bytes.empty() ? "b" : bytes;
    }
    return of(odd);
  }

  std::string unit() {
    static const std::vector<std::string> units{"[V]",    "[m/s^2]", "[deg]",    "[furlong]", "",       "[]",    "[%]",   "[kN]",
                                                "[V^13]", "[m^0.5]", "[1/s]",    "[N m]",     "[Nm]",   "(kPa)", "[min]", "[deg/s]",
                                                "[mV]",   "[°C]",    "[10^3 V]", "[-]",       "[km/h]", "[V]]",  "_V",    "_deg_s"};
    return of(units);
  }

  std::string value(std::size_t kind, std::size_t k, double scale) {
    const double t = 0.1 * static_cast<double>(k);
    switch (kind) {
      case 0:
        return fmt::format("{:.6g}", scale * std::sin(2.0 * t));
      case 1:
        return fmt::format("{:.6g}", scale * static_cast<double>(k / 7 % 2));
      case 2:
        return fmt::format("{:.6g}", scale * between(-1.0, 1.0));
      case 3:
        return fmt::format("{:.6g}", scale * std::cos(2.0 * t));
      case 4:
        return "1.5";
      case 5:
        return one_in(4) ? "" : fmt::format("{:.6g}", scale * (1.0 - std::exp(-t)));
      default:
        return fmt::format("{:.6g}", scale * std::exp(-0.3 * t) * std::cos(5.0 * t));
    }
  }

  std::string recording(std::size_t many = 38) {
    const std::size_t columns = one_in(8) ? many - below(many / 2) : 1 + below(std::min<std::size_t>(many, 6)), rows = 9 + below(90),
                      restart = one_in(5) ? 12 : 1000;
    std::string text = "t[s]";
    std::vector<std::size_t> kinds;
    std::vector<double> scales;
    for (std::size_t c = 0; c < columns; ++c) {
      text += "," + name() + (one_in(6) ? std::to_string(c) : "") + unit();
      kinds.push_back(below(7));
      scales.push_back(one_in(6) ? std::pow(10.0, between(-310.0, 307.0)) : std::pow(10.0, between(-12.0, 12.0)));
    }
    text += "\n";
    const double step = one_in(8) ? std::pow(10.0, between(-14.0, 12.0)) : 0.1;
    for (std::size_t k = 0; k < rows; ++k) {
      text += fmt::format("{:.9g}", step * static_cast<double>(k % restart));
      for (std::size_t c = 0; c < columns; ++c) text += "," + value(kinds[c], k, scales[c]);
      text += "\n";
    }
    return text;
  }

  std::string file() {
    static const std::vector<std::string> files{"x.csv",
                                                "a b.csv",
                                                "a'b.csv",
                                                "a\"b.csv",
                                                "a\\b.csv",
                                                "a\nb.csv",
                                                "\xC3\xA4.csv",
                                                "\xff.csv",
                                                ".csv",
                                                "..csv",
                                                "...csv",
                                                "-x.csv",
                                                "--.csv",
                                                "$(x).csv",
                                                "#.csv",
                                                "a{b.csv",
                                                "a\001b.csv",
                                                "a,b.csv",
                                                "%s.csv",
                                                "study.csv",
                                                "model.csv",
                                                "study.toml.csv",
                                                "x",
                                                std::string(200, 'x') + ".csv",
                                                std::string(100, 'y') + "\xE8\xAF\x95.csv",
                                                "a.b.csv"};
    return of(files);
  }

 private:
  std::mt19937 random_;
};

TEST(InitOfAnything, RefusesInWordsOrWritesAStudyWhoseModelIsBuilt) {
  constexpr unsigned count = 200;
  unsigned accepted = 0;
  for (unsigned seed = 0; seed < count; ++seed) {
    Draws draws(seed);
    const TemporaryFolder folder;
    const std::string text = draws.recording(), file = draws.file();
    SCOPED_TRACE("seed " + std::to_string(seed) + ": " + text.substr(0, 300));
    const fs::path data = folder.write(file, text);
    fs::create_directory(folder.path() / "study");
    try {
      study_is_built(data, folder.path() / "study");
      ++accepted;
    } catch (const InputError& error) {
      EXPECT_LT(std::string(error.what()).size(), 600U) << "one clear sentence";
    }
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(accepted, count / 2) << "most of them are recordings";
}

TEST(InitOfAnything, ThroughTheWholeProgram) {
  for (unsigned seed = 1000; seed < 1006; ++seed) {
    Draws draws(seed);
    const TemporaryFolder folder;
    const fs::path data = folder.write(draws.file(), draws.recording(3)), out = folder.path() / "study";
    const auto begun = run({"init", data.string(), "--out", out.string()});
    if (begun.status == 2) {
      EXPECT_FALSE(begun.err.empty());
      EXPECT_FALSE(fs::exists(out / "study.toml"));
      continue;
    }
    ASSERT_EQ(begun.status, 0) << begun.err;
    EXPECT_EQ(begun.out.find_first_of(std::string("\0\x07\x1b", 3)), std::string::npos);
    const auto fitted = run({"fit", out.string()});
    EXPECT_TRUE(fitted.status == 0 || fitted.status == 1) << "seed " << seed << ": " << fitted.err;
    EXPECT_FALSE((fitted.err + fitted.out).empty());
  }
}

std::string waves(std::size_t outputs, std::size_t inputs) {
  std::string text = "t[s]";
  for (std::size_t j = 0; j < inputs; ++j) text += fmt::format(",u{}[V]", j);
  for (std::size_t j = 0; j < outputs; ++j) text += fmt::format(",y{}[V]", j);
  text += "\n";
  for (std::size_t k = 0; k < 200; ++k) {
    const double t = 0.1 * static_cast<double>(k);
    text += fmt::format("{:.3f}", t);
    for (std::size_t j = 0; j < inputs; ++j) text += fmt::format(",{}", (k / 10 + j) % (j + 2));
    for (std::size_t j = 0; j < outputs; ++j) text += fmt::format(",{:.5f}", std::sin(t * (1.0 + 0.37 * static_cast<double>(j))));
    text += "\n";
  }
  return text;
}

TEST(InitOfManyColumns, KeepsTheFirstOnesWithinTheLimitsAndNamesTheOthers) {
  const TemporaryFolder folder;
  const fs::path data = folder.write("x.csv", waves(20, 10));
  const RecordingSurvey survey = survey_recording(data, names_of_formulas());
  const GuessedModel model = guess_model(survey);
  EXPECT_EQ(model.inputs.size(), static_cast<std::size_t>(most_guessed.inputs));
  EXPECT_EQ(model.inputs.front(), "u0");
  ASSERT_FALSE(model.outputs.empty());
  EXPECT_EQ(model.outputs.front().name, "y0");
  ASSERT_EQ(model.remarks.size(), 2U);
  expect_parts(model.remarks[0], {"not in the model: inputs u8, u9", "at most"});
  expect_parts(model.remarks[1], {"not in the model: outputs", "more", "parameters"});
  study_is_built(data, folder.path());
}

TEST(InitOfAnInput, ThatMovesNothingIsInNoEquationAndSaidToBe) {
  const TemporaryFolder folder;
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  std::string text = "t[s],u[V],valve[-],y[m]\n";
  double u = 0.0, y = 0.0;
  for (int k = 0; k < 1000; ++k) {
    if (k % 40 == 0) u = normal(random);
    text += fmt::format("{:.1f},{:.4f},{},{:.5f}\n", 0.1 * k, u, k / 70 % 3, y + 0.01 * normal(random));
    y += 0.05 * (u - y);
  }
  const GuessedModel model = guess_model(survey_recording(folder.write("x.csv", text), names_of_formulas()));
  ASSERT_EQ(model.remarks.size(), 1U);
  expect_parts(model.remarks[0], {"in no equation of the first model: valve", "--input", "input_gain"});
}

TEST(InitOfAnInput, ThatChangesInTheHeldOutPartAloneSaysSo) {
  const TemporaryFolder folder;
  std::string text = "t[s],u[V],y[m]\n";
  for (int k = 0; k < 200; ++k) text += fmt::format("{:.1f},{},{:.5f}\n", 0.1 * k, k < 160 ? 2 : 2 + k % 10, std::sin(0.13 * k));
  const GuessedModel model = guess_model(survey_recording(folder.write("x.csv", text), names_of_formulas()));
  ASSERT_EQ(model.inputs, std::vector<std::string>{"u"});
  ASSERT_EQ(model.remarks.size(), 1U);
  expect_parts(model.remarks[0], {"u changes in the last quarter alone", "hold out another part"});
}

struct RecordedUnits {
  std::string header, display;
};

/// Not where columns of one kind disagree, nor where they are SI or degrees.
TEST(InitOfUnits, ShowsResultsInThoseOfTheRecording) {
  for (const auto& [header, display] : std::vector<RecordedUnits>{{"t[s],u[kW],y[degC]", "units = [\"degC\", \"kW\"]"},
                                                                  {"t[s],u[V],y[rpm]", "angle = \"rad\""},
                                                                  {"t[s],u[V],y[rpm]", "units = [\"rpm\"]"},
                                                                  {"t[s],u[%],y[U/min]", "units = [\"%\", \"rpm\"]"},
                                                                  {"t[s],u[degC],y[K]", ""},
                                                                  {"t[s],u[V],y[deg]", ""},
                                                                  {"t[s],u[N],y[m]", ""}}) {
    const TemporaryFolder folder;
    std::string text = header + "\n";
    for (int k = 0; k < 200; ++k) text += fmt::format("{:.1f},{},{:.5f}\n", 0.1 * k, k / 7 % 5, 300.0 + std::sin(0.13 * k));
    const fs::path data = folder.write("x.csv", text);
    const RecordingSurvey survey = survey_recording(data, names_of_formulas());
    const std::string model = model_text(guess_model(survey), survey);
    EXPECT_EQ(model.find("[display]") != std::string::npos, !display.empty()) << model;
    EXPECT_NE(model.find(display), std::string::npos) << header << "\n" << model;
    study_is_built(data, folder.path());
  }
}

TEST(InitOfManyColumns, OfWhichAllFitHasAllAndNoRemark) {
  const TemporaryFolder folder;
  const GuessedModel model = guess_model(survey_recording(folder.write("x.csv", waves(4, 2)), names_of_formulas()));
  EXPECT_EQ(model.inputs.size(), 2U);
  EXPECT_EQ(model.outputs.size(), 4U);
  EXPECT_TRUE(model.remarks.empty());
}

TEST(InitOfExtremes, SaysThatTheyCannotBeComputedWith) {
  const TemporaryFolder folder;
  for (const char* scale : {"e300", "e-300"}) {
    std::string text = "t[s],y[V]\n";
    for (int k = 0; k < 50; ++k) text += fmt::format("{},{:.4f}{}\n", 0.1 * k, std::sin(k) + 2.0, scale);
    const fs::path data = folder.write("x.csv", text);
    expect_parts(message_of<InputError>([&] { static_cast<void>(guess_model(survey_recording(data, names_of_formulas()))); }),
                 {"x.csv", "'y[V]'", "another unit"});
  }
}

struct Called {
  const char* file;
  const char* part;
};

class DataCalled : public testing::TestWithParam<Called> {};

TEST_P(DataCalled, GivesItsPartsNamesThatExperimentsAndFilesCanHave) {
  const std::string name = part_names(GetParam().file, 1).front();
  if (GetParam().part != nullptr) {
    EXPECT_EQ(name, GetParam().part);
  }
  EXPECT_FALSE(name.empty());
  EXPECT_EQ(name.find_first_of("/\\\n"), std::string::npos);
  EXPECT_NE(name.front(), '.');
  EXPECT_NE(name.front(), '-');
  EXPECT_LE(name.size(), 100U);
  EXPECT_EQ(part_names(GetParam().file, 2), (std::vector<std::string>{name + "_1", name + "_2"}));
}

INSTANTIATE_TEST_SUITE_P(EachWay, DataCalled,
                         testing::Values(Called{"swing.csv", "swing"}, Called{"dir/a b.csv", "a b"}, Called{"ä.csv", "ä"},
                                         Called{".csv", "csv"}, Called{"..csv", "recording"}, Called{"-.csv", "recording"},
                                         Called{"-x.csv", "x"}, Called{"a\nb.csv", nullptr}, Called{"a\\b.csv", nullptr},
                                         Called{"\xff.csv", nullptr}, Called{"a\"b.csv", "a\"b"}),
                         [](const auto& i) { return std::to_string(i.index); });

}  // namespace
