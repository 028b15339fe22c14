#include "misfit/core/toml_outline.h"

#include <gtest/gtest.h>

#include "misfit/core/error.h"
#include "tests/core/temporary_folder.h"

namespace misfit {
namespace {

struct Placed {
  const char* text;
  const char* key;    ///< of the last value
  const char* value;  ///< as written
  const char* says;
};

class LastValue : public testing::TestWithParam<Placed> {};

TEST_P(LastValue, IsFoundWhereItStands) {
  const std::string text = GetParam().text;
  const TomlNode node = toml_outline(text).back();
  EXPECT_EQ(text.substr(node.key_begin, node.key_end - node.key_begin), GetParam().key);
  EXPECT_EQ(text.substr(node.begin, node.end - node.begin), GetParam().value);
  EXPECT_EQ(node.value, GetParam().says);
}

INSTANTIATE_TEST_SUITE_P(EachForm, LastValue,
                         testing::Values(Placed{"a = 'x'", "a", "'x'", "x"},
                                         Placed{"a = 1\r\n\"b c\" = \"\\u0064\" # é\r\n", "\"b c\"", "\"\\u0064\"", "d"},
                                         Placed{"\xEF\xBB\xBF"
                                                "a=1_0",
                                                "a", "1_0", "1_0"},
                                         Placed{"\"é\" = 'é'\nq = { 'ü' = 'é', x = 'ö' }", "x", "'ö'", "ö"},
                                         Placed{"a.b = \"\"\"\\\n  x\n\"\"\"\n", "b", "\"\"\"\\\n  x\n\"\"\"", "x\n"},
                                         Placed{"[a]\nb = [ 1, # ]\n 'y' ]", "", "'y'", "y"},
                                         Placed{"[[a]]\n[[ a ]]\n\tt = nan", "t", "nan", "nan"},
                                         Placed{"d = 1979-05-27T07:32:00Z", "d", "1979-05-27T07:32:00Z", "1979-05-27T07:32:00Z"}),
                         [](const auto& i) { return std::to_string(i.index); });

TEST(TomlOutline, GivesParentsBeforeWhatTheyHold) {
  std::vector<std::vector<std::string>> paths;
  for (const TomlNode& node : toml_outline("[[e]]\nx = { y = [ {}, 2 ] }\n[[e]]\n")) paths.push_back(node.path);
  EXPECT_EQ(
      paths,
      (std::vector<std::vector<std::string>>{
          {"e"}, {"e", "0"}, {"e", "0", "x"}, {"e", "0", "x", "y"}, {"e", "0", "x", "y", "0"}, {"e", "0", "x", "y", "1"}, {"e", "1"}}));
}

TEST(TomlOutline, RefusesWhatIsNoToml) {
  expect_parts(message_of<InputError>([] { static_cast<void>(toml_outline("a = 1\nb = \n")); }), {":2", "not valid TOML"});
}

}  // namespace
}  // namespace misfit
