#include "misfit/core/toml_depth.h"

#include "misfit/core/config.h"
#include "misfit/core/error.h"
#include "tests/core/temporary_folder.h"

namespace misfit::config {
namespace {

std::string repeated(const std::string& text, int times) {
  std::string out;
  for (int i = 0; i < times; ++i) out += text;
  return out;
}

struct Text {
  const char* name;
  std::string text;
  const char* place;  ///< of the message; nullptr: it passes
};

void PrintTo(const Text& text, std::ostream* out) { *out << text.name; }

class TomlDepth : public testing::TestWithParam<Text> {};

TEST_P(TomlDepth, IsLimitedBeforeTheTextIsParsed) {
  const auto& [name, text, place] = GetParam();
  if (place == nullptr) {
    EXPECT_NO_THROW(check_toml_depth(text, "s.toml"));
    return;
  }
  expect_parts(message_of<InputError>([&] { check_toml_depth(text, "s.toml"); }), {place, "at most 64"});
  expect_parts(message_of<InputError>([&] { (void)Section::parse(text, "s.toml"); }), {place, "at most 64"});
}

INSTANTIATE_TEST_SUITE_P(
    EachForm, TomlDepth,
    testing::Values(Text{"DottedKey", repeated("a.", 100'000) + "a = 1\n", "s.toml:1:"},
                    Text{"DottedKeyOnALaterLine", "b = 1\n\n" + repeated("a.", 100'000) + "a = 1\n", "s.toml:3:"},
                    Text{"DottedKeyOfQuotedParts", repeated("\"a\".", 100'000) + "a = 1\n", "s.toml:1:"},
                    Text{"DottedKeyOfLiteralParts", repeated("'a'.", 100'000) + "a = 1\n", "s.toml:1:"},
                    Text{"DottedKeyWithBlanks", repeated("a . ", 100'000) + "a = 1\n", "s.toml:1:"},
                    Text{"Header", "[" + repeated("a.", 100'000) + "a]\nb = 1\n", "s.toml:1:"},
                    Text{"HeaderOfAnArray", "[[" + repeated("a.", 100'000) + "a]]\nb = 1\n", "s.toml:1:"},
                    Text{"Arrays", "a = " + repeated("[", 100'000) + repeated("]", 100'000) + "\n", "s.toml:1:"},
                    Text{"ArraysNeverClosed", "a = " + repeated("[", 100'000), "s.toml:1:"},
                    Text{"ArraysOverManyLines", "a = " + repeated("[\n", 100'000), "s.toml:65:"},
                    Text{"InlineTables", "a = " + repeated("{ a = ", 100'000) + "1" + repeated("}", 100'000) + "\n", "s.toml:1:"},
                    Text{"InlineTablesOfDottedKeys", "a = " + repeated("{ a.a.a = ", 10'000) + "1" + repeated("}", 10'000) + "\n",
                         "s.toml:1:"},
                    Text{"ArraysInTablesInArrays", "a = " + repeated("[{ a = ", 50'000) + "1" + repeated("}]", 50'000) + "\n", "s.toml:1:"},
                    Text{"DottedKeyInAnInlineTable", "a = { b = 1, " + repeated("a.", 100'000) + "a = 1 }\n", "s.toml:1:"},
                    Text{"DottedKeyAfterACloseAndAComment", "a = [1, # ]]]\n2]\n" + repeated("b.", 100'000) + "b = 1\n", "s.toml:3:"},
                    Text{"SixtyFiveArrays", "a = " + repeated("[", 65) + repeated("]", 65) + "\n", "s.toml:1:"},
                    Text{"SixtyArrays", "a = " + repeated("[", 60) + repeated("]", 60) + "\n", nullptr},
                    Text{"SixtyParts", repeated("a.", 59) + "a = 1\n", nullptr},
                    Text{"ManyNumbersWithPoints", "a = [" + repeated("1.5, ", 10'000) + "1.5]\n", nullptr},
                    Text{"ManyShortKeys", repeated("a.b = 1\n", 10'000), nullptr},
                    Text{"ManyTables", repeated("[a.b.c]\nd = [[1], [2]]\n", 10'000), nullptr},
                    Text{"BracketsInAText", "a = \"" + repeated("[{.", 1000) + "\"\n", nullptr},
                    Text{"BracketsInALiteral", "a = '" + repeated("[{.", 1000) + "\\'\n", nullptr},
                    Text{"BracketsAfterAnEscapedQuote", "a = \"\\\"" + repeated("[", 1000) + "\"\n", nullptr},
                    Text{"BracketsInALongText", "a = \"\"\"\n" + repeated("[a.b \"x\"\n", 1000) + "\"\"\"\"\"\n", nullptr},
                    Text{"BracketsInALongLiteral", "a = '''\n" + repeated("[a.b ''\n", 1000) + "'''\n", nullptr},
                    Text{"BracketsInAComment", "# " + repeated("[{.", 1000) + "\na = 1\n", nullptr}, Text{"Empty", "", nullptr},
                    Text{"OnlyClosing", repeated("]", 100'000), nullptr}, Text{"TextNeverClosed", "a = \"" + repeated("[", 1000), nullptr},
                    Text{"EndsInAnEscape", "a = \"\\", nullptr}),
    [](const auto& instance) { return instance.param.name; });

TEST(ContentOf, RefusesDeepTextAsWell) { EXPECT_THROW((void)content_of(repeated("a.", 100'000) + "a = 1\n"), InputError); }

}  // namespace
}  // namespace misfit::config
