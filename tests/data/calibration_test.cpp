#include "misfit/data/calibration.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "misfit/core/error.h"

namespace misfit {
namespace {

class CalibrationFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("misfit_calibration_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    std::filesystem::create_directories(folder_);
    path_ = folder_ / "camera.json";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path folder_, path_;
};

Calibration example() {
  Calibration c;
  c.model = CameraModel::plane_by_plane;
  c.camera.h_c = 0.1 + 0.2;  // a number without short decimal form
  c.camera.K = 133.86;
  c.camera.camera_roll = 0.05;
  c.names = {"h_c", "K"};
  c.covariance = (Eigen::MatrixXd(2, 2) << 1e-6 / 3.0, -1e-9, -1e-9, 4e-4).finished();
  c.sigma_px = 0.49;
  c.rms_px = 0.48;
  c.outliers = 2;
  c.message = "Function tolerance reached.";
  c.converged = true;
  c.tests = {{"image_centre", {"centre_y", "centre_z"}, {6.0, -4.0}, {0.06, 0.15}, 643.7, 1e-130, true},
             {"camera_roll",
              {"camera_roll"},
              {std::numeric_limits<double>::quiet_NaN()},
              {std::numeric_limits<double>::quiet_NaN()},
              0.0,
              1.0,
              false}};
  c.residuals = {{3, 'y', -0.1, 1.5, 1.25, true}, {1, 'z', 0.2, -30.0, 300.0 / 7.0, false}};
  c.notes = {"2 of 75 points were rejected as outliers"};
  return c;
}

TEST_F(CalibrationFile, ReadsBackExactly) {
  const Calibration a = example();
  write_calibration(path_, a);
  const Calibration b = read_calibration(path_);
  EXPECT_EQ(a.model, b.model);
  EXPECT_EQ(camera_values(a.camera), camera_values(b.camera));
  EXPECT_EQ(a.names, b.names);
  EXPECT_EQ(a.covariance, b.covariance);
  EXPECT_EQ(a.sigma_px, b.sigma_px);
  EXPECT_EQ(a.rms_px, b.rms_px);
  EXPECT_EQ(a.outliers, b.outliers);
  EXPECT_EQ(a.message, b.message);
  EXPECT_EQ(a.converged, b.converged);
  EXPECT_EQ(a.notes, b.notes);
  ASSERT_EQ(b.tests.size(), 2u);
  EXPECT_EQ(b.tests[0].name, "image_centre");  // the order is kept
  EXPECT_EQ(b.tests[0].values, a.tests[0].values);
  EXPECT_EQ(b.tests[0].p_value, 1e-130);
  EXPECT_TRUE(b.tests[0].selected);
  EXPECT_TRUE(std::isnan(b.tests[1].values[0]));
  ASSERT_EQ(b.residuals.size(), 2u);
  EXPECT_EQ(b.residuals[1].point, 1);
  EXPECT_EQ(b.residuals[1].coordinate, 'z');
  EXPECT_EQ(b.residuals[1].predicted, 300.0 / 7.0);
  EXPECT_FALSE(b.residuals[1].used);
}

TEST_F(CalibrationFile, HasTheFieldsOfTheContract) {
  write_calibration(path_, example());
  std::ifstream in(path_);
  const auto json = nlohmann::json::parse(in);
  EXPECT_EQ(json["model"], "plane_by_plane");
  EXPECT_EQ(json["K"]["value"], 133.86);
  EXPECT_NEAR(json["K"]["sigma"].get<double>(), 0.02, 1e-15);
  EXPECT_EQ(json["K"]["unit"], "px/m");
  EXPECT_EQ(json["camera_roll"]["unit"], "rad");
  EXPECT_TRUE(json["camera_roll"]["sigma"].is_null());  // not free
  EXPECT_EQ(json["covariance"][0][1], -1e-9);
  EXPECT_EQ(json["tests"]["image_centre"]["selected"], true);
  EXPECT_TRUE(json["tests"]["camera_roll"]["values"][0].is_null());  // never nan
}

TEST_F(CalibrationFile, BrokenFilesAreInputErrorsThatNameTheFile) {
  for (const char* text : {"{", "{}", R"({"model": "pinhol"})", "[1, 2]"}) {
    std::ofstream(path_) << text;
    try {
      (void)read_calibration(path_);
      FAIL() << text;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("camera.json"), std::string::npos);
    }
  }
  EXPECT_THROW((void)read_calibration(folder_ / "absent.json"), InputError);
}

TEST(Calibration, SigmaAndValueByName) {
  const Calibration c = example();
  EXPECT_EQ(c.value("camera_roll"), 0.05);
  EXPECT_EQ(c.sigma("camera_roll"), 0.0);
  EXPECT_NEAR(c.sigma("K"), 0.02, 1e-15);
  EXPECT_THROW((void)c.value("roll"), InputError);
  EXPECT_THROW((void)c.sigma("roll"), InputError);
}

}  // namespace
}  // namespace misfit
