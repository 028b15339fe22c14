// Edits of studies, however TOML lets one write them.
#include <gtest/gtest.h>

#include "misfit/core/config.h"
#include "misfit/core/error.h"
#include "misfit/core/toml_outline.h"
#include "misfit/data/study_edit.h"
#include "tests/core/temporary_folder.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;

/// However a file's name is written, the rung's study names the same file.
class WayToNameAFile : public testing::TestWithParam<const char*> {};

std::vector<std::string> files_in(const std::string& text) {
  std::vector<std::string> out;
  for (const TomlNode& node : toml_outline(text)) {
    if (node.kind == TomlNode::Kind::text && node.value.ends_with(".csv") && node.path.back() != "name") out.push_back(node.value);
  }
  return out;
}

TEST_P(WayToNameAFile, LeadsThereFromAnotherFolder) {
  const TemporaryFolder folder;
  folder.write("d.csv", "x");
  folder.write("d\"q'\\#.csv", "x");
  Study study;
  study.folder = folder.path();
  study.text = GetParam();
  const std::string text = text_for_folder(study, folder.path() / "out/rungs/01_x");
  std::vector<std::string> expected = files_in(study.text);
  ASSERT_FALSE(expected.empty());
  for (auto& file : expected) file = "../../../" + file;
  EXPECT_EQ(files_in(text), expected) << text;
}

INSTANTIATE_TEST_SUITE_P(
    EachForm, WayToNameAFile,
    testing::Values("[[experiment]]\ndata = \"\\u0064.csv\"\n", "[[experiment]]\ndata = '''d.csv'''\n",
                    "[[experiment]]\ndata = \"\"\"\\\n    d.csv\"\"\"\nname = \"d.csv\"\n", "[[experiment]]\r\n\"data\" = 'd.csv' # x\r\n",
                    "experiment = [ { name = \"é\", data = \"d.csv\" }, { data = 'd.csv' } ]", "experiment.data = \"d.csv\"\n",
                    "[experiment]\ndata = \"d.csv\"\nvalidation = \"d.csv\"", "\xEF\xBB\xBF[[experiment]]\nname=\"试验\"\ndata=\"d.csv\"",
                    "[[experiment]]\ndata = \"d\\\"q'\\\\#.csv\"\n", "reference = { \"C m\" = \"d.csv\" } # é\n",
                    "[curves.C_m]\ntable = \"d.csv\"\n", "curves = { C_m = { of = \"d.csvx\", table = \"d.csv\" } }\n"),
    [](const auto& i) { return std::to_string(i.index); });

TEST(StudyPaths, LeadBackThroughALinkedFolder) {
  const TemporaryFolder folder;
  folder.write("d.csv", "x");
  fs::create_directories(folder.path() / "far/away/from/it");
  fs::create_directory_symlink(folder.path() / "far/away/from/it", folder.path() / "out");
  Study study;
  study.folder = folder.path();
  study.text = "[[experiment]]\ndata = \"d.csv\"\n";
  const std::string text = text_for_folder(study, folder.path() / "out/rungs/01_x");
  fs::create_directories(folder.path() / "out/rungs/01_x");
  const std::string file = toml_outline(text).back().value;
  EXPECT_TRUE(fs::exists(folder.path() / "out/rungs/01_x" / file)) << file;
}

TEST(StudyPaths, ThatAreNoUtf8AreRefusedWithTheStudysName) {
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "\xff");
  folder.write("\xff/d.csv", "x");
  Study study;
  study.folder = folder.path() / "\xff";
  study.file = study.folder / "study.toml";
  study.text = "[[experiment]]\ndata = \"d.csv\"\n";
  expect_parts(message_of<InputError>([&] { static_cast<void>(text_for_folder(study, folder.path() / "elsewhere")); }),
               {"study.toml", "'d.csv'", "UTF-8"});
  EXPECT_NE(text_for_folder(study, study.folder / "out").find("\"../d.csv\""), std::string::npos);
}

struct Form {
  const char* before;
  const char* after;  ///< with "b = {}" added
};

/// However [effects] is written: one line more, or one line changed, and nothing else.
class WayToWriteEffects : public testing::TestWithParam<Form> {};

TEST_P(WayToWriteEffects, TakesOneMore) { EXPECT_EQ(with_effect(GetParam().before, "b = {}"), GetParam().after); }

TEST_P(WayToWriteEffects, ReadsAsBeforeAndTheNewOne) {
  const std::string added = with_effect(GetParam().before, "b = { kind = \"k\" }");
  EXPECT_EQ(config::Section::parse(added, "x").table("effects")->table("b")->text("kind"), "k");
  EXPECT_EQ(config::content_of(added, {"effects"}), config::content_of(GetParam().before, {"effects"}));
}

TEST_P(WayToWriteEffects, GivesItBack) {
  const std::string added = with_effect(GetParam().before, "b = {}");
  const std::string again = without_entry(added, "effects", "b", "not\nwanted");
  EXPECT_EQ(config::content_of(again, {"effects"}), config::content_of(GetParam().before, {"effects"}));
  const auto effects = config::Section::parse(again, "x").table("effects");
  EXPECT_TRUE(!effects || !effects->has("b"));
  EXPECT_NE(again.find("# not wanted"), std::string::npos) << again;
}

INSTANTIATE_TEST_SUITE_P(
    EachForm, WayToWriteEffects,
    testing::Values(Form{"", "\n[effects]\nb = {}\n"}, Form{"effects = {}\n", "effects = { b = {} }\n"},
                    Form{"effects={ }# c\n", "effects={ b = {} }# c\n"}, Form{"effects = { a = {} }", "effects = { a = {}, b = {} }"},
                    Form{"effects = { a = { x = [\n1,\n2] } } # }\n[q]\n", "effects = { a = { x = [\n1,\n2] }, b = {} } # }\n[q]\n"},
                    Form{"effects = { a.kind = \"é}\" }\n", "effects = { a.kind = \"é}\", b = {} }\n"},
                    Form{"effects.a = {}\n[q]\n", "effects.a = {}\neffects.b = {}\n[q]\n"},
                    Form{"effects.a.kind = 'x' # c\nz = 1\n[q]\n", "effects.a.kind = 'x' # c\neffects.b = {}\nz = 1\n[q]\n"},
                    Form{"\"effects\".a = {}\n", "\"effects\".a = {}\neffects.b = {}\n"},
                    Form{"effects.a = {}\n[effects.c]\nx = 1\n", "effects.a = {}\neffects.b = {}\n[effects.c]\nx = 1\n"},
                    Form{"[effects]\n[q]\n", "[effects]\nb = {}\n[q]\n"},
                    Form{"[ 'effects' ] # ]\n[q]\n", "[ 'effects' ] # ]\nb = {}\n[q]\n"},
                    Form{"[effects]\r\na = {}\r\n\r\n[q]\r\n", "[effects]\r\na = {}\r\nb = {}\r\n\r\n[q]\r\n"},
                    Form{"[q]\r\nx = 1", "[q]\r\nx = 1\r\n\r\n[effects]\r\nb = {}\r\n"}, Form{"[effects]", "[effects]\nb = {}"},
                    Form{"[effects]\na.kind = \"x\"\na.port = \"\"\"\n[q]\n\"\"\"\n[q]\n",
                         "[effects]\na.kind = \"x\"\na.port = \"\"\"\n[q]\n\"\"\"\nb = {}\n[q]\n"},
                    Form{"[effects.a]\nx = 1\n[effects]\nc = {}\n[effects.d]\n",
                         "[effects.a]\nx = 1\n[effects]\nc = {}\nb = {}\n[effects.d]\n"},
                    Form{"[effects.a]\nx = 1\n", "[effects.a]\nx = 1\n\n[effects]\nb = {}\n"},
                    Form{"x = '''\n[effects]\n'''\n[effects]\na = {} # [effects]\n",
                         "x = '''\n[effects]\n'''\n[effects]\na = {} # [effects]\nb = {}\n"},
                    Form{"# [effects]\n[q]\ne = \"[effects]\"\n", "# [effects]\n[q]\ne = \"[effects]\"\n\n[effects]\nb = {}\n"},
                    Form{"[effects]\n\"<b>'x\\n\" = { kind = 'a' }\n", "[effects]\n\"<b>'x\\n\" = { kind = 'a' }\nb = {}\n"},
                    Form{"\xEF\xBB\xBF[effects]\na = {}\n", "\xEF\xBB\xBF[effects]\na = {}\nb = {}\n"}),
    [](const auto& i) { return std::to_string(i.index); });

TEST(StudyEffects, OfWhichOneIsThereAlreadyAreNotWrittenOver) {
  EXPECT_THROW(static_cast<void>(with_effect("[effects]\nb = { kind = 'x' }\n", "b = {}")), InputError);
}

TEST(StudyEntry, BetweenBracesLeavesTheOthers) {
  EXPECT_EQ(without_entry("effects = { a = {}, b = { k = 1 }, c = {} }\n", "effects", "b", "w"),
            "# b = { k = 1 }  # w\neffects = { a = {}, c = {} }\n");
  EXPECT_EQ(without_entry("effects = { a = {}, b = {} }", "effects", "a", "w"), "# a = {}  # w\neffects = { b = {} }");
  EXPECT_EQ(without_entry("system = { kind = \"k\", flag = true }", "system", "flag", "w"),
            "# flag = true  # w\nsystem = { kind = \"k\" }");
}

TEST(StudyEntry, OfSeveralDottedLinesOrHeadersGoesAsAWhole) {
  EXPECT_EQ(without_entry("[effects]\na.kind = 'x'\nb = {}\na.port = 'y'\n", "effects", "a", "w"),
            "[effects]\n# a.kind = 'x'  # w\nb = {}\n# a.port = 'y'\n");
  EXPECT_EQ(without_entry("[effects.a]\nx = 1\n\n[effects.b]\n[effects.a.parameters]\ny = 2\n", "effects", "a", "w"),
            "# [effects.a]  # w\n# x = 1\n\n[effects.b]\n# [effects.a.parameters]\n# y = 2\n");
}

TEST(StudyEntry, ThatCannotBeRenamedInOnePlaceIsRefused) {
  const std::string message =
      message_of<InputError>([] { static_cast<void>(with_renamed_entry("[curves]\na.of = 'x'\na.knots = [1]\n", "curves", "a", "b")); });
  expect_parts(message, {"[curves]", "one line each"});
  EXPECT_EQ(with_renamed_entry("curves = { 'a' = { of = 'a' } }", "curves", "a", "b c"), "curves = { \"b c\" = { of = 'a' } }");
  EXPECT_EQ(with_renamed_entry("[curves.a]\nof = 'a'\n", "curves", "a", "b"), "[curves.b]\nof = 'a'\n");
}

TEST(StudySystem, ChangesHoweverItIsWritten) {
  EXPECT_EQ(with_system("system = { kind = 'a', f = true }", "b"), "system = { kind = \"b\", f = true }");
  EXPECT_EQ(with_system("system.kind = \"\"\"a\"\"\" # k\n", "b"), "system.kind = \"b\" # k\n");
}

}  // namespace
}  // namespace misfit
