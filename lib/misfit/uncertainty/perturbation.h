#pragma once

#include <string>

namespace misfit {

/// One set-up parameter that the Monte-Carlo draws anew for every run: its nominal value plus a normal (or uniform) error of mean 0.
struct Perturbation {
  std::string name;    ///< as the study writes it: "R", "K", "m_a", "P_y"
  std::string unit;    ///< SI (P_y, P_z: px)
  double sigma = 0.0;  ///< [unit] standard deviation of the error
};

}  // namespace misfit
