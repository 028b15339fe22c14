#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace misfit::bench {

/// What became of one world: one line of the bench's CSV. Texts hold no commas.
struct Row {
  std::string kind, hidden, known_as;  ///< two at once are joined by '+'
  int number = 0;
  double seconds = 0.0;                ///< of flight
  double strength = 0.0;               ///< 1: about a drop of 60 in 40 s
  double oracle_drop = 0.0;            ///< refitted with the true effect from the truth (two: the larger alone); 0 on null
  std::string verdict = "nothing";     ///< "named", "unknown", "nothing", "failed"
  std::string named, group, quantity;  ///< accepted effect, its group joined by '+', quantity of an unknown dependence
  std::string nearest;                 ///< first in the list, accepted or not
  bool named_first = false, right_group = false, right_quantity = false;
  double predicted_drop = 0.0, actual_drop = 0.0;    ///< of the true effect where it was refitted, else 0
  double trim_error = 0.0, trim_sigma = 0.0;         ///< [deg] of the fit without what is hidden
  double band_share = 0.0;                           ///< share of samples whose angle has the true C_m inside the 95 % band
  double fit_seconds = 0.0, discover_seconds = 0.0;  ///< of processor time
};

[[nodiscard]] std::vector<Row> read_rows(const std::filesystem::path& file);  ///< empty if there is no such file
void append_row(const std::filesystem::path& file, const Row& row);

/// Upper end of the 95 % Clopper–Pearson interval for k of n (two-sided); 1 for n = 0.
[[nodiscard]] double upper_bound(int k, int n);

void print_summary(const std::vector<Row>& rows);

}  // namespace misfit::bench
