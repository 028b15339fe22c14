#include "misfit/data/json_fields.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/temporary_folder.h"

namespace misfit {

enum class Paint { red, green };
struct Dot {
  std::string name;
  double x = 0.0, sigma = 0.0;
  std::string unit = "rad";
  Paint colour = Paint::red;
  std::vector<int> counts;
  std::optional<double> extra;
};
struct Dots {
  std::vector<Dot> all;
};

template <class Archive>
void fields(Archive& json, MaybeConst<Dot> auto& d) {
  static constexpr std::array<const char*, 2> names = {"red", "green"};
  const double factor = json.factor("unit", d.unit);
  json("x", Scaled(d.x, factor)), json("sigma", Sigma(d.sigma, factor)), json("unit", DisplayUnit(d.unit));
  json("colour", NameOf(d.colour, names)), json("counts", d.counts);
  json.derived("half", 0.5 * d.x);
  json.if_there("extra", d.extra);
}

template <class Archive>
void fields(Archive& json, MaybeConst<Dots> auto& d) {
  json("dots", Named(d.all, &Dot::name));
}

namespace {

const Dots example{{{"a", 0.5, 0.0, "rad", Paint::green, {1, 2}, std::nullopt}, {"b", std::nan(""), 0.1, "-", Paint::red, {}, 3.0}}};

TEST(JsonFields, AreWrittenInTheirOrderInDisplayUnitsAndNeverAsNan) {
  EXPECT_EQ(JsonWriter::json_of(example).dump(),
            R"({"dots":{"a":{"x":28.64788975654116,"sigma":null,"unit":"deg","colour":"green","counts":[1,2],"half":0.25},)"
            R"("b":{"x":null,"sigma":0.1,"unit":"-","colour":"red","counts":[],"half":null,"extra":3.0}}})");
}

TEST(JsonFields, AreReadAsTheyWereWritten) {
  Dots back;
  JsonReader::read(JsonWriter::json_of(example), back);
  ASSERT_EQ(back.all.size(), 2U);
  EXPECT_EQ(back.all[0].name, "a");
  EXPECT_NEAR(back.all[0].x, 0.5, 1e-15);
  EXPECT_EQ(back.all[0].unit, "rad");
  EXPECT_EQ(back.all[0].colour, Paint::green);
  EXPECT_EQ(back.all[0].counts, (std::vector<int>{1, 2}));
  EXPECT_FALSE(back.all[0].extra.has_value());
  EXPECT_TRUE(std::isnan(back.all[1].x));
  EXPECT_EQ(back.all[1].extra, 3.0);
}

/// What the error about such a file says.
std::string error_of(const std::string& text) {
  const TemporaryFolder folder;
  const auto path = folder.write("dots.json", text);
  return message_of<InputError>([&] { static_cast<void>(read_json<Dots>(path)); });
}

TEST(JsonFields, WhatIsWrongWithAFileIsSaidWithItsName) {
  const std::string begin = R"({"dots":{"a":{"x":1,"sigma":null,"unit":"deg",)";
  expect_parts(error_of("{"), {"dots.json", "parse error"});
  expect_parts(error_of("{}"), {"dots.json", "'dots'"});
  expect_parts(error_of(R"({"dots":[]})"), {"dots.json", "array"});
  expect_parts(error_of(R"({"dots":{"a":3}})"), {"dots.json", "number"});
  expect_parts(error_of(begin + R"("colour":"gren","counts":[]}}})"), {"dots.json", "'gren'", "did you mean 'green'"});
  expect_parts(error_of(begin + R"("colour":"red","counts":7}}})"), {"dots.json", "number"});
  expect_parts(error_of(begin + R"("colour":"red"}}})"), {"dots.json", "'counts'"});
}

}  // namespace
}  // namespace misfit
