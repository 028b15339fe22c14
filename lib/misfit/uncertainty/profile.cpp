#include "misfit/uncertainty/profile.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "misfit/core/display.h"
#include "misfit/core/error.h"
#include "misfit/core/text.h"
#include "misfit/jobs/ranks.h"

namespace misfit {
namespace {

constexpr double limit_95 = 3.841458821;  // chi², 1 degree of freedom
constexpr double infinite = std::numeric_limits<double>::infinity();

struct Side {
  std::vector<double> value, drop;  ///< outwards
  double end = 0.0;
  bool found = false;
  std::string why;  ///< where not found
};

double scale_of(const ProfileRequest& r) { return r.plain_sigma > 0.0 ? std::pow(r.sigma / r.plain_sigma, 2) : 1.0; }

class Search {
 public:
  Search(const ProfileRequest& request, double direction)
      : request_(request), direction_(direction), limit_(limit_95 * scale_of(request)), held_(request.from_best()) {}

  Side run() {
    constexpr int max_steps = 20;
    double inside = request_.best, inside_root = 0.0;
    double step = 0.5 * request_.sigma;
    for (int k = 0; k < max_steps; ++k) {
      const double next = kept_inside(inside + direction_ * step);
      if (next == inside) return ended(inside, "the bound of " + request_.parameter + " is reached first");
      const std::optional<double> root = root_at(next);
      if (!root) return ended(inside, "at " + in_display_unit(next, request_.unit) + " the model cannot be estimated");
      if (*root >= std::sqrt(limit_)) {  // a rise of the likelihood, below 0, is no crossing however large
        refine(inside, inside_root, next, *root);
        return side_;
      }
      // Flat so rough_crossing: growth steps.
      constexpr int usual_steps = 6;
      constexpr double growth = 1.5;
      if (k >= usual_steps) step *= growth;
      inside = next;
      inside_root = *root;
    }
    return ended(inside, inside_root < 0.0 ? "the likelihood is higher there than at the estimate" : "the likelihood stays flat");
  }

 private:
  double kept_inside(double value) const { return std::clamp(value, request_.lower, request_.upper); }

  Side ended(double at, const std::string& why) {
    side_.end = at;
    side_.why = why;
    return side_;
  }

  /// sqrt of the drop; below 0 where the likelihood is higher than at the estimate.
  std::optional<double> root_at(double value) {
    const std::optional<double> objective = held_(value);
    if (!objective || !std::isfinite(*objective)) return std::nullopt;
    const double drop = 2.0 * (request_.objective - *objective);
    side_.value.push_back(value);
    side_.drop.push_back(drop);
    return std::copysign(std::sqrt(std::abs(drop)), drop);
  }

  /// The crossing between two values, by regula falsi on sqrt(drop): a step or two, more only where the likelihood had risen before.
  void refine(double inside, double inside_root, double outside, double outside_root) {
    const double wanted = std::sqrt(limit_);
    constexpr int most = 8;
    constexpr double good_crossing = 2e-3, rough_crossing = 0.05;
    double off = infinite;
    for (int k = 0; k < most && off > good_crossing; ++k) {
      const double share = (wanted - inside_root) / (outside_root - inside_root);
      const double middle = inside + share * (outside - inside);
      const std::optional<double> root = root_at(middle);
      if (!root) break;
      (*root >= wanted ? outside : inside) = middle;
      (*root >= wanted ? outside_root : inside_root) = *root;
      off = std::abs(*root / wanted - 1.0);
    }
    side_.end = inside + (wanted - inside_root) / (outside_root - inside_root) * (outside - inside);
    side_.found = off < rough_crossing;
    if (!side_.found)
      ended(inside, "between " + in_display_unit(inside, request_.unit) + " and " + in_display_unit(outside, request_.unit) +
                        " the profile is discontinuous or failed: refits reach different maxima");
  }

  const ProfileRequest& request_;
  double direction_, limit_;
  MaximumAtFixedValue held_;
  Side side_;
};

void add_words(LikelihoodProfile& p, const Side& below, const Side& above) {
  if (!below.found) p.words.push_back("no lower end: " + below.why + ", the search ended at " + in_display_unit(p.lower, p.unit));
  if (!above.found) p.words.push_back("no upper end: " + above.why + ", the search ended at " + in_display_unit(p.upper, p.unit));
  const double least = p.drop.empty() ? 0.0 : *std::min_element(p.drop.begin(), p.drop.end());
  constexpr double notable_departure = 0.2;
  if (least < -notable_departure)
    p.words.push_back("the likelihood is higher near the estimate than at it (drop " + format_value(least) +
                      "): the fit had not reached its maximum");
  if (std::abs(p.scale - 1.0) > notable_departure)
    p.words.push_back("autocorrelated residuals: drops are multiplied by " + format_value(1.0 / p.scale));
  if (!below.found || !above.found) return;
  const double left = p.best - p.lower, right = p.upper - p.best;
  if (std::abs(left - right) > notable_departure * 0.5 * (left + right))
    p.words.push_back("asymmetric: -" + in_display_unit(left, p.unit) + ", +" + in_display_unit(right, p.unit) +
                      "; a sigma does not describe it");
}

LikelihoodProfile joined(const ProfileRequest& r, const Side& below, const Side& above) {
  LikelihoodProfile out;
  out.method = r.method;
  out.parameter = r.parameter;
  out.unit = r.unit;
  out.best = r.best;
  out.sigma = r.sigma;
  out.plain_sigma = r.plain_sigma;
  out.scale = scale_of(r);
  std::vector<std::pair<double, double>> points{{r.best, 0.0}};
  for (const Side* side : {&below, &above}) {
    for (std::size_t i = 0; i < side->value.size(); ++i) points.emplace_back(side->value[i], side->drop[i]);
  }
  std::sort(points.begin(), points.end());
  for (const auto& [value, drop] : points) {
    out.value.push_back(value);
    out.drop.push_back(drop);
  }
  out.lower = below.end;
  out.upper = above.end;
  out.lower_found = below.found;
  out.upper_found = above.found;
  add_words(out, below, above);
  return out;
}

std::vector<LikelihoodProfile> joined(const std::vector<ProfileRequest>& requests, const std::vector<Side>& sides) {
  std::vector<LikelihoodProfile> out;
  for (std::size_t i = 0; i < requests.size(); ++i) out.push_back(joined(requests[i], sides[2 * i], sides[2 * i + 1]));
  return out;
}

/// Job k: below the estimate of request k/2, or above it.
Side side_of(const std::vector<ProfileRequest>& requests, std::size_t k) { return Search(requests[k / 2], k % 2 == 0 ? -1.0 : 1.0).run(); }

/// `why`, a line's end, and numbers to the last bit.
std::string pack(const Side& side) {
  std::vector<double> numbers{side.found ? 1.0 : 0.0, side.end};
  numbers.insert(numbers.end(), side.value.begin(), side.value.end());
  numbers.insert(numbers.end(), side.drop.begin(), side.drop.end());
  return side.why + "\n" + pack_numbers(numbers);
}

Side unpack_side(const std::string& bytes) {
  const std::size_t line = bytes.find('\n');
  const std::vector<double> numbers = unpack_numbers(std::string_view(bytes).substr(line == std::string::npos ? 0 : line + 1));
  if (line == std::string::npos || numbers.size() < 2) throw RunError("a stored side of a profile cannot be understood");
  const auto first = numbers.begin() + 2, middle = first + (numbers.end() - first) / 2;
  return {{first, middle}, {middle, numbers.end()}, numbers[1], numbers[0] > 0.0, bytes.substr(0, line)};
}

void check(const std::vector<ProfileRequest>& requests) {
  for (const auto& r : requests) {
    if (!(r.sigma > 0.0) || !std::isfinite(r.sigma))
      throw InputError("profile of " + r.parameter + ": its sigma is " + format_value(r.sigma) + "; only a free parameter has a profile");
  }
}

}  // namespace

std::vector<LikelihoodProfile> profile_likelihood(const std::vector<ProfileRequest>& requests, int threads, const ProgressFn& progress,
                                                  const std::atomic<bool>* stop) {
  check(requests);
  std::vector<Side> sides(2 * requests.size());
  const auto job = [&](std::size_t k) { sides[k] = side_of(requests, k); };
  if (!run_jobs(sides.size(), threads, job, progress, stop)) throw RunError("profile: stopped before all sides were done");
  return joined(requests, sides);
}

std::optional<std::vector<LikelihoodProfile>> stored_profiles(const std::vector<ProfileRequest>& requests, const StoredJobs& jobs,
                                                              const ProgressFn& progress, const std::atomic<bool>* stop) {
  check(requests);
  StoredJobs all = jobs;
  all.count = 2 * requests.size();
  const auto stored = run_stored_jobs(
      all, [&](std::size_t k) { return pack(side_of(requests, k)); }, progress, stop);
  if (!stored) return std::nullopt;
  if (!ranks().first()) return std::vector<LikelihoodProfile>{};
  std::vector<Side> sides;
  for (std::size_t k = 0; k < stored->size(); ++k) sides.push_back(unpack_side(stored->result(k)));
  return joined(requests, sides);
}

}  // namespace misfit
