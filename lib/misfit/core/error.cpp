#include "misfit/core/error.h"

#include <algorithm>
#include <cctype>
#include <numeric>

namespace misfit {
namespace {

std::string lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

/// Levenshtein distance in bytes, one row of the table at a time.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

std::string Source::text() const {
  if (file.empty()) return {};
  std::string out = file;
  if (line > 0) out.append(":").append(std::to_string(line));
  if (line > 0 && column > 0) out.append(":").append(std::to_string(column));
  return out;
}

InputError::InputError(const Source& where, const std::string& message)
    : std::runtime_error(where.file.empty() ? message : where.text() + ": " + message) {}

std::string nearest_name(std::string_view name, const std::vector<std::string>& valid) {
  if (name.empty()) return {};
  const std::string wanted = lower(name);
  std::string best;
  std::size_t best_distance = 0;
  for (const std::string& candidate : valid) {
    if (candidate.empty()) continue;
    const std::string other = lower(candidate);
    const std::size_t distance = edit_distance(wanted, other);
    const bool contained = other.find(wanted) != std::string::npos || wanted.find(other) != std::string::npos;
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
  std::string out = nearest.empty() ? " — valid: " : " — did you mean '" + nearest + "'? Valid: ";
  for (std::size_t i = 0; i < valid.size(); ++i) out += (i == 0 ? "" : ", ") + valid[i];
  return out;
}

}  // namespace misfit
