#include "misfit/core/config.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/core/temporary_folder.h"

namespace misfit::config {
namespace {

Section parse(const std::string& text) { return Section::parse(text, "study.toml"); }

template <class Read>
std::string error_of(const std::string& text, Read read) {
  return message_of<InputError>([&] { read(parse(text)); });
}

TEST(Section, ASyntaxErrorNamesLineAndColumn) {
  expect_parts(error_of("a = 1\nb = = 2\n", [](const Section&) {}), {"study.toml:2:", "not valid TOML"});
  expect_parts(error_of("a = 1\na = 2\n", [](const Section&) {}), {"study.toml:2:", "'a'"});
  expect_parts(error_of("a = \"open\n", [](const Section&) {}), {"study.toml:1:"});
}

TEST(Section, LoadsAFileAndNamesAMissingOne) {
  const TemporaryFolder folder;
  const auto file = folder.write("study.toml", "a = 1\n");
  EXPECT_EQ(Section::load(file).number("a", "m")->value, 1.0);
  EXPECT_EQ(Section::load(file).file(), file);
  expect_parts(message_of<InputError>([&] { (void)Section::load(folder.path() / "studi.toml"); }), {"studi.toml", "'study.toml'"});
}

TEST(Section, KnowsKeysInTheOrderOfTheFileAndTheirPlaces) {
  const Section root = parse("z = 1\na = 2\n\n[m]\nb = 3\n");
  EXPECT_EQ(root.keys(), (std::vector<std::string>{"z", "a", "m"}));
  EXPECT_EQ(root.where("a").line, 2);
  EXPECT_EQ(root.table("m")->where("b").line, 5);
  EXPECT_EQ(root.table("m")->where("absent").line, 4);
  EXPECT_EQ(root.table("m")->path(), "m");
}

TEST(Section, NamesTheTypeOfAValue) {
  const Section s = parse("t = \"x\"\nn = 1.5\ni = 2\nf = true\na = [1]\nb = {}\n");
  EXPECT_TRUE(s.is_text("t") && s.is_number("n") && s.is_number("i") && s.is_flag("f") && s.is_array("a") && s.is_table("b"));
  EXPECT_FALSE(s.is_text("n") || s.is_number("t") || s.is_flag("i") || s.is_array("b") || s.is_table("a") || s.is_table("absent"));
  EXPECT_TRUE(s.has("t"));
  EXPECT_FALSE(s.has("absent"));
}

TEST(Number, ReadsBareNumbersAndUnits) {
  const Section s = parse("bare = 0.5\nwhole = 2\nsize = \"24 in\"\nangle = \"90 deg\"\n");
  EXPECT_EQ(s.number("bare", "m")->value, 0.5);
  EXPECT_EQ(s.number("whole", "m")->value, 2.0);
  EXPECT_DOUBLE_EQ(s.number("size", "m")->value, 0.6096);
  EXPECT_DOUBLE_EQ(s.number("angle", "rad")->value, std::numbers::pi / 2.0);
  EXPECT_DOUBLE_EQ(s.number("angle", "deg")->value, 90.0);
  EXPECT_EQ(s.number("bare", "m")->unit, "m");
  EXPECT_EQ(s.number("size", "m")->where.line, 3);
  EXPECT_FALSE(s.number("absent", "m").has_value());
  EXPECT_EQ(parse("V = \"35.1\"").number("V", "m/s")->value, 35.1) << "a text without a unit is in SI, as a number is";
}

TEST(Number, ReadsSigmaWhereItIsAllowed) {
  const Section s = parse("K = { value = \"24 in\", sigma = 0.01 }\nh = { value = 1.0 }\n");
  EXPECT_DOUBLE_EQ(s.number("K", "m", true)->value, 0.6096);
  EXPECT_EQ(s.number("K", "m", true)->sigma, 0.01);
  EXPECT_FALSE(s.number("h", "m", true)->sigma.has_value());
  expect_parts(error_of("K = { value = 1.0 }", [](const Section& t) { (void)t.number("K", "m"); }),
               {"study.toml:1", "K", "a number in 'm'"});
}

TEST(Number, RefusesAWrongTableOfValueAndSigma) {
  const auto read = [](const Section& s) { (void)s.number("K", "m", true); };
  expect_parts(error_of("K = { sigma = 1.0 }", read), {"K", "needs a value"});
  expect_parts(error_of("K = { value = 1.0, sigma = 0.0 }", read), {"K.sigma", "above 0"});
  expect_parts(error_of("K = { value = 1.0, sgima = 0.1 }", read), {"study.toml:1", "'sgima'", "did you mean 'sigma'"});
}

TEST(Number, AWrongUnitNamesPlaceKeyAndUnits) {
  expect_parts(error_of("[geometry]\nD = \"24 kg\"\n", [](const Section& s) { (void)s.table("geometry")->number("D", "m"); }),
               {"study.toml:2:5", "geometry.D", "24 kg", "'kg'", "'m'"});
  expect_parts(error_of("D = \"24 inn\"\n", [](const Section& s) { (void)s.number("D", "m"); }), {"unknown unit 'inn'", "'in'"});
}

TEST(Number, RefusesWhatIsNoFiniteNumber) {
  for (const char* value : {"nan", "inf", "-inf", "\"inf m\"", "true", "[1]", "{}", "\"abc\"", "1979-05-27"}) {
    expect_parts(error_of(std::string("a = 1\nD = ") + value, [](const Section& s) { (void)s.number("D", "m"); }),
                 {"study.toml:2:5", "D = "});
  }
}

TEST(Message, StaysShortWhateverTheText) {
  const std::string big(8'000'000, 'x');
  const auto number = [](const Section& s) { (void)s.number("D", "m"); };
  const std::vector<std::string> messages{
      error_of("D = \"" + big + "\"\n", number),
      error_of("D = \"1 " + big + "\"\n", number),
      error_of("D = [\"" + big + "\"]\n", number),
      error_of(big + " = 1\n", [](const Section& s) { s.finish(); }),
      error_of("[" + big + "]\nD = 1\n", [](const Section& s) { s.finish(); }),
      error_of("[" + big + "]\nD = \"x\"\n", [&](const Section& s) { (void)s.table(s.keys().front())->number("D", "m"); }),
      error_of("D = \"" + big + "\"\n",
               [](const Section& s) {
                 (void)s.choice("D", {"a", "b"});
               }),
      error_of(big + " = 1\n" + big + " = 2\n", [](const Section&) {})};
  for (const std::string& message : messages) {
    expect_parts(message, {"study.toml:"});
    EXPECT_LT(message.size(), 300U) << message.substr(0, 400);
  }
}

TEST(Message, ShowsControlCharactersAsEscapes) {
  expect_parts(error_of("D = \"\\u001b[2J\\u0000\"\n", [](const Section& s) { (void)s.number("D", "m"); }), {"\\x1b[2J", "\\x00"});
}

TEST(Message, ShowsAnArrayOnOneLine) {
  const std::string message = error_of("D = [[1, 2], [3, 4]]\n", [](const Section& s) { (void)s.number("D", "m"); });
  EXPECT_EQ(message.find('\n'), std::string::npos);
  EXPECT_EQ(message.find("\\n"), std::string::npos) << message;
}

TEST(Section, ManyKeysTakeNoQuadraticTime) {
  std::string text;
  for (int i = 0; i < 100'000; ++i) text += "k" + std::to_string(i) + " = 1\n";
  const Section s = parse(text);
  for (const std::string& key : s.keys()) (void)s.number(key, "m");
  EXPECT_NO_THROW(s.finish());
}

TEST(Flag, TakesTrueAndFalseOnly) {
  EXPECT_EQ(parse("a = false").flag("a"), false);
  EXPECT_FALSE(parse("").flag("a").has_value());
  expect_parts(error_of("a = 1", [](const Section& s) { (void)s.flag("a"); }), {"study.toml:1", "a = 1", "true or false"});
}

TEST(Integer, KeepsItsLimits) {
  EXPECT_EQ(parse("a = 3").integer("a", 0, 3), 3L);
  for (const char* value : {"-1", "4", "1.0", "\"1\"", "nan"}) {
    expect_parts(error_of(std::string("a = ") + value, [](const Section& s) { (void)s.integer("a", 0, 3); }),
                 {"study.toml:1", "from 0 to 3"});
  }
}

TEST(Text, IsATextOnly) {
  EXPECT_EQ(parse("a = \"x\"").text("a"), "x");
  expect_parts(error_of("a = 1", [](const Section& s) { (void)s.text("a"); }), {"study.toml:1", "text in quotation marks"});
}

TEST(Choice, NamesTheNearest) {
  const auto read = [](const Section& s) { (void)s.choice("model", {"pinhole", "plane_by_plane"}); };
  EXPECT_EQ(parse("model = \"pinhole\"").choice("model", {"pinhole"}), "pinhole");
  expect_parts(error_of("model = \"pinhol\"", read), {"study.toml:1", "pinhol", "did you mean 'pinhole'? Valid: pinhole, plane_by_plane"});
}

TEST(Numbers, ReadsAnArrayAndNamesTheWrongElement) {
  EXPECT_EQ(*parse("a = [1, 2.5, \"1 km\"]").numbers("a", "m"), (std::vector<double>{1.0, 2.5, 1000.0}));
  EXPECT_TRUE(parse("a = []").numbers("a", "m")->empty());
  expect_parts(error_of("a = [1, \"2 s\"]", [](const Section& s) { (void)s.numbers("a", "m"); }), {"study.toml:1:9", "a[1]", "'s'"});
  expect_parts(error_of("a = 1", [](const Section& s) { (void)s.numbers("a", "m"); }), {"an array of numbers"});
}

TEST(Quantities, KeepTheUnitThatIsWritten) {
  const auto found = parse("a = [1, \"5 deg\", \"2 km\"]").quantities("a");
  ASSERT_EQ(found->size(), 3U);
  EXPECT_EQ((*found)[0].value, 1.0);
  EXPECT_EQ((*found)[0].unit, "");
  EXPECT_DOUBLE_EQ((*found)[1].value, 5.0 * 3.14159265358979323846 / 180.0);
  EXPECT_EQ((*found)[1].unit, "deg");
  EXPECT_EQ((*found)[2].value, 2000.0);
  expect_parts(error_of("a = [1, true]", [](const Section& s) { (void)s.quantities("a"); }), {"study.toml:1:9", "a[1]"});
}

TEST(Texts, ReadsAnArrayAndNamesTheWrongElement) {
  EXPECT_EQ(*parse("a = [\"x\", \"y\"]").texts("a"), (std::vector<std::string>{"x", "y"}));
  expect_parts(error_of("a = [\"x\", 2]", [](const Section& s) { (void)s.texts("a"); }), {"study.toml:1:11", "a[1]"});
  expect_parts(error_of("a = \"x\"", [](const Section& s) { (void)s.texts("a"); }), {"an array of texts"});
}

TEST(Tables, TakesOneTableAsAnArrayOfOne) {
  const Section many = parse("[[e]]\na = 1\n[[e]]\na = 2\n");
  ASSERT_EQ(many.tables("e").size(), 2U);
  EXPECT_EQ(many.tables("e")[1].integer("a", 0, 9), 2L);
  EXPECT_EQ(many.tables("e")[1].path(), "e[1]");
  EXPECT_EQ(parse("[e]\na = 1\n").tables("e").size(), 1U);
  EXPECT_TRUE(parse("").tables("e").empty());
  expect_parts(error_of("e = [1]", [](const Section& s) { (void)s.tables("e"); }), {"e[0]", "a table"});
  expect_parts(error_of("e = 1", [](const Section& s) { (void)s.tables("e"); }), {"[[e]]"});
}

TEST(Finish, NamesAnUnknownKeyTheNearestAndAll) {
  const auto read = [](const Section& s) {
    const Section g = *s.table("geometry");
    (void)g.number("R", "m");
    (void)g.number("R_cp", "m");
    g.finish();
  };
  expect_parts(error_of("[geometry]\nR = 1\nR_pc = 2\n", read),
               {"study.toml:3:1", "'R_pc' in [geometry]", "did you mean 'R_cp'? Valid: R, R_cp"});
}

TEST(Finish, NamesAnUnknownSection) {
  const auto read = [](const Section& s) {
    (void)s.table("geometry");
    s.finish();
  };
  expect_parts(error_of("[geometri]\nR = 1\n", read), {"study.toml:1", "unknown section [geometri]", "'geometry'"});
}

TEST(Finish, PassesWhenEveryKeyWasRead) {
  const Section s = parse("a = 1\nb = 2\n");
  (void)s.number("a", "m");
  EXPECT_THROW(s.finish(), InputError);
  EXPECT_TRUE(s.has("b") && s.is_number("b"));  // looking is not reading
  EXPECT_THROW(s.finish(), InputError);
  (void)s.number("b", "m");
  EXPECT_NO_THROW(s.finish());
}

TEST(Finish, ViewsOfOneTableShareTheirNotes) {
  const Section s = parse("[g]\na = 1\nb = 2\n[[e]]\nc = 1\n");
  (void)s.table("g")->number("a", "m");
  const Section copy = *s.table("g");
  (void)copy.number("b", "m");
  EXPECT_NO_THROW(s.table("g")->finish());
  (void)s.tables("e")[0].number("c", "m");
  EXPECT_NO_THROW(s.tables("e")[0].finish());
}

TEST(Section, OutlivesTheDocumentItCameFrom) {
  std::optional<Section> kept;
  {
    const Section root = parse("[g]\na = \"24 in\"\n");
    kept = root.table("g");
  }
  EXPECT_DOUBLE_EQ(kept->number("a", "m")->value, 0.6096);
}

TEST(Fail, PutsPlaceAndPathInFront) {
  expect_parts(error_of("[g]\na = 1\n", [](const Section& s) { s.table("g")->fail("a", "is wrong"); }), {"study.toml:2:1: g.a: is wrong"});
}

TEST(ContentOf, IsWhatATextSays) {
  const std::string text = "# a study\n[study]\nname = \"x\"\nseed = 1\n[effects]\nb = {}\na = { gain = 0.1, on = [\"x\", 2] }\n";
  const std::string respaced = "[study]\nname =   \"x\"  # called so\n\nseed=1\n[effects]\nb={}\na={gain=0.10,on=[\"x\",2,]}\n";
  EXPECT_EQ(content_of(text), content_of(respaced));
  EXPECT_NE(content_of(text), content_of("[study]\nname = \"x\"\nseed = 1\n[effects]\na = { gain = 0.1, on = [\"x\", 2] }\nb = {}\n"))
      << "effects are summed in their order";
  EXPECT_NE(content_of("x = 0.1"), content_of("x = 0.10000000000000002"));
  EXPECT_NE(content_of("x = 1"), content_of("x = \"1\""));
}

TEST(ContentOf, LeavesOutWhatDoesNotMatter) {
  const std::string text = "[study]\nname = \"x\"\nseed = 1\n[uncertainty]\nruns = 10\n";
  EXPECT_EQ(content_of(text, {"study.name", "uncertainty.runs"}), content_of("[study]\nseed = 1\n[uncertainty]\n"));
  EXPECT_EQ(content_of(text, {"study.name", "uncertainty"}), content_of("[study]\nseed = 1\n"));
  EXPECT_NE(content_of(text, {"name"}), content_of("[study]\nseed = 1\n[uncertainty]\nruns = 10\n")) << "the whole path is named";
}

}  // namespace
}  // namespace misfit::config
