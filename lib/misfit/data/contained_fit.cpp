#include "misfit/data/contained_fit.h"

#include "misfit/data/json_fields.h"

namespace misfit {

template <class Archive>
void fields(Archive& json, MaybeConst<ContainedFit> auto& fit) {
  json("names", fit.names), json("values", fit.values), json("roughness", fit.roughness);
  json("log_noise", fit.noise), json("log_usual_noise", fit.usual_noise), json("use", fit.use);
  json("refit_values", fit.refit_values), json("refit_log_noise", fit.refit_log_noise);
}

void write_contained_fit(const std::filesystem::path& path, const ContainedFit& fit) { write_json(path, fit); }

ContainedFit read_contained_fit(const std::filesystem::path& path) { return read_json<ContainedFit>(path); }

}  // namespace misfit
