// Is discovery right on systems that it has never seen? Textbook systems of other trades, simulated by a plain integrator of their own,
// with something hidden in the plant or in a sensor; misfit runs on them as a user would run it.
//
//   strangers_benchmark --program build/release/misfit --seeds 0:8 --out strangers.jsonl
//   strangers_benchmark --summary strangers.jsonl                              the table
//
// A world depends on its system and seed alone. Of eight seeds one has nothing hidden, one an effect that is in no list, one two effects,
// five one listed effect. --systems a,b: these systems; --worlds N: at most so many; --keep DIR: leaves each world's folder there;
// --threads N of discover (2); --limit S: seconds of wall time that it has (60). Worlds that stand in the file are skipped.

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "tests/benchmark/strangers/bench.h"

namespace {

using namespace strangers;

#ifndef MISFIT_PROGRAM
#define MISFIT_PROGRAM "build/release/misfit"
#endif

struct Options {
  std::map<std::string, std::string> texts = {
      {"--program", MISFIT_PROGRAM}, {"--seeds", "0:8"}, {"--systems", ""},  {"--worlds", "1000000"}, {"--keep", ""},
      {"--out", "strangers.jsonl"},  {"--summary", ""},  {"--threads", "2"}, {"--limit", "60"},       {"--processor-limit", "0"}};
  bool parse(int argc, char** argv) {
    for (int i = 1; i + 1 < argc; i += 2) {
      const auto at = texts.find(argv[i]);
      if (at == texts.end()) return false;
      at->second = argv[i + 1];
    }
    return argc % 2 == 1 && texts["--seeds"].find(':') != std::string::npos;
  }
};

std::vector<nlohmann::json> read_rows(const std::string& file) {
  std::vector<nlohmann::json> rows;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    nlohmann::json row = nlohmann::json::parse(line, nullptr, false);
    if (row.is_object()) rows.push_back(std::move(row));
  }
  return rows;
}

std::vector<System> chosen_systems(const std::string& names) {
  std::vector<System> all = all_systems();
  if (names.empty()) return all;
  std::vector<System> out;
  std::stringstream list(names);
  for (std::string name; std::getline(list, name, ',');) {
    const auto found = std::find_if(all.begin(), all.end(), [&](const System& s) { return s.name == name; });
    if (found == all.end()) throw std::invalid_argument("no system " + name);
    out.push_back(*found);
  }
  return out;
}

void run_all(Options& options) {
  auto& texts = options.texts;
  Bench bench;
  bench.program = std::filesystem::absolute(texts["--program"]);
  bench.keep = !texts["--keep"].empty();
  bench.folder = bench.keep
                     ? std::filesystem::absolute(texts["--keep"])
                     : std::filesystem::temp_directory_path() / ("strangers_" + std::to_string(std::hash<std::string>()(texts["--out"])));
  bench.threads = std::stoi(texts["--threads"]);
  bench.limit = std::stod(texts["--limit"]);
  bench.processor_limit = std::stod(texts["--processor-limit"]);
  if (!std::filesystem::exists(bench.program)) throw std::invalid_argument("no program " + bench.program.string());
  std::set<std::pair<std::string, int>> done;
  for (const auto& row : read_rows(texts["--out"])) done.emplace(row["system"], row["seed"]);
  const std::vector<System> systems = chosen_systems(texts["--systems"]);
  const std::string& seeds = texts["--seeds"];
  int left = std::stoi(texts["--worlds"]);
  for (int seed = std::stoi(seeds); seed < std::stoi(seeds.substr(seeds.find(':') + 1)); ++seed) {
    for (const auto& system : systems) {
      if (left-- <= 0) return;
      if (done.contains({system.name, seed})) continue;
      const nlohmann::json row = answer(draw_world(system, seed), bench);
      std::ofstream(texts["--out"], std::ios::app) << row.dump() << '\n';
      std::string hidden;
      for (const auto& h : row.value("hidden", nlohmann::json::array())) hidden += " " + h["effect"].get<std::string>();
      std::printf("%s %d %s%s: drop %.1f, %s %s%s, %.1f s\n", system.name.c_str(), seed, row["kind"].get<std::string>().c_str(),
                  hidden.c_str(), row.value("oracle_drop", row.value("twin_drop", 0.0)), row["verdict"].get<std::string>().c_str(),
                  row.value("named", "").c_str(), row.value("first", false) ? " (right)" : "", row.value("seconds", 0.0));
      std::fflush(stdout);
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  if (!options.parse(argc, argv)) {
    std::fprintf(stderr,
                 "usage: %s [--program MISFIT] [--seeds A:B] [--systems A,B] [--worlds N] [--keep DIR] [--threads N] [--limit S] "
                 "[--processor-limit S] "
                 "[--out FILE.jsonl] | --summary FILE.jsonl\n",
                 argv[0]);
    return 2;
  }
  try {
    if (options.texts["--summary"].empty()) run_all(options);
    print_table(read_rows(options.texts["--summary"].empty() ? options.texts["--out"] : options.texts["--summary"]));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
