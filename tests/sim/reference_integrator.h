#pragma once

// CVODE of SUNDIALS (Hindmarsh et al., ACM Trans. Math. Softw. 31 (2005)): an integrator that shares nothing with the toolkit.

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace misfit::testing_models {

using Rates = std::function<void(const std::vector<double>& x, std::vector<double>& dx, double t)>;

/// Goes from time to time, backward differences where the system is stiff, else Adams's formulas. Relative tolerance 1e-12, absolute 1e-15.
class ReferenceIntegrator {
 public:
  ReferenceIntegrator(Rates rates, std::vector<double> x, double t, bool stiff) : rates_(std::move(rates)), x_(std::move(x)), dx_(x_) {
    check(SUNContext_Create(nullptr, &context_), "SUNContext_Create");
    const auto n = static_cast<sunindextype>(x_.size());
    y_.reset(N_VMake_Serial(n, x_.data(), context_));
    matrix_.reset(SUNDenseMatrix(n, n, context_));
    solver_.reset(SUNLinSol_Dense(y_.get(), matrix_.get(), context_));
    memory_ = CVodeCreate(stiff ? CV_BDF : CV_ADAMS, context_);
    check(CVodeInit(memory_, &ReferenceIntegrator::rates_of, t, y_.get()), "CVodeInit");
    check(CVodeSStolerances(memory_, 1e-12, 1e-15), "CVodeSStolerances");
    check(CVodeSetUserData(memory_, this), "CVodeSetUserData");
    check(CVodeSetLinearSolver(memory_, solver_.get(), matrix_.get()), "CVodeSetLinearSolver");
    check(CVodeSetMaxNumSteps(memory_, 10'000'000), "CVodeSetMaxNumSteps");
  }
  ReferenceIntegrator(const ReferenceIntegrator&) = delete;
  ReferenceIntegrator& operator=(const ReferenceIntegrator&) = delete;
  ~ReferenceIntegrator() {
    CVodeFree(&memory_);
    y_.reset();
    matrix_.reset();
    solver_.reset();
    SUNContext_Free(&context_);
  }

  [[nodiscard]] const std::vector<double>& x() const { return x_; }

  /// In at least ten steps: one whose error estimate is 0 does not step over what is short. `kink`: the rates may have one at `from`.
  void advance(double from, double to, bool kink) {
    if (kink) check(CVodeReInit(memory_, from, y_.get()), "CVodeReInit");
    check(CVodeSetMaxStep(memory_, 0.1 * (to - from)), "CVodeSetMaxStep");
    check(CVodeSetStopTime(memory_, to), "CVodeSetStopTime");
    double reached = from;
    check(CVode(memory_, to, y_.get(), &reached, CV_NORMAL), "CVode");
  }

 private:
  static int rates_of(double t, N_Vector y, N_Vector dy, void* self) {
    auto& at = *static_cast<ReferenceIntegrator*>(self);
    const double* from = N_VGetArrayPointer(y);
    std::vector<double> x(from, from + at.x_.size());
    at.rates_(x, at.dx_, t);
    std::copy(at.dx_.begin(), at.dx_.end(), N_VGetArrayPointer(dy));
    return 0;
  }
  static void check(int flag, const std::string& call) {
    if (flag < 0) throw std::runtime_error(call + " failed: " + std::to_string(flag));
  }

  struct Free {
    void operator()(N_Vector at) const { N_VDestroy(at); }
    void operator()(SUNMatrix at) const { SUNMatDestroy(at); }
    void operator()(SUNLinearSolver at) const { SUNLinSolFree(at); }
  };
  Rates rates_;
  std::vector<double> x_, dx_;
  SUNContext context_ = nullptr;
  std::unique_ptr<std::remove_pointer_t<N_Vector>, Free> y_;
  std::unique_ptr<std::remove_pointer_t<SUNMatrix>, Free> matrix_;
  std::unique_ptr<std::remove_pointer_t<SUNLinearSolver>, Free> solver_;
  void* memory_ = nullptr;
};

}  // namespace misfit::testing_models
