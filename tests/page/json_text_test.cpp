#include "misfit/page/json_text.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

namespace misfit::page {
namespace {

using nlohmann::json;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

report::Figure figure_with_text(const std::string& text) {
  report::Figure figure;
  figure.name = "name";
  figure.title = figure.caption = figure.x_label = figure.x_unit = text;
  report::Panel panel;
  panel.y_label = panel.y_unit = text;
  panel.series.push_back({"a", text, report::Style::line, "#000000", {1.0, 2.0}, {3.0, nan}, {}, {}});
  panel.series.push_back({"b", text, report::Style::band, "#000000", {1.0, 2.0}, {}, {0.0, 0.0}, {1.0, 1.0}});
  figure.panels = {panel};
  figure.notes = {text};
  figure.x_marks = {{1.0, text}};
  return figure;
}

TEST(AFigureAsJson, KeepsNumbersAndGivesSharedPlacesOnce) {
  const json figure = json::parse(json_of(figure_with_text("x")));
  EXPECT_EQ(figure["xs"], json::parse("[[1,2]]"));
  const json& series = figure["panels"][0]["series"];
  EXPECT_EQ(series[0]["x"], 0);
  EXPECT_EQ(series[1]["x"], 0);
  EXPECT_EQ(series[0]["y"], json::parse("[3,null]"));
  EXPECT_EQ(series[0]["style"], "line");
  EXPECT_EQ(series[1]["style"], "band");
  EXPECT_FALSE(series[1].contains("y"));
}

TEST(AFigureAsJson, TakesAnyTextAsText) {
  for (const std::string text : {"</script><script>alert(1)</script>", "\"},{\"", "\\", "\x01\x1b[31m", "\xff\xfe", "a\nb", "{0} {}"}) {
    const json figure = json::parse(json_of(figure_with_text(text)));
    if (text.front() != '\xff') {
      EXPECT_EQ(figure["title"], text);
      EXPECT_EQ(figure["panels"][0]["series"][0]["legend"], text);
    }
  }
}

TEST(AFigureAsJson, TypesetsSymbolsAsTheReportDoes) {
  EXPECT_EQ(json::parse(json_words("alpha_T")), json::parse(R"([["α",0],["T",-1]])"));
  EXPECT_EQ(json::parse(json_words("m^2")), json::parse(R"([["m",0],["2",1]])"));
  EXPECT_EQ(json::parse(json_words("plain")), "plain");
}

TEST(NumbersAsJson, TellTimesApartHoweverFarFromZero) {
  EXPECT_EQ(json_places({0.0, 0.05, 1.0 / 3.0}), "[0,0.05,0.333333333]");
  EXPECT_EQ(json_places({1764204705.25, 1764204705.27, nan, 1764204715.0}), "[1764204705.25,1764204705.27,null,1764204715]");
  EXPECT_EQ(json_places({123456.789125, 123456.7895}), "[123456.789125,123456.7895]");
  report::Figure figure = figure_with_text("x");
  figure.x_range = {123456.78, 123456.79};
  EXPECT_EQ(json::parse(json_of(figure))["xRange"], json::parse("[123456.78,123456.79]"));
}

TEST(NumbersAsJson, AreNullWhereTheyAreNotFinite) {
  EXPECT_EQ(json_numbers({1.5, nan, std::numeric_limits<double>::infinity(), -2e-9}), "[1.5,null,null,-2e-09]");
  EXPECT_EQ(json_number(nan), "null");
}

TEST(NumbersAsJson, AreToldApartWhereTheyDifferByLittleBesideWhatTheyAre) {
  EXPECT_EQ(json_numbers({1.7e9, 1.7e9 + 0.25, 1.7e9 + 1.5}), "[1700000000,1700000000.25,1700000001.5]");
}

TEST(BlocksAsJson, GiveCommandsLetterByLetter) {
  Blocks blocks;
  blocks.paragraph("misfit add study drag --at incidence=alpha_T", Tone::command);
  EXPECT_EQ(json::parse(json_of(blocks))[0]["text"], "misfit add study drag --at incidence=alpha_T");
}

TEST(BlocksAsJson, SayUnderWhichLineAListUnfolds) {
  Blocks blocks;
  blocks.list({{"one"}, Tone::plain, {}, "1 other"});
  EXPECT_EQ(nlohmann::json::parse(json_of(blocks))[0]["folded"], "1 other");
}

TEST(BlocksAsJson, AreTheSameList) {
  Blocks blocks;
  blocks.heading("Title");
  blocks.paragraph("Answer", Tone::lead);
  blocks.table({columns("a|>b"), {{"1", "<b>"}}});
  blocks.figures("place");
  const json list = json::parse(json_of(blocks));
  ASSERT_EQ(list.size(), 4U);
  EXPECT_EQ(list[1]["tone"], "lead");
  EXPECT_EQ(list[2]["columns"][1]["right"], true);
  EXPECT_EQ(list[2]["rows"][0][1], "<b>");
  EXPECT_EQ(list[3]["name"], "place");
}

}  // namespace
}  // namespace misfit::page
