// A TOML text completed and written again.
#include "misfit/core/toml_document.h"

#include <gtest/gtest.h>

#include "misfit/core/config.h"

namespace misfit {
namespace {

std::string written(const TomlDocument& document) {
  return document.text([](const TomlPath&, const std::string&) { return ""; });
}

TEST(TomlDocument, KeepsOrderAndValuesAndLosesComments) {
  const TomlDocument document("[b]\nx = 1e-3 # a comment\n\"odd key\" = 'a text'\n[a]\nlist = [\n 1,\n \"2 m\" ]\n");
  EXPECT_EQ(written(document), "\n[b]\nx = 1e-3\n\"odd key\" = \"a text\"\n\n[a]\nlist = [1, \"2 m\"]\n");
}

TEST(TomlDocument, WritesWhatItReadWhicheverWayTablesWereWritten) {
  for (const std::string text : {"[curves.C]\nof = \"x\"\n[curves.D]\nof = \"y\"\n[[e]]\nn = 1\n[[e]]\nn = 2\n[e.c]\nt = \"u\"\n",
                                 "curves = { C = { of = \"x\" }, D = { of = \"y\" } }\ne = [{ n = 1 }, { n = 2, c.t = \"u\" }]\n",
                                 "curves.C.of = \"x\"\ncurves.D.of = \"y\"\ne = [{ n = 1 }, { n = 2, c = { t = \"u\" } }]\n"}) {
    const TomlDocument document(text);
    EXPECT_EQ(config::content_of(written(document)), config::content_of(text)) << text << written(document);
    EXPECT_EQ(document.keys({"curves"}), (std::vector<std::string>{"C", "D"}));
    EXPECT_TRUE(document.is_array({"e"}));
    EXPECT_TRUE(document.is_table({"e", "1", "c"}));
  }
}

TEST(TomlDocument, SetsValuesMakesTablesAndReplacesAValueByATable) {
  TomlDocument document("[initial]\nx = \"shared\"\n[[e]]\nn = 1\n");
  document.set({"initial", "x", "kind"}, "\"shared\"");
  document.set({"initial", "x", "value"}, toml_number(0.1));
  document.set({"e", "0", "n"}, "2");
  document.set({"study", "list"}, toml_list({"1", "2"}));
  document.put_first("study");
  EXPECT_EQ(written(document), "\n[study]\nlist = [1, 2]\n\n[initial]\nx = { kind = \"shared\", value = 0.1 }\n\n[[e]]\nn = 2\n");
  EXPECT_EQ(document.value({"e", "0", "n"}), "2");
  EXPECT_FALSE(document.has({"e", "1"}));
}

TEST(TomlDocument, PutsCommentsBehindLines) {
  const TomlDocument document("[a]\nx = 1\ny = 2\n");
  EXPECT_EQ(document.text([](const TomlPath& path, const std::string& value) { return path.back() == "y" ? value + "\nm" : ""; }),
            "\n[a]\nx = 1\ny = 2  # 2 m\n");
}

}  // namespace
}  // namespace misfit
