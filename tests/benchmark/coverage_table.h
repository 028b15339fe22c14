#pragma once

#include <string>
#include <vector>

namespace misfit::bench {

/// One quantity of one flight. The last row of a flight is the quantity "end" with the fit's seconds as value.
struct CoverageRow {
  std::string method, kind;
  int number = 0;
  std::string status, quantity;
  double truth = 0.0, value = 0.0, sigma = 0.0, plain_sigma = 0.0;
  double low = 0.0, high = 0.0;  ///< of the 95 % interval where it is not value ± 1.96 sigma, else both 0
};

/// Rows of a CSV, without those of flights that are not complete; empty if there is no file.
[[nodiscard]] std::vector<CoverageRow> read_coverage(const std::string& path);
/// Appends the rows of one flight in one write.
void append_coverage(const std::string& path, const std::vector<CoverageRow>& rows);
/// Coverage of 95 % intervals per method, kind and quantity, the plain intervals' beside, mean error in sigmas and the ratio of the errors'
/// scatter to the mean sigma.
void print_coverage(const std::vector<CoverageRow>& rows);

}  // namespace misfit::bench
