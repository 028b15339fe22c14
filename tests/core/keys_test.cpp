// Keys described once: read with defaults and limits, and printed as a reference.
#include "misfit/core/keys.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/core/temporary_folder.h"

namespace misfit::config {
namespace {

const std::vector<KeyGroup>& groups() {
  static const std::vector<KeyGroup> all{
      {"pump",
       "A pump.",
       {{.name = "force", .type = KeyType::number, .unit = "N", .fallback = "\"2 kN\"", .least = 0, .above = true, .meaning = "Force."},
        {.name = "angle",
         .type = KeyType::number,
         .unit = "rad",
         .otherwise = "none",
         .least = 0,
         .most = 0.5,
         .meaning = "Of the blades."},
        {.name = "kind", .type = KeyType::choice, .fallback = "\"gear\"", .choices = {"gear", "vane"}, .meaning = "Its kind."},
        {.name = "stages", .type = KeyType::integer, .fallback = "1", .least = 1, .most = 9, .meaning = "Count."},
        {.name = "gap", .type = KeyType::number, .unit = "m", .fallback = "0.1", .needs = {"vanes"}, .meaning = "Of a vane."},
        {.name = "vanes", .type = KeyType::texts, .otherwise = "none", .choices = {"a", "b"}, .meaning = "Their names."},
        {.name = "SENSOR", .type = KeyType::flag, .otherwise = "off", .any = true, .meaning = "On or off."}}},
      {"pipe", "Pipes.", {{.name = "file", .type = KeyType::file, .otherwise = "required", .meaning = "Its table."}}, true}};
  return all;
}

DescribedSection pump(const std::string& text) {
  return {*Section::parse("[pump]\n" + text, "p.toml").table("pump"), group_of(groups(), "pump")};
}

TEST(DescribedSection, GivesWhatIsWrittenElseTheDefault) {
  const DescribedSection written = pump("force = 3\nkind = \"vane\"\nstages = 2\n"), empty = pump("");
  EXPECT_EQ(written.value("force"), 3.0);
  EXPECT_EQ(empty.value("force"), 2000.0);
  EXPECT_EQ(empty.number("force")->unit, "N");
  EXPECT_EQ(written.choice("kind"), "vane");
  EXPECT_EQ(empty.choice("kind"), "gear");
  EXPECT_EQ(empty.integer("stages"), 1);
  EXPECT_FALSE(empty.value("angle").has_value());
  EXPECT_FALSE(empty.texts("vanes").has_value());
}

TEST(DescribedSection, RefusesWhatTheDescriptionForbids) {
  const auto error = [](const std::string& text, const auto& read) { return message_of<InputError>([&] { read(pump(text)); }); };
  const auto value = [](const char* key) { return [key](const DescribedSection& s) { (void)s.value(key); }; };
  expect_parts(error("force = 0\n", value("force")), {"p.toml:2", "pump.force", "above 0"});
  expect_parts(error("angle = \"40 deg\"\n", value("angle")), {"pump.angle", "0 to 28.647", "deg"});
  expect_parts(error("stages = 10\n", [](const auto& s) { (void)s.integer("stages"); }), {"pump.stages", "1 to 9"});
  expect_parts(error("kind = \"vain\"\n", [](const auto& s) { (void)s.choice("kind"); }), {"'vane'"});
  expect_parts(error("vanes = [\"a\", \"a\"]\n", [](const auto& s) { (void)s.texts("vanes"); }), {"given twice"});
  expect_parts(error("vanes = [\"c\"]\n", [](const auto& s) { (void)s.texts("vanes"); }), {"unknown name 'c'"});
}

TEST(DescribedSection, NamesKeysThatNobodyReadAndThoseWithoutWhatTheyNeed) {
  const auto finished = [](const std::string& text) {
    return message_of<InputError>([&] {
      const DescribedSection s = pump(text);
      (void)s.value("gap");
      (void)s.texts("vanes");
      s.finish();
    });
  };
  expect_parts(finished("forc = 1\n"), {"p.toml:2", "unknown key 'forc'", "did you mean 'force'?"});
  expect_parts(finished("gap = 1\n"), {"pump.gap", "no meaning without vanes"});
}

TEST(DescribedSection, AsksOnlyForDescribedKeys) {
  EXPECT_TRUE(group_of(groups(), "pump").key("anything").any);
  EXPECT_THROW((void)group_of(groups(), "pipe").key("lenght"), std::logic_error);
  EXPECT_THROW((void)group_of(groups(), "pumps"), std::logic_error);
}

TEST(KeysOfADocument, AreFoundByPathAndFilledWithDefaults) {
  EXPECT_EQ(find_key(groups(), {"pump", "force"})->unit, "N");
  EXPECT_TRUE(find_key(groups(), {"pump", "level"})->any);
  EXPECT_EQ(find_key(groups(), {"pipe", "3", "file"})->type, KeyType::file);
  EXPECT_EQ(find_key(groups(), {"pipe", "3", "fil"}), nullptr);
  EXPECT_EQ(find_key(groups(), {"hose", "file"}), nullptr);
  TomlDocument document("[pump]\nstages = 3\n");
  fill_defaults(groups(), document);
  EXPECT_EQ(document.text([](const auto&, const auto&) { return ""; }), "\n[pump]\nstages = 3\nforce = \"2 kN\"\nkind = \"gear\"\n");
}

TEST(KeyReference, HasEveryKeyWithTypeUnitLimitsDefaultAndMeaning) {
  const std::string text = key_reference(groups(), 60);
  expect_parts(text,
               {"[pump]\n  A pump.\n", "\n  force   number [N], above 0; default \"2 kN\"\n          Force.\n",
                "\n  angle   number [rad], 0 to 28.64788976 deg; default: none\n", "kind    \"gear\" or \"vane\"; default \"gear\"\n",
                "stages  whole number, 1 to 9; default 1\n", "\n  SENSOR  true or false; default: off\n", "[[pipe]]", "file; required"});
}

}  // namespace
}  // namespace misfit::config
