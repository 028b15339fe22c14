#include <iostream>

#include "apps/verbs.h"
#include "misfit/core/error.h"
#include "misfit/serve/serve.h"

namespace misfit {

int open_verb(const Options& options, const Registry& registry) {
  ServeOptions serving;
  serving.session = options.session;
  serving.port = options.port;
  serving.ready = [&](const std::string& address) {
    std::cout << "The page of " << options.session.study << ", for this machine alone; Ctrl-C ends it:\n" << address << std::endl;
    if (!std::cout) throw RunError("the address of the page cannot be printed, so that nobody could open it");
  };
  serve_page(serving, registry);
  return 0;
}

}  // namespace misfit
