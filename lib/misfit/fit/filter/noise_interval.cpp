#include "misfit/fit/filter/noise_interval.h"

#include <algorithm>
#include <cmath>

#include "misfit/math/decompositions.h"

namespace misfit {
namespace {

class Paths {
 public:
  Paths(const FilterEstimate& estimate, int threads)
      : estimate_(estimate),
        threads_(threads),
        bounds_(pack(estimate.noise, estimate.model.system->spec(), estimate.reference)),
        here_(Eigen::Map<const Eigen::VectorXd>(estimate.noise_fit.logs.data(), estimate.noise_fit.logs.size())),
        joint_(estimate.joint_covariance.bottomRightCorner(here_.size(), here_.size())) {
    scale_ = Eigen::VectorXd::Ones(here_.size());
    scale_ = (joint_.diagonal().array() / covariance(here_).diagonal().array()).sqrt();
  }

  [[nodiscard]] bool known(Eigen::Index j) const {
    constexpr double most = 1.0;  // sigma of the logarithm
    return !estimate_.noise_fit.at_bound[j] && !pinned(joint_(j, j)) && joint_(j, j) < most;
  }

  [[nodiscard]] double end(Eigen::Index j, double z) const {
    const Eigen::VectorXd middle = inside(here_ + 0.5 * z * direction(joint_, j));
    const Eigen::VectorXd there = inside(here_ + z * direction(covariance(middle), j));
    return std::exp(there[j]);
  }

 private:
  static Eigen::VectorXd direction(const Eigen::MatrixXd& C, Eigen::Index j) { return C.col(j) / std::sqrt(C(j, j)); }

  /// Unknown ones are fixed, as in the joint covariance.
  [[nodiscard]] Eigen::MatrixXd covariance(const Eigen::VectorXd& logs) const {
    const LinearisedRuns runs{&estimate_.forced, &estimate_.data, &estimate_.traces};
    Eigen::MatrixXd information = noise_information(runs, {logs.data(), logs.data() + logs.size()}, estimate_.reference, threads_);
    pin_unknown(estimate_.noise_fit, information);
    return scale_.asDiagonal() * inverse(information) * scale_.asDiagonal();
  }

  [[nodiscard]] Eigen::VectorXd inside(const Eigen::VectorXd& logs) const {
    const auto at = [](const std::vector<double>& v) { return Eigen::Map<const Eigen::VectorXd>(v.data(), v.size()); };
    return logs.cwiseMax(at(bounds_.lower)).cwiseMin(at(bounds_.upper));
  }

  const FilterEstimate& estimate_;
  int threads_;
  NoiseVector bounds_;
  Eigen::VectorXd here_;
  Eigen::MatrixXd joint_;
  Eigen::VectorXd scale_;
};

}  // namespace

std::vector<std::optional<std::pair<double, double>>> noise_intervals(const FilterEstimate& estimate, const std::vector<std::size_t>& which,
                                                                      int threads) {
  std::vector<std::optional<std::pair<double, double>>> out(which.size());
  if (estimate.joint_covariance.size() == 0) return out;
  constexpr double two_sided = 1.959964;  // of 95 %
  const Paths paths(estimate, threads);
  for (std::size_t i = 0; i < which.size(); ++i) {
    const auto j = static_cast<Eigen::Index>(which[i]);
    if (!paths.known(j)) continue;
    const std::pair<double, double> ends(paths.end(j, -two_sided), paths.end(j, two_sided));
    if (std::isfinite(ends.first) && std::isfinite(ends.second)) out[i] = ends;
  }
  return out;
}

}  // namespace misfit
