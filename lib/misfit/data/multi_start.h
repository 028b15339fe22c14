#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace misfit {

/// A parameter at the fit and at the best of the random starts. SI.
struct StartedNumber {
  std::string name, unit;
  double value = 0.0, sigma = 0.0;  ///< of the fit
  double best = 0.0;                ///< where the start that ended highest ended
};

/// A fit repeated from random starts.
struct MultiStart {
  std::string method;  ///< of the fit
  std::size_t runs = 0, failed = 0;
  unsigned long long seed = 0;
  std::map<std::string, std::size_t> failures;  ///< reason → starts that gave no fit for it
  std::vector<double> drop;                     ///< of those that did: 2 (log L of the fit − log L there), priors counted; lowest first
  std::size_t same = 0, lower = 0, higher = 0;  ///< ended at the fit's maximum (drops beside 0 by no more than kSameMaximum), elsewhere
  std::vector<StartedNumber> numbers;           ///< free parameters that are no coefficients of curves
  std::vector<std::string> words;               ///< what a reader must know
};

/// Ends of two searches nearer than this in 2 log L are one maximum: parameters are then 0.7 sigma apart at most.
inline constexpr double kSameMaximum = 0.5;

/// `starts.json` in `dir`.
void write_multi_starts(const std::filesystem::path& dir, const std::vector<MultiStart>& starts);
[[nodiscard]] std::vector<MultiStart> read_multi_starts(const std::filesystem::path& dir);

}  // namespace misfit
