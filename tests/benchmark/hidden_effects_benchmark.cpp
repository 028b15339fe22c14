// Can what discover says be believed? Random worlds of our own simulator with something hidden in them, and what became of each.
//
//   hidden_effects_benchmark --kind all --worlds 0:40 --out hidden.csv          worlds 0 … 39 of each kind; those in the file are skipped
//   hidden_effects_benchmark --summary hidden.csv                               the table
//
// --kind null|effect|two|unlisted|all, --seconds LENGTH of flight (40, half of a wind-tunnel run: the drop grows with it), --threads N.
// Parts may run at different times, machines or orders and be put together with cat; a world depends on its kind, number and length alone.

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>

#include "misfit_hidden_effects_registry.h"
#include "misfit_models_registry.h"
#include "tests/benchmark/hidden_answer.h"
#include "tests/benchmark/known_truth.h"

namespace {

using namespace misfit;

void run(const bench::PartOptions& options) {
  Registry known, truth;
  misfit_models_register(known);
  misfit_models_register(truth);
  misfit_hidden_effects_register(truth);
  std::vector<bench::Row> done = bench::read_rows(options.out);
  for (int number = options.from; number < options.to; ++number) {
    for (const std::string kind : {"null", "effect", "unlisted", "two"}) {
      if (options.kind != "all" && options.kind != kind) continue;
      const bool known_already =
          std::any_of(done.begin(), done.end(), [&](const bench::Row& r) { return r.kind == kind && r.number == number; });
      if (known_already) continue;
      const bench::World world = bench::draw_world(kind, number, options.seconds, truth);
      const bench::Row row = bench::answer(world, options.seconds, known, truth, options.threads);
      bench::append_row(options.out, row);
      std::printf("%s %d %s drop %.1f: %s %s%s (nearest %s; predicted %.1f, actual %.1f; %.1f + %.1f s)\n", row.kind.c_str(), row.number,
                  row.hidden.c_str(), row.oracle_drop, row.verdict.c_str(), row.named.c_str(), row.quantity.c_str(), row.nearest.c_str(),
                  row.predicted_drop, row.actual_drop, row.fit_seconds, row.discover_seconds);
      std::fflush(stdout);
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  bench::PartOptions options;
  options.out = "hidden.csv";
  options.seconds = 40.0;
  if (!bench::parse(argc, argv, "--worlds", options)) {
    std::fprintf(stderr, "usage: %s [--kind K] [--worlds A:B] [--seconds S] [--threads N] [--out FILE.csv] | --summary FILE.csv\n",
                 argv[0]);
    return 2;
  }
  try {
    if (options.summary.empty()) run(options);
    bench::print_summary(bench::read_rows(options.summary.empty() ? options.out : options.summary));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
