#include "misfit/data/study_edit.h"

#include <gtest/gtest.h>

#include "misfit/core/error.h"
#include "tests/core/temporary_folder.h"

namespace misfit {
namespace {

constexpr const char* example =
    "# a study, with [effects] in a comment\n"
    "[study]\nname = \"track\"\n"
    "[system]\n"
    "kind = \"parachute_planar\"   # the paper's\n"
    "induced_angle = true\n"
    "[effects]           # what is in it\n"
    "gravity = {}        # kept\n"
    "bearing = { formula = \"-c*x\", port = \"pitching_moment\", strengths = [\n"
    "  \"c\" ] }\n"
    "\n"
    "# about the curves\n"
    "[curves]\n"
    "C_m = { of = \"alpha_T\", knots = [\n  1, 2\n] }\n";

TEST(StudyEdit, AnEffectIsOneLineMoreAfterTheLastOne) {
  const std::string text = with_effect(example, "coning = {}");
  const std::string before = "  \"c\" ] }\n";
  const std::size_t at = text.find("coning = {}\n");
  ASSERT_NE(at, std::string::npos);
  EXPECT_EQ(text.substr(at - before.size(), before.size()), before);
  std::string without = text;
  without.erase(at, std::string("coning = {}\n").size());
  EXPECT_EQ(without, example);
}

TEST(StudyEdit, AnEffectGoesIntoAnEmptySectionAndIntoAStudyWithoutOne) {
  EXPECT_EQ(with_effect("[effects]\n[curves]\n", "a = {}"), "[effects]\na = {}\n[curves]\n");
  EXPECT_EQ(with_effect("[system]\nkind = \"x\"", "a = {}"), "[system]\nkind = \"x\"\n\n[effects]\na = {}\n");
  EXPECT_EQ(with_effect("[effects]\nb = {}", "a = {}"), "[effects]\nb = {}\na = {}");
}

TEST(StudyEdit, EffectsAsTablesOfTheirOwnKeepTheirEntries) {
  const std::string text = "[effects.bearing]\nkind = \"coulomb_friction\"\n";
  EXPECT_EQ(with_effect(text, "a = {}"), text + "\n[effects]\na = {}\n");
  EXPECT_EQ(with_effect("[effects]\nb = {}\n[effects.bearing]\nkind = \"k\"\n", "a = {}"),
            "[effects]\nb = {}\na = {}\n[effects.bearing]\nkind = \"k\"\n");
}

TEST(StudyEdit, TheLineOfAnEffectHoldsKindRolesAndStart) {
  EXPECT_EQ(effect_line("coning", "coning", {}), "coning = {}");
  EXPECT_EQ(effect_line("bearing", "coulomb_friction", {{"rate", "omega"}}), "bearing = { kind = \"coulomb_friction\", rate = \"omega\" }");
  EXPECT_EQ(effect_line("strut_wake", "strut_wake", {}, {{{"wake_phi", -1.5}}}), "strut_wake = { start = { wake_phi = -1.5 } }");
  EXPECT_EQ(effect_line("lag", "lag", {{"port", "dx2/dt"}}, {{{"lag.k", 1e-9}}}),
            "lag = { port = \"dx2/dt\", start = { \"lag.k\" = 1e-09 } }");
  EXPECT_EQ(effect_line("lag", "lag", {}, {{}, {"tau"}, {"k", "z"}}), "lag = { free = [\"tau\"], fixed = [\"k\", \"z\"] }");
}

TEST(StudyEdit, AnEntryBecomesACommentWithAReason) {
  const std::string text = without_entry(example, "effects", "bearing", "why not");
  EXPECT_NE(text.find("# bearing = { formula = \"-c*x\", port = \"pitching_moment\", strengths = [  # why not\n#   \"c\" ] }\n\n# about"),
            std::string::npos)
      << text;
  EXPECT_EQ(without_entry(example, "effects", "C_m", "other section"), example);
  EXPECT_EQ(without_entry("[effects.a]\nkind = \"k\"\n[curves]\n", "effects", "a", "w"), "# [effects.a]  # w\n# kind = \"k\"\n[curves]\n");
}

TEST(StudyEdit, AnEntryIsRenamedInItsSectionOnly) {
  const std::string text = with_renamed_entry(example, "curves", "C_m", "C_x");
  EXPECT_NE(text.find("[curves]\nC_x = { of"), std::string::npos);
  EXPECT_EQ(with_renamed_entry(example, "parameters", "C_m", "C_x"), example);
}

TEST(StudyEdit, TheSystemChangesInItsLine) {
  const std::string text = with_system(example, "parachute_spherical");
  EXPECT_NE(text.find("kind = \"parachute_spherical\"   # the paper's\ninduced_angle"), std::string::npos);
  EXPECT_THROW(static_cast<void>(with_system("[system]\nfile = \"a.toml\"\n", "b")), InputError);
}

TEST(StudyEdit, AValueChangesWhereItStands) {
  EXPECT_EQ(with_value("[a]\nb = 1  # one\nc = 2\n", {"a", "b"}, "3"), "[a]\nb = 3  # one\nc = 2\n");
  EXPECT_EQ(with_value("[a]\nb = { free = true, x = [1,\n 2] }\n", {"a", "b", "x"}, "\"auto\""),
            "[a]\nb = { free = true, x = \"auto\" }\n");
  EXPECT_EQ(with_value("[[e]]\nv = 1\n[[e]]\nv = 2\n", {"e", "1", "v"}, "[3, 4]"), "[[e]]\nv = 1\n[[e]]\nv = [3, 4]\n");
  EXPECT_EQ(with_value("a.b.c = 1\n", {"a", "b", "c"}, "2"), "a.b.c = 2\n");
}

TEST(StudyEdit, AValueThatWasNotThereGoesIntoTheInnermostTableThatIs) {
  EXPECT_EQ(with_value("[s]\nn = 1\n", {"p", "k", "free"}, "false"), "[s]\nn = 1\n\n[p]\nk.free = false\n");
  EXPECT_EQ(with_value("[p]  # all\n\n[s]\nn = 1\n", {"p", "k", "free"}, "false"), "[p]  # all\nk.free = false\n\n[s]\nn = 1\n");
  EXPECT_EQ(with_value("[p]\nk = { value = 2 }\n", {"p", "k", "free"}, "false"), "[p]\nk = { value = 2, free = false }\n");
  EXPECT_EQ(with_value("[p]\nk.value = 2\nm.value = 3\n", {"p", "k", "free"}, "false"), "[p]\nk.value = 2\nk.free = false\nm.value = 3\n");
  EXPECT_EQ(with_value("[p.k]\nvalue = 2\n\n[s]\nn = 1\n", {"p", "k", "free"}, "false"), "[p.k]\nvalue = 2\nfree = false\n\n[s]\nn = 1\n");
  EXPECT_EQ(with_value("[p.k]\nvalue = 2\n", {"p", "m", "free"}, "false"), "[p.k]\nvalue = 2\n\n[p]\nm.free = false\n");
  EXPECT_EQ(with_value("p.k.value = 2\n[s]\nn = 1\n", {"p", "k", "free"}, "false"), "p.k.value = 2\np.k.free = false\n[s]\nn = 1\n");
  EXPECT_EQ(with_value("[[e]]\nv = 1\n[[e]]\nv = 2\n", {"e", "0", "w"}, "3"), "[[e]]\nv = 1\nw = 3\n[[e]]\nv = 2\n");
  EXPECT_EQ(with_value("[p]\n\"lag.k\" = {}\n", {"p", "lag.k", "free"}, "true"), "[p]\n\"lag.k\" = { free = true }\n");
  EXPECT_EQ(with_value("[p]\r\na = 1\r\n", {"p", "b"}, "2"), "[p]\r\na = 1\r\nb = 2\r\n");
}

TEST(StudyEdit, WhatIsNoValueOrHasNoPlaceIsRefused) {
  for (const char* value : {"", "a b", "1\nseed = 2", "1 # one", "{", "1, b = 2"})
    EXPECT_THROW(static_cast<void>(with_value("[a]\nb = 1\n", {"a", "b"}, value)), InputError) << value;
  EXPECT_THROW(static_cast<void>(with_value("[a]\nb = 1\n", {"a"}, "1")), InputError);
  EXPECT_THROW(static_cast<void>(with_value("[a]\nb = 1\n", {"a", "b", "c"}, "1")), InputError) << "b is no table";
  EXPECT_THROW(static_cast<void>(with_value("[a.b]\nc = 1\n", {"a", "b"}, "1")), InputError) << "a section";
  EXPECT_THROW(static_cast<void>(with_value("[[e]]\nv = 1\n", {"e", "7", "v"}, "1")), InputError) << "there is one";
}

TEST(StudyEdit, FilesKeepTheirPlaceWhenTheStudyMoves) {
  const TemporaryFolder folder;
  folder.write("track.csv", "x");
  std::filesystem::create_directories(folder.path() / "deep");
  folder.write("deep/ref.csv", "x");
  Study study;
  study.folder = folder.path();
  study.text =
      "# \"track.csv\" stays in a comment\n[study]\nname = \"track.csv\"\n[[experiment]]\ntrack = \"track.csv\"  # here\n[reference]\nC_m "
      "= "
      "'deep/ref.csv'\nmissing = \"no.csv\"\n";
  EXPECT_EQ(text_for_folder(study, folder.path() / "out/rungs/01_coning"),
            "# \"track.csv\" stays in a comment\n[study]\nname = \"track.csv\"\n[[experiment]]\ntrack = \"../../../track.csv\"  # "
            "here\n[reference]\nC_m = \"../../../deep/ref.csv\"\nmissing = \"no.csv\"\n");
  study.folder = folder.path() / "deep";
  study.text = "[reference]\nC_m = \"ref.csv\"\nt = \"../track.csv\"\n";
  EXPECT_EQ(text_for_folder(study, folder.path()), "[reference]\nC_m = \"deep/ref.csv\"\nt = \"track.csv\"\n");
}

}  // namespace
}  // namespace misfit
