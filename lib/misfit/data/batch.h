#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "misfit/data/fit.h"

namespace misfit {

/// One study of a batch by one method, or by none where it could not even be read.
struct BatchRow {
  std::string study;   ///< short name, unique in the batch
  std::string path;    ///< of its study.toml, as found
  std::string folder;  ///< of its results, relative to the batch's
  std::string method;  ///< empty: the study itself failed
  std::string status;  ///< as of the fit; "failed" where there is none
  std::string message;
  std::map<std::string, Estimate> values;  ///< SI: "trim", parameters that are no curve's coefficients, noise and force ("noise of X")
  std::map<std::string, Estimate> rms;
};

/// How one number varies over the studies in which a method has converged.
struct BatchSummary {
  std::string method, name, unit;  ///< SI
  std::size_t count = 0;           ///< studies that have it
  double mean = 0.0;               ///< weighted by 1/sigma² where all sigmas are known, else plain
  double mean_sigma = 0.0;         ///< of that mean, from the studies' sigmas; 0: not known
  double scatter = 0.0;            ///< standard deviation between the studies; NaN below two
  double own_sigma = 0.0;          ///< root mean square of the studies' sigmas; 0: not known
  std::optional<double>
      p_value;  ///< of χ² = Σ ((value − mean)/sigma)² with count − 1 degrees of freedom: do they differ beyond their sigmas?
};

struct Batch {
  std::vector<BatchRow> rows;  ///< in the order of the studies
  std::vector<BatchSummary> summary;
};

/// One row as JSON text, and back: what a job of the batch leaves. Not a number is null.
[[nodiscard]] std::string batch_rows_text(const std::vector<BatchRow>& rows);
[[nodiscard]] std::vector<BatchRow> batch_rows_from(const std::string& text);

/// batch.json and batch.csv (`study,method,status`, NAME[unit], NAME_sigma[unit] of every number, `message`; angles in degrees).
void write_batch(const std::filesystem::path& dir, const Batch& batch);

}  // namespace misfit
