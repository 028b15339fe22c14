#pragma once

#include <map>
#include <string>

namespace misfit {

/// Unit of a coefficient or own state in its model. Effects that take any unit write roles in braces, "{port}/{rate}"; with port = "N m"
/// and rate = "rad/s" this is "N m s/rad"; a role may have a power, "{level}^0.5/s". Powers of the same symbol are added, what cancels is
/// left out, "-" if nothing remains. A role that is not in `units` counts as "-". A text without braces is returned as it is.
[[nodiscard]] std::string bind_unit(const std::string& unit, const std::map<std::string, std::string>& units);

}  // namespace misfit
