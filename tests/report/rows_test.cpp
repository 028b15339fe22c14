#include "misfit/report/rows.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "misfit/core/error.h"
#include "misfit/core/files.h"
#include "tests/core/temporary_folder.h"

namespace misfit::report {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

TEST(Rows, ANumberWithoutUnitDoesNotEnter) {
  expect_parts(message_of<InputError>([] { const Row row("trim", 1.0, 0.1, ""); }), {"trim", "no unit"});
  EXPECT_THROW(Row("trim", 1.0, 0.1, "furlong"), InputError);
}

TEST(Rows, AnglesAreShownInDegreesWithTheirSigma) {
  const Row row("trim", 12.0 * degree, 0.21 * degree, "rad");
  EXPECT_EQ(row.shown_number(), "12.00 ± 0.21");
  EXPECT_EQ(row.shown_unit(), "deg");
}

TEST(Rows, TextAndCsvCarryTheUnit) {
  const TemporaryFolder folder;
  const std::vector<Row> rows = {{"trim, free", 12.0 * degree, 0.25 * degree, "rad"},
                                 {"mass", 0.5, 0.0, "kg"},
                                 {"lost", std::numeric_limits<double>::quiet_NaN(), 0.0, "m"}};
  expect_parts(rows_text(rows), {"12.00 ± 0.25", "deg", "0.5", "kg", "not available"});
  write_rows_csv(folder.path() / "rows.csv", rows);
  EXPECT_EQ(read_file(folder.path() / "rows.csv"), "what,value,sigma,unit\n\"trim, free\",12,0.25,deg\nmass,0.5,,kg\nlost,,,m\n");
}

TEST(Rows, AnIntervalOfItsOwnStandsBesideSigma) {
  const Row row("slope", Estimate{0.2, 0.01, "rad", std::pair(0.15, 0.3)});
  const std::string html = rows_html({row});
  EXPECT_NE(html.find("11.46 ± 0.57 (95 %: 8.59 to 17.19)"), std::string::npos) << html;
}

TEST(Rows, HtmlIsEscaped) {
  const std::string html = rows_html({{"<b>x</b>", 1.0, 0.0, "m/s^2"}});
  EXPECT_EQ(html.find("<b>"), std::string::npos);
  expect_parts(html, {"&lt;b&gt;", "m/s<sup>2</sup>"});
}

TEST(Rows, SubjectsStandSideBySideAndGapsStayEmpty) {
  const std::string text = subjects_text({{"a", {{"trim", 0.2, 0.0, "m"}}}, {"b", {{"trim", 0.3, 0.0, "m"}, {"rms", 4.0, 0.0, "px"}}}});
  const std::size_t trim = text.find("trim");
  const std::string line = text.substr(trim, text.find('\n', trim) - trim);
  expect_parts(line, {"m", "0.2", "0.3"});
  EXPECT_NE(subjects_html({{"a", {}}, {"b", {{"rms", 4.0, 0.0, "px"}}}}).find("<td class=\"number\">–</td><td class=\"number\">4</td>"),
            std::string::npos);
}

}  // namespace
}  // namespace misfit::report
