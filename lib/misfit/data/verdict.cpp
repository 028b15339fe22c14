#include "misfit/data/verdict.h"

#include <algorithm>
#include <cmath>

#include "misfit/core/enum_name.h"
#include "misfit/data/json_fields.h"

namespace misfit {

std::optional<double> ErrorChange::per_cent() const {
  if (!after || !(std::abs(before.value) > 0.0) || !std::isfinite(after->value)) return std::nullopt;
  return 100.0 * (after->value / before.value - 1.0);
}

bool within_sigma(const Estimate& before, const Estimate& after) {
  return std::abs(after.value - before.value) < std::max(before.sigma, after.sigma);
}

std::string ErrorChange::what() const {
  const std::string name = enum_name(error_kind_names, kind);
  return of.empty() ? name : name + (kind == ErrorKind::random_force ? " on " : " of ") + of;
}

template <class Archive>
void fields(Archive& json, MaybeConst<ErrorChange> auto& e) {
  json.derived("what", e.what());
  json("before", e.before), json("after", e.after);
  json.derived("change_per_cent", e.per_cent());
  json("remark", e.remark);
}

template <class Archive>
void fields(Archive& json, MaybeConst<Verdict> auto& v) {
  json("verdict", NameOf(v.kind, verdict_names)), json("sentence", v.sentence), json("notes", v.notes), json("where", v.where);
  json("errors", v.errors), json("added", v.added), json("doubts", v.doubts), json("parameters", v.parameters), json("trim", v.trim),
      json("next", v.next);
}

void write_verdict(const std::filesystem::path& path, const Verdict& verdict) { write_json(path, verdict); }

}  // namespace misfit
