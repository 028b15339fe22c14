#include "misfit/serve/serve.h"

#include "misfit/serve/api.h"
#include "misfit/serve/http.h"

namespace misfit {

void serve_page(const ServeOptions& options, const Registry& registry) {
  serve::Api api(options.session, registry, options.program);
  serve::HttpServer server(options.port, serve::random_token(), [&](const serve::Ask& ask) { return api.answer(ask); });
  if (options.ready) options.ready(server.address());
  server.run();
}

}  // namespace misfit
