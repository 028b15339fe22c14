// JSON, CSV and JSBSim: read back, the numbers are those of the estimate.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "misfit/core/error.h"
#include "tests/export/generated.h"
#include "tests/model/declared_texts.h"

namespace misfit {
namespace {

using namespace testing_models;
using namespace testing_export;
using nlohmann::json;

/// A parachute whose curves have a covariance of known size, on a grid.
Exported parachute_estimate() {
  Exported out{"a \"flight\" <1> -- & more", "", "misfit", {}, assemble(parachute(true), registry())};
  Model& model = *out.model;
  for (Parameter& p : model.parameters) {
    if (p.curve >= 0) p.value = 0.01 * static_cast<double>(&p - model.parameters.data() + 1) / 3.0;
  }
  Fit& fit = out.fit;
  fit.method = "output_error";
  fit.status = FitStatus::converged;
  for (const int i : model.free_parameters()) {
    fit.names.push_back(model.parameters[i].name);
    fit.parameters[fit.names.back()] = {model.parameters[i].value, 0.002, model.parameters[i].unit};
  }
  const auto n = std::ssize(fit.names);
  fit.covariance = 4e-6 * Eigen::MatrixXd::Identity(n, n);
  fit.curves.push_back(
      {"C_m", "alpha_T", "rad", "-", {0.1, 0.2, 0.3}, {0.01, 1.0 / 3.0, -0.02}, {0.001, 0.002, 0.0}, {5, 8, 0}, true, "", true});
  fit.curves.push_back({"C_m_alphadot", "alpha_T", "rad", "-", {0.1, 0.2}, {0.5, 0.25}, {0.1, 0.1}, {3, 3}, true, "", false});
  return out;
}

double value_at(const Model& model, const std::string& name, double x) {
  const Curve& curve = *model.find_curve(name);
  const CurvePoint at = curve.spline.at(x);
  double value = 0.0;
  for (int j = 0; j < 4; ++j) value += at.w[j] * model.parameters[curve.first + at.first + j].value;
  return value;
}

TEST(Json, HasParametersCovarianceAndCurves) {
  const Exported exported = parachute_estimate();
  const json all = json::parse(json_text(exported));
  EXPECT_EQ(all["parameters"]["S"]["value"], 1.9554);
  EXPECT_EQ(all["parameters"]["S"]["unit"], "m^2");
  EXPECT_TRUE(all["parameters"]["S"]["sigma"].is_null()) << "it was not estimated";
  EXPECT_FALSE(all["parameters"].contains("C_m[0]")) << "a coefficient means something within its curve only";
  EXPECT_EQ(all["covariance"]["names"].size(), exported.fit.names.size());
  EXPECT_EQ(all["covariance"]["matrix"][1][1], 4e-6);
  const json& curve = all["curves"][0];
  EXPECT_EQ(curve["name"], "C_m");
  EXPECT_EQ(curve["parity"], "odd");
  for (std::size_t i = 0; i < curve["knots"]["x"].size(); ++i) {
    const double x = curve["knots"]["x"][i];
    EXPECT_DOUBLE_EQ(curve["knots"]["value"][i], value_at(*exported.model, "C_m", x));
    const CurvePoint at = exported.model->find_curve("C_m")->spline.at(x);
    double variance = 0.0;
    for (const double w : at.w) variance += w * w * 4e-6;
    EXPECT_NEAR(curve["knots"]["sigma"][i], std::sqrt(variance), 1e-15);
  }
  EXPECT_EQ(curve["grid"]["value"][1], 1.0 / 3.0);
  EXPECT_EQ(curve["grid"]["sigma"][0], 0.001);
  EXPECT_EQ(all["curves"].back()["name"], "C_m_alphadot");
  EXPECT_FALSE(all["curves"].back().contains("knots")) << "it follows from the others";
}

TEST(Csv, HasTheSameNumbers) {
  const Exported exported = parachute_estimate();
  const std::map<std::string, std::string> files = csv_texts(exported);
  std::vector<std::string> names;
  for (const auto& [name, text] : files) names.push_back(name);
  EXPECT_THAT(names, testing::ElementsAre("C_m_alphadot_grid.csv", "C_m_grid.csv", "C_m_knots.csv", "C_mq_knots.csv", "covariance.csv",
                                          "parameters.csv"));
  EXPECT_THAT(files.at("parameters.csv"), testing::HasSubstr("\nS,1.9554,,m^2,0\n"));
  EXPECT_THAT(files.at("C_m_grid.csv"),
              testing::StartsWith("alpha_T[rad],value[-],sigma[-],count\n0.1,0.01,0.001,5.0\n0.2,0.3333333333333333,"));
  EXPECT_THAT(files.at("covariance.csv"), testing::StartsWith("name,C_m[0],C_m[1],"));
}

/// A program on JSBSim's rule: one line "key value" each in <tableData>, keys increasing, straight lines between, held outside.
const std::string reader = R"(import sys, xml.etree.ElementTree as tree
root = tree.parse('aerodynamics.xml').getroot()
assert root.tag == 'aerodynamics' and root.find('axis').get('name') == 'PITCH'
for function in root.iter('function'):
  factors = [p.text.strip() for p in function.find('product').findall('property')]
  table = function.find('product').find('table')
  key = table.find('independentVar')
  assert key.get('lookup') == 'row' and key.text.strip() == 'aero/alpha-rad', key.text
  rows = [tuple(map(float, line.split())) for line in table.find('tableData').text.strip().splitlines()]
  assert all(len(row) == 2 for row in rows) and all(a[0] < b[0] for a, b in zip(rows, rows[1:]))
  assert factors[:3] == ['aero/qbar-psf', 'metrics/Sw-sqft', 'metrics/cbarw-ft'], factors
  kind = 0 if function.get('name').endswith('/Cm') else 1
  assert factors[3:] == [[], ['aero/ci2vel', 'velocities/q-aero-rad_sec']][kind], factors
  for x, y in rows:
    print(kind, repr(x), repr(y))
)";

TEST(JsbSim, TablesHoldTheCurves) {
  const Exported exported = parachute_estimate();
  const TemporaryFolder folder;
  write_file(folder.path() / "aerodynamics.xml", jsbsim_text(exported));
  write_file(folder.path() / "read.py", reader);
  const std::vector<Row> rows = rows_of(folder, "python3 read.py");
  ASSERT_GT(rows.size(), 100U);
  int below = 0;
  for (const Row& row : rows) {
    EXPECT_EQ(row[2], value_at(*exported.model, row[0] == 0.0 ? "C_m" : "C_mq", row[1])) << "to the last digit, at " << row[1];
    below += row[1] < 0.0 ? 1 : 0;
  }
  EXPECT_EQ(below, static_cast<int>(rows.size() - 2) / 2) << "both sides of 0, and 0 in each table";
}

TEST(JsbSim, ADampingThatIsANumberIsAValueAndOtherEffectsAreNamed) {
  ModelRequest request = parachute(true, {effect("coulomb_friction")});
  request.curves.erase("C_mq");
  request.parameters["C_mq"].value = -0.25;
  Exported exported{"", "", "", {}, assemble(request, registry())};
  exported.fit.parameters["C_mq"] = {-0.2505, 0.01, "-"};
  const std::string text = jsbsim_text(exported);
  EXPECT_THAT(text, testing::HasSubstr("<property>velocities/q-aero-rad_sec</property>\n          <value>-0.2505"));
  EXPECT_THAT(effects_not_in_jsbsim(exported), testing::Contains("coulomb_friction"));
  EXPECT_THAT(effects_not_in_jsbsim(exported), testing::Not(testing::Contains("pitch_damping")));
  EXPECT_THAT(text.substr(0, text.find("-->")), testing::HasSubstr("not in this file: "));
}

TEST(JsbSim, RefusesAModelWithoutSuchCurves) {
  Exported exported{"", "", "", {}, assemble(request_of("cascaded_tanks"), registry())};
  EXPECT_THROW(static_cast<void>(jsbsim_text(exported)), InputError);
}

}  // namespace
}  // namespace misfit
