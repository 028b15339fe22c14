#pragma once

#include <functional>
#include <string>

#include "misfit/workflow/session/session.h"

namespace misfit {

/// What the page of a study is opened with.
struct ServeOptions {
  SessionOptions session;                         ///< study and run folder, as typed
  int port = 0;                                   ///< 0: a free one
  std::string program = {};                       ///< that does the work; empty: this one
  std::function<void(const std::string&)> ready;  ///< called with the address of the page when the server answers
};

/// Serves the page of a study on 127.0.0.1 until the process is interrupted (core/watch.h); a job that is at work then is stopped and
/// waited for. Opening does no work: the page shows what the run folder holds. RunError: the port is taken; InputError: there is no such
/// study.
void serve_page(const ServeOptions& options, const Registry& registry);

}  // namespace misfit
