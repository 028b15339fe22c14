#include "misfit/show/verdict_evidence.h"

#include "misfit/data/candidates.h"
#include "misfit/show/error_changes.h"

namespace misfit {

bool is_of_the_hold(const std::optional<std::string>& also) { return also && also->starts_with(half_a_sample); }

Evidence evidence_for(const Rung& rung, bool something_remains) {
  if (!rung.actual_drop) return Evidence::untested;
  if (explains_no_more_than_chance(rung)) return Evidence::chance;
  if (is_of_the_hold(rung.also)) return Evidence::of_the_hold;
  if (rung.held_out_gain && *rung.held_out_gain < 0.0) return Evidence::predicts_worse;
  return rung.remained && something_remains ? Evidence::a_part : Evidence::needed;
}

}  // namespace misfit
