#include "misfit/data/multi_start.h"

#include "misfit/data/json_fields.h"

namespace misfit {

template <class Archive>
void fields(Archive& json, MaybeConst<StartedNumber> auto& n) {
  json("name", n.name), json("unit", n.unit), json("value", n.value), json("sigma", Sigma(n.sigma));
  json("best", n.best);
}

template <class Archive>
void fields(Archive& json, MaybeConst<MultiStart> auto& s) {
  json("method", s.method), json("runs", s.runs), json("failed", s.failed), json("seed", s.seed);
  json("failures", s.failures), json("drop", s.drop), json("same", s.same), json("lower", s.lower);
  json("higher", s.higher), json("numbers", s.numbers), json("words", s.words);
}

void write_multi_starts(const std::filesystem::path& dir, const std::vector<MultiStart>& starts) {
  make_writable_folder(dir);
  write_json(dir / "starts.json", starts);
}

std::vector<MultiStart> read_multi_starts(const std::filesystem::path& dir) {
  return read_json<std::vector<MultiStart>>(dir / "starts.json");
}

}  // namespace misfit
