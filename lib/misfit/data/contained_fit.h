#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace misfit {

/// An estimate of a model that another one contains: the larger one has the same parameters and curves first, then its own. Where a rung of
/// a ladder begins (lib/misfit/README.md, 6.6).
struct ContainedFit {
  std::vector<std::string> names;          ///< of all parameters, in the model's order; a larger model may put EFFECT. before one
  std::vector<double> values;              ///< of the same [SI]
  std::vector<double> roughness;           ///< λ by curve, in the model's order; 0: none
  std::vector<double> noise, usual_noise;  ///< logarithms of the noise (NoiseVector), and of that which set its bounds
  /// Per experiment a letter for each measurement, samples × channels: c counted, v validation, u moves the filter without counting,
  /// - missing or an outlier.
  std::vector<std::string> use;
  std::vector<double> refit_values, refit_log_noise;  ///< where discovery's refit of the larger model ended (Candidate); empty: none
};

/// Beside a rung's study.toml.
inline constexpr const char* kContainedFitFile = "contained_fit.json";
void write_contained_fit(const std::filesystem::path& path, const ContainedFit& fit);
[[nodiscard]] ContainedFit read_contained_fit(const std::filesystem::path& path);

}  // namespace misfit
