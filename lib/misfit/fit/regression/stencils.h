#pragma once

// References
//   [P] the paper (lib/misfit/README.md, [1]), "Data Reduction": second order four-point stencils, three-point averages.

#include <vector>

namespace misfit {

/// How [P]'s "second order finite difference values (four-point stencils)" are read; f_k is the sample k steps h away.
enum class Stencils {
  fourth_order,  ///< f' = (f₋₂ − 8f₋₁ + 8f₁ − f₂)/12h, error h⁴f⁽⁵⁾/30; f'' = (−f₋₂ + 16f₋₁ − 30f₀ + 16f₁ − f₂)/12h², error h⁴f⁽⁶⁾/90
  second_order_four_point  ///< f' = (2(f₂ − f₋₂) + f₁ − f₋₁)/10h, the slope of the straight line through four points by least squares,
                           ///< error 17h²f'''/30; f'' = (f₋₂ − f₋₁ − f₁ + f₂)/3h², error 5h²f⁽⁴⁾/12
};

/// Level, rate and acceleration per sample in the unit of the level and seconds; all three NaN where the stencil cannot be used.
struct StencilMotion {
  std::vector<double> level, rate, acceleration;
};

/// Samples before and after that one acceleration rests on, three-point average included.
inline constexpr int kStencilReach = 3;

/// Mean of each sample and its two neighbours in time [P]; NaN where one is missing or the two steps differ by 20 % or more of their mean.
[[nodiscard]] std::vector<double> average_of_three(const std::vector<double>& t, const std::vector<double>& f);

/// Derivatives in time by five-sample stencils with h = (t₂ − t₋₂)/4; used only where all five samples exist and the largest and the
/// smallest of the four steps differ by less than 20 % of h: a gap breaks the stencil, it is not bridged.
[[nodiscard]] StencilMotion stencil_motion(const std::vector<double>& t, const std::vector<double>& f, Stencils stencils);

}  // namespace misfit
