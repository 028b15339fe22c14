#include "misfit/uncertainty/chain_result.h"

#include <algorithm>

#include "misfit/core/error.h"
#include "misfit/jobs/checkpoint.h"
#include "misfit/jobs/ranks.h"

namespace misfit {
namespace {

constexpr char succeeded = '+', failed = '-';
constexpr std::size_t max_reasons = 20;
constexpr const char* other_reasons = "other reasons";

}  // namespace

std::string pack(const ChainResult& result) {
  return result.numbers.empty() ? failed + result.failure : succeeded + pack_numbers(result.numbers);
}

ChainResult unpack_result(std::string_view bytes) {
  if (bytes.empty() || (bytes.front() != succeeded && bytes.front() != failed)) throw RunError("a stored run cannot be understood");
  const std::string_view rest = bytes.substr(1);
  if (bytes.front() == failed) return {{}, std::string(rest)};
  return {unpack_numbers(rest), ""};
}

std::optional<std::vector<ChainResult>> stored_runs(const std::function<ChainResult(std::size_t)>& run, const StoredJobs& jobs,
                                                    const ProgressFn& progress, const std::atomic<bool>* stop) {
  const auto stored = run_stored_jobs(
      jobs, [&](std::size_t k) { return pack(run(k)); }, progress, stop);
  if (!stored) return std::nullopt;
  std::vector<ChainResult> results;
  if (!ranks().first()) return results;
  for (std::size_t k = 0; k < stored->size(); ++k) results.push_back(unpack_result(stored->result(k)));
  return results;
}

void count_failure(const std::string& reason, std::map<std::string, std::size_t>& failures) {
  const bool room = failures.size() < max_reasons || failures.contains(reason);
  ++failures[room ? reason : other_reasons];
}

const std::string& most_frequent(const std::map<std::string, std::size_t>& failures) {
  return std::max_element(failures.begin(), failures.end(), [](const auto& a, const auto& b) { return a.second < b.second; })->first;
}

}  // namespace misfit
