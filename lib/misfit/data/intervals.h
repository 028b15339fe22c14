#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "misfit/data/multi_start.h"

namespace misfit {

/// One number over the runs of a bootstrap, beside what the fit says of it. SI.
struct BootstrapNumber {
  std::string name, unit;  ///< a parameter, or "trim"
  double value = 0.0;      ///< of the fit
  double fit_sigma = 0.0;  ///< of the fit; 0: none
  double mean = 0.0, sigma = 0.0;
  double lower = 0.0, upper = 0.0;  ///< 2.5 and 97.5 % of the runs
  std::size_t runs = 0;             ///< that gave it
};

/// A curve over the runs of a bootstrap, on the fit's grid. SI.
struct BootstrapCurve {
  std::string name, of, of_unit, unit;
  std::vector<double> x, value, fit_sigma, mean, sigma, lower, upper, count;  ///< count: samples visited, as in the fit's curve
};

struct Bootstrap {
  std::string method;  ///< of the fit
  std::string how;     ///< what was resampled, in words
  int block = 0;       ///< samples
  std::size_t runs = 0, failed = 0;
  unsigned long long seed = 0;
  std::map<std::string, std::size_t> failures;  ///< reason → runs that gave no fit for it
  std::vector<std::string> notes;               ///< what a reader must know
  std::vector<BootstrapNumber> numbers;
  std::vector<BootstrapCurve> curves;
};

/// A likelihood with one parameter fixed and everything else estimated again. SI.
struct LikelihoodProfile {
  std::string method, parameter, unit;
  double best = 0.0, sigma = 0.0, plain_sigma = 0.0;  ///< of the fit
  double scale = 1.0;                                 ///< of the drop: (sigma/plain_sigma)², 1 for white residuals
  std::vector<double> value, drop;                    ///< rising values; drop: 2 (log L at best − log L with the value fixed)
  double lower = 0.0, upper = 0.0;                    ///< where the drop is 3.84 × scale: the 95 % interval
  bool lower_found = false, upper_found = false;      ///< false: not reached, `lower` or `upper` is where the search ended
  std::vector<std::string> words;                     ///< what a reader must know
};

/// What [uncertainty] `bootstrap`, `profile` and `starts` gave.
struct Resampling {
  std::vector<Bootstrap> bootstraps;
  std::vector<LikelihoodProfile> profiles;
  std::vector<std::string> notes;  ///< methods that could not be resampled, and why
  std::vector<MultiStart> starts = {};
};

/// `bootstrap.json`, `bootstrap.csv` (curves) and `profile.json` in `dir`; angles of trims and curves in degrees in the CSV, SI in JSON.
void write_bootstrap(const std::filesystem::path& dir, const std::vector<Bootstrap>& bootstraps);
[[nodiscard]] std::vector<Bootstrap> read_bootstrap(const std::filesystem::path& dir);
void write_profiles(const std::filesystem::path& dir, const std::vector<LikelihoodProfile>& profiles);
[[nodiscard]] std::vector<LikelihoodProfile> read_profiles(const std::filesystem::path& dir);
/// `resampling.json`: the notes.
void write_resampling_notes(const std::filesystem::path& dir, const std::vector<std::string>& notes);
[[nodiscard]] std::vector<std::string> read_resampling_notes(const std::filesystem::path& dir);

}  // namespace misfit
