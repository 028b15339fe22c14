#include "misfit/data/multi_start.h"

#include "misfit/data/json_number.h"

namespace misfit {

void write_multi_starts(const std::filesystem::path& dir, const std::vector<MultiStart>& starts) {
  Json array = Json::array();
  for (const MultiStart& s : starts) {
    Json numbers = Json::array();
    for (const auto& n : s.numbers) {
      numbers.push_back({{"name", n.name},
                         {"unit", n.unit},
                         {"value", number_or_null(n.value)},
                         {"sigma", sigma_or_null(n.sigma)},
                         {"best", number_or_null(n.best)}});
    }
    array.push_back({{"method", s.method},
                     {"runs", s.runs},
                     {"failed", s.failed},
                     {"seed", s.seed},
                     {"failures", s.failures},
                     {"drop", numbers_to_json(s.drop)},
                     {"same", s.same},
                     {"lower", s.lower},
                     {"higher", s.higher},
                     {"numbers", numbers},
                     {"words", s.words}});
  }
  make_writable_folder(dir);
  write_atomically(dir / "starts.json", array.dump(1) + "\n");
}

std::vector<MultiStart> read_multi_starts(const std::filesystem::path& dir) {
  return parsed_file(dir / "starts.json", [](const Json& array) {
    std::vector<MultiStart> out;
    for (const Json& object : array) {
      MultiStart s;
      s.method = object.at("method");
      s.runs = object.at("runs");
      s.failed = object.at("failed");
      s.seed = object.at("seed");
      s.failures = object.at("failures").get<std::map<std::string, std::size_t>>();
      s.drop = numbers_from_json(object.at("drop"));
      s.same = object.at("same");
      s.lower = object.at("lower");
      s.higher = object.at("higher");
      for (const Json& n : object.at("numbers")) {
        s.numbers.push_back({n.at("name"), n.at("unit"), number_or_nan(n, "value"), optional_from_json(n, "sigma").value_or(0.0),
                             number_or_nan(n, "best")});
      }
      s.words = object.at("words").get<std::vector<std::string>>();
      out.push_back(std::move(s));
    }
    return out;
  });
}

}  // namespace misfit
