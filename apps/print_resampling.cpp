#include <fmt/format.h>

#include "apps/print.h"
#include "misfit/core/text.h"
#include "misfit/core/units.h"

namespace misfit {
namespace {

double shown(double value, const std::string& unit) { return convert(value, unit, display_unit(unit)); }

std::string bootstrap_text(const Bootstrap& b) {
  std::string out = fmt::format("\nblock bootstrap of {}: {} runs of {}, blocks of {} samples{}\n", b.method, b.runs, b.how, b.block,
                                b.failed > 0 ? fmt::format(", {} gave no fit", b.failed) : "");
  for (const auto& n : b.numbers) {
    out += fmt::format("  {:<24} {:>12.6g} {:<6} sigma {:<10.3g} (fit: {:<10.3g}) 95 %: {:.6g} to {:.6g}\n", n.name, shown(n.value, n.unit),
                       display_unit(n.unit), shown(n.sigma, n.unit), shown(n.fit_sigma, n.unit), shown(n.lower, n.unit),
                       shown(n.upper, n.unit));
  }
  for (const auto& [reason, runs] : b.failures) out += fmt::format("  ! {} of {} runs: {}\n", runs, b.runs, reason);
  for (const auto& note : b.notes) out += wrap_text("! " + note, 110, "  ") + "\n";
  return out;
}

std::string profile_text(const LikelihoodProfile& p) {
  const auto end = [&](bool found, double value) { return found ? fmt::format("{:.6g}", shown(value, p.unit)) : std::string("?"); };
  std::string out =
      fmt::format("\nprofile of {}, {}: {:.6g} {}, 95 %: {} to {} (fit ± 1.96 sigma: {:.6g} to {:.6g})\n", p.parameter, p.method,
                  shown(p.best, p.unit), display_unit(p.unit), end(p.lower_found, p.lower), end(p.upper_found, p.upper),
                  shown(p.best - 1.96 * p.sigma, p.unit), shown(p.best + 1.96 * p.sigma, p.unit));
  for (const auto& words : p.words) out += "  " + words + "\n";
  return out;
}

std::string starts_text(const MultiStart& s) {
  std::string out =
      fmt::format("\nrandom starts of {}: {} of {} reach the reported maximum, {} a lower, {} a higher one, {} did not converge\n",
                  s.method, s.same, s.runs, s.lower, s.higher, s.failed);
  for (const auto& words : s.words) out += wrap_text((s.higher > 0 ? "! " : "") + words, 110, "  ") + "\n";
  for (const auto& [reason, runs] : s.failures)
    out += wrap_text(fmt::format("{} of {} starts: {}", runs, s.runs, reason), 110, "  ") + "\n";
  return out;
}

}  // namespace

std::string resampling_text(const Resampling& r) {
  std::string out;
  for (const auto& b : r.bootstraps) out += bootstrap_text(b);
  for (const auto& p : r.profiles) out += profile_text(p);
  for (const auto& s : r.starts) out += starts_text(s);
  for (const auto& note : r.notes) out += "\n" + wrap_text("! " + note, 110, "  ") + "\n";
  return out;
}

}  // namespace misfit
