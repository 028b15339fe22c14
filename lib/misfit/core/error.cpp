#include "misfit/core/error.h"

#include <algorithm>

#include "misfit/core/edit_distance.h"
#include "misfit/core/shown.h"
#include "misfit/core/text.h"

namespace misfit {
std::string Source::text() const {
  if (file.empty()) return {};
  std::string out = file;
  if (line > 0) out.append(":").append(std::to_string(line));
  if (line > 0 && column > 0) out.append(":").append(std::to_string(column));
  return out;
}

InputError::InputError(const Source& where, const std::string& message)
    : std::runtime_error(where.file.empty() ? message : where.text() + ": " + message), where_(where) {}

std::string nearest_name(std::string_view name, const std::vector<std::string>& valid) {
  if (name.empty() || name.size() > longest_name_compared) return {};
  const std::string wanted = lower_case(name);
  std::string best;
  std::size_t best_distance = 0;
  for (const std::string& candidate : valid) {
    if (candidate.empty() || candidate.size() > longest_name_compared) continue;
    const std::string other = lower_case(candidate);
    const std::size_t distance = edit_distance(name, candidate);
    const bool most_of_it = 2 * other.size() >= wanted.size() && wanted.find(other) != std::string::npos;  // not the "ng" of "furlong"
    const bool contained = other.find(wanted) != std::string::npos || most_of_it;
    if (2 * distance > wanted.size() && !contained) continue;
    if (best.empty() || distance < best_distance) {
      best = candidate;
      best_distance = distance;
    }
  }
  return best;
}

std::string suggest(std::string_view name, const std::vector<std::string>& valid) {
  if (valid.empty()) return {};
  const std::string nearest = nearest_name(name, valid);
  return (nearest.empty() ? " — valid: " : " — did you mean '" + shown(nearest) + "'? Valid: ") + some_names(name, valid);
}

}  // namespace misfit
