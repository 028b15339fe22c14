#include "misfit/data/attitude.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "misfit/core/error.h"

namespace misfit {
namespace {

class AttitudeFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("misfit_attitude_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    std::filesystem::create_directories(folder_);
    path_ = folder_ / "attitude.csv";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path folder_, path_;
};

TEST_F(AttitudeFile, WritesDegreesAndEmptyFieldsAndReadsBack) {
  Attitude a;
  double next = 0.01;
  a.t = {0.0, 0.5};
  for (auto* column : {&a.theta, &a.psi, &a.theta_mean, &a.psi_mean, &a.theta_rate, &a.psi_rate, &a.alpha, &a.beta, &a.alpha_T, &a.phi,
                       &a.eta, &a.sigma_theta, &a.sigma_psi, &a.sigma_alpha_T, &a.sigma_phi}) {
    *column = {next, std::numeric_limits<double>::quiet_NaN()};
    next += 0.013;
  }
  write_attitude(path_, a);
  std::ifstream in(path_);
  std::string header, first, second;
  std::getline(in, header);
  std::getline(in, first);
  std::getline(in, second);
  EXPECT_EQ(header.rfind("t[s],theta[deg],psi[deg],alpha[deg],beta[deg],alpha_T[deg],phi[deg],eta[deg],", 0), 0u) << header;
  EXPECT_NE(header.find("theta_rate[deg/s]"), std::string::npos);
  EXPECT_EQ(first.rfind("0,0.5729577951308232,", 0), 0u) << first;  // 0.01 rad
  EXPECT_EQ(second, "0.5,,,,,,,,,,,,,,,");

  const Attitude b = read_attitude(path_);
  ASSERT_EQ(b.t, a.t);
  for (auto column : {&Attitude::theta, &Attitude::psi, &Attitude::theta_mean, &Attitude::psi_mean, &Attitude::theta_rate,
                      &Attitude::psi_rate, &Attitude::alpha, &Attitude::beta, &Attitude::alpha_T, &Attitude::phi, &Attitude::eta,
                      &Attitude::sigma_theta, &Attitude::sigma_psi, &Attitude::sigma_alpha_T, &Attitude::sigma_phi}) {
    EXPECT_NEAR((b.*column)[0], (a.*column)[0], 1e-12);
    EXPECT_TRUE(std::isnan((b.*column)[1]));
  }
}

TEST_F(AttitudeFile, TheColumnsOfTheContractAreEnoughOneLessIsNot) {
  std::ofstream(path_) << "t[s],theta[deg],psi[deg],alpha[deg],beta[deg],alpha_T[deg],phi[deg]\n0,180,0,0,0,12,90\n";
  const Attitude a = read_attitude(path_);
  EXPECT_NEAR(a.theta[0], 3.141592653589793, 1e-15);
  EXPECT_TRUE(std::isnan(a.theta_rate[0]));
  std::ofstream(path_) << "t[s],theta[deg],psi[deg],alpha[deg],beta[deg],phi[deg]\n0,180,0,0,0,90\n";
  EXPECT_THROW((void)read_attitude(path_), InputError);
}

TEST_F(AttitudeFile, RadiansAreAcceptedByTheirHeader) {
  std::ofstream(path_) << "t[s],theta[rad],psi[deg],alpha[deg],beta[deg],alpha_T[deg],phi[deg]\n0,0.5,0,0,0,12,90\n";
  EXPECT_NEAR(read_attitude(path_).theta[0], 0.5, 1e-15);
}

}  // namespace
}  // namespace misfit
