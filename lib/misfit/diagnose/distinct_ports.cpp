#include "misfit/diagnose/distinct_ports.h"

#include "misfit/core/lists.h"
#include "misfit/model/rate_port.h"

namespace misfit {

std::vector<int> sought_at(const SystemSpec& system, const ForceSensitivity& force) {
  const int ports = int_size(system.dynamic_ports);
  std::vector<int> out;
  for (int port = 0; port < ports; ++port) {
    out.push_back(port);
    if (!is_rate_port(system.dynamic_ports[port])) continue;
    for (int declared = 0; declared < ports; ++declared) {
      if (is_rate_port(system.dynamic_ports[declared]) || !force.are_multiples(port, declared)) continue;
      out.back() = declared;
      break;
    }
  }
  return out;
}

std::vector<int> distinct_ports(const SystemSpec& system, const ForceSensitivity& force) {
  const std::vector<int> places = sought_at(system, force);
  std::vector<int> out;
  for (int port = 0; port < int_size(places); ++port) {
    if (places[port] == port) out.push_back(port);
  }
  return out;
}

}  // namespace misfit
