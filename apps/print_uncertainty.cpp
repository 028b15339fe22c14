#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/print.h"
#include "misfit/core/display.h"
#include "misfit/core/text.h"
#include "misfit/core/units.h"

namespace misfit {
namespace {

using Rows = std::vector<std::vector<std::string>>;

std::string with_unit(const std::string& number, const std::string& unit) {
  return unit == "-" || unit.empty() ? number : number + " " + unit;
}

/// Value and sigma to the same place.
std::string plain(double value, double sigma, const std::string& unit) {
  const std::string u = display_unit(unit), both = format_value(convert(value, unit, u), convert(sigma, unit, u));
  return with_unit(both.substr(0, both.find(" ±")), u);
}

std::string sigma_of(double sigma, const std::string& unit) {
  const std::string u = display_unit(unit);
  return std::isfinite(sigma) ? with_unit(fmt::format("{:.2g}", convert(sigma, unit, u)), u) : "–";
}

std::string perturbed_table(const Uncertainty& u) {
  Rows rows{{"perturbed", "nominal", "sigma", "distribution"}};
  for (const PerturbedParameter& p : u.perturbed)
    rows.push_back({p.name, in_display_unit(p.value, p.unit), sigma_of(p.sigma, p.unit), p.reading});
  return align_columns(rows);
}

std::string numbers_table(const Uncertainty& u) {
  Rows rows{{"result", "nominal ± sigma (noise)", "mean", "propagated sigma", "3-sigma band", "runs"}};
  for (const SpreadNumber& n : u.numbers) {
    const std::string band = std::isfinite(n.sigma)
                                 ? plain(n.mean - 3.0 * n.sigma, n.sigma, n.unit) + " … " + plain(n.mean + 3.0 * n.sigma, n.sigma, n.unit)
                                 : "–";
    rows.push_back({n.name, in_display_unit(n.nominal, n.unit, n.nominal_sigma), plain(n.mean, n.sigma, n.unit), sigma_of(n.sigma, n.unit),
                    band, std::to_string(n.count)});
  }
  return align_columns(rows);
}

/// One column per number; the sign says which way the number goes when the parameter grows.
std::string shares_table(const Uncertainty& u) {
  constexpr std::size_t most = 4;
  std::vector<const SpreadNumber*> numbers;
  for (const SpreadNumber& n : u.numbers) {
    if (!n.shares.empty() && numbers.size() < most) numbers.push_back(&n);
  }
  if (numbers.empty()) return "";
  Rows rows{{"share of the variance"}};
  for (const SpreadNumber* n : numbers) {
    rows.front().push_back(n->name);
    rows.front().emplace_back("per sigma");
  }
  for (std::size_t i = 0; i < numbers.front()->shares.size(); ++i) {
    rows.push_back({numbers.front()->shares[i].name});
    for (const SpreadNumber* n : numbers) {
      const VarianceShare& s = n->shares[i];
      rows.back().push_back(fmt::format("{:.1f} ± {:.1f} %", 100.0 * s.share, 100.0 * s.sigma));
      rows.back().push_back(std::isfinite(s.effect) ? (s.effect > 0.0 ? "+" : "") + sigma_of(s.effect, n->unit) : "–");
    }
  }
  rows.push_back({"interactions"});
  for (const SpreadNumber* n : numbers) {
    rows.back().push_back(fmt::format("{:.1f} %", 100.0 * n->rest));
    rows.back().emplace_back("");
  }
  return "\n" + align_columns(rows);
}

}  // namespace

std::string uncertainty_text(const Uncertainty& u) {
  std::string out = fmt::format("propagated uncertainty  —  {}, {} runs, seed {}\n", u.method, u.runs, u.seed);
  out += perturbed_table(u) + "\n" + numbers_table(u) + shares_table(u);
  for (const std::string& note : u.notes) out += wrap_text("! " + note, 110, "  ") + "\n";
  for (const auto& [why, count] : u.failures) out += wrap_text(fmt::format("! {} runs failed: {}", count, why), 110, "  ") + "\n";
  return out;
}

}  // namespace misfit
