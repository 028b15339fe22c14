// Do 95 % intervals hold the truth 95 times in 100? Flights of our own simulator, each estimated as a user would.
//
//   coverage_benchmark --method all --kind all --flights 0:1000 --out coverage.csv      those in the file are skipped
//   coverage_benchmark --summary coverage.csv                                           the table
//
// --method output_error|filter_error|all, --kind white|coloured|forced|all (output_error has no "forced": it says so itself),
// --seconds LENGTH of flight (20), --threads N flights at a time. Parts may run at different times and be put together with cat; a flight
// depends on its kind, number and length alone.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <mutex>
#include <set>
#include <string>
#include <tuple>

#include "misfit/core/error.h"
#include "misfit/fit/filter/filter_error.h"
#include "misfit/fit/shooting/output_error.h"
#include "misfit/fit/trajectory_start.h"
#include "misfit/inference/curves.h"
#include "misfit/jobs/work_queue.h"
#include "misfit_models_registry.h"
#include "tests/benchmark/coverage_flights.h"
#include "tests/benchmark/coverage_table.h"
#include "tests/benchmark/known_truth.h"

namespace {

using namespace misfit;
using bench::CoverageRow;

struct Options : bench::PartOptions {
  std::string method = "all";
};

struct Job {
  std::string method, kind;
  int number = 0;
};

/// Value and sigma of a curve between its grid points.
struct CurveValue {
  double value = 0.0, sigma = 0.0;
};

CurveValue at(const std::vector<CurveEstimate>& curves, const std::string& name, double x) {
  for (const auto& curve : curves) {
    if (curve.name != name) continue;
    for (std::size_t i = 1; i < curve.x.size(); ++i) {
      if (curve.x[i - 1] > x || curve.x[i] < x) continue;
      const double share = (x - curve.x[i - 1]) / (curve.x[i] - curve.x[i - 1]);
      return {curve.value[i - 1] + share * (curve.value[i] - curve.value[i - 1]),
              curve.sigma[i - 1] + share * (curve.sigma[i] - curve.sigma[i - 1])};
    }
  }
  return {std::nan(""), 0.0};
}

struct Answer {
  Fit fit;
  std::vector<CurveEstimate> plain;  ///< as if the residuals were white; empty where the method knows no other
};

Answer estimated(const std::string& method, const Model& asked, const std::vector<Signals>& experiments) {
  const FittedModel start = trajectory_start(asked, experiments).from;
  if (method == "output_error") {
    FittedModel fitted = output_error(start, experiments);
    Fit plain;
    if (fitted.plain_covariance.size() > 0)
      describe(fitted.model, fitted.plain_covariance,
               RowMatrix(0, static_cast<Eigen::Index>(fitted.model.system->spec().quantities.size())), plain);
    return {std::move(fitted.fit), std::move(plain.curves)};
  }
  FilterOptions options;
  options.threads = 1;
  return {filter_error(start, experiments, options).fit, {}};
}

std::vector<CoverageRow> look(const Job& job, double seconds, const Registry& registry) {
  const bench::CoverageFlight flight = bench::draw_flight(job.kind, job.number, seconds, registry);
  const std::vector<Signals> experiments{flight.signals};
  ModelRequest request = flight.request;
  constexpr int intervals = 16;
  choose_all_knots(request, registry, experiments, intervals);
  const Answer answer = estimated(job.method, assemble(request, registry), experiments);
  const Fit& fit = answer.fit;
  if (fit.status != FitStatus::converged)
    std::fprintf(stderr, "%s, %s, flight %d: %s: %s\n", job.method.c_str(), job.kind.c_str(), job.number, to_string(fit.status).c_str(),
                 fit.message.c_str());
  std::vector<CoverageRow> rows;
  const auto add = [&](const std::string& quantity, double truth, double value, double sigma, double plain) {
    rows.push_back(
        {job.method, job.kind, job.number, to_string(fit.status), quantity, truth, value, sigma, plain > 0.0 ? plain : std::nan("")});
  };
  const auto add_noise = [&](const std::string& quantity, double truth, const Estimate& e) {
    add(quantity, truth, e.value, e.sigma, 0.0);
    if (e.interval) std::tie(rows.back().low, rows.back().high) = *e.interval;
  };
  const auto plain = [&](const std::string& name) { return fit.plain_sigmas.contains(name) ? fit.plain_sigmas.at(name) : 0.0; };
  if (fit.status == FitStatus::converged || fit.status == FitStatus::not_converged) {
    for (const auto& name : flight.free) {
      const Estimate& e = fit.parameters.at(name);
      add(name, flight.truth.parameters[static_cast<std::size_t>(flight.truth.find_parameter(name))].value, e.value, e.sigma, plain(name));
    }
    if (fit.trim) add("trim", flight.trim, fit.trim->value, fit.trim->sigma, plain("trim"));
    for (std::size_t i = 0; i < flight.angles.size(); ++i) {
      const CurveValue value = at(fit.curves, "C_m", flight.angles[i]);
      add("C_m at " + std::to_string(10 + 20 * i) + " %", bench::curve_value(flight.truth, "C_m", flight.angles[i]), value.value,
          value.sigma, at(answer.plain, "C_m", flight.angles[i]).sigma);
    }
  }
  if (flight.force > 0.0 && fit.force.contains("correlation_time")) {
    const Estimate& time = fit.force.at("correlation_time");
    add_noise("correlation_time", flight.force_time, time);
    const auto force =
        std::find_if(fit.force.begin(), fit.force.end(), [](const auto& entry) { return entry.first != "correlation_time"; });
    if (force != fit.force.end()) add_noise("force", flight.force, force->second);  // common to all ports
  }
  add("end", 0.0, fit.seconds, 0.0, 0.0);
  return rows;
}

std::vector<Job> open_jobs(const Options& options) {
  std::set<std::string> done;
  const auto key = [](const std::string& method, const std::string& kind, int number) {
    return method + " " + kind + " " + std::to_string(number);
  };
  for (const auto& row : bench::read_coverage(options.out)) done.insert(key(row.method, row.kind, row.number));
  std::vector<Job> jobs;
  for (int number = options.from; number < options.to; ++number) {
    for (const std::string method : {"output_error", "filter_error"}) {
      for (const std::string kind : {"white", "coloured", "forced"}) {
        const bool asked = (options.method == "all" || options.method == method) && (options.kind == "all" || options.kind == kind);
        if (!asked || (method == "output_error" && kind == "forced") || done.contains(key(method, kind, number))) continue;
        jobs.push_back({method, kind, number});
      }
    }
  }
  return jobs;
}

void run(const Options& options) {
  Registry registry;
  misfit_models_register(registry);
  const std::vector<Job> jobs = open_jobs(options);
  std::mutex writing;
  run_jobs(jobs.size(), options.threads, [&](std::size_t k) {
    std::vector<CoverageRow> rows;
    try {
      rows = look(jobs[k], options.seconds, registry);
    } catch (const RunError& error) {
      rows = {{jobs[k].method, jobs[k].kind, jobs[k].number, "error", "end", 0.0, 0.0, 0.0, 0.0}};
      std::fprintf(stderr, "%s\n", error.what());
    }
    const std::lock_guard lock(writing);
    bench::append_coverage(options.out, rows);
  });
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  options.out = "coverage.csv";
  options.seconds = 20.0;
  options.threads = 1;
  if (!bench::parse(argc, argv, "--flights", options, {{"--method", &options.method}})) {
    std::fprintf(stderr,
                 "usage: %s [--method M] [--kind K] [--flights A:B] [--seconds S] [--threads N] [--out FILE.csv] | --summary FILE.csv\n",
                 argv[0]);
    return 2;
  }
  try {
    if (options.summary.empty()) run(options);
    bench::print_coverage(bench::read_coverage(options.summary.empty() ? options.out : options.summary));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
