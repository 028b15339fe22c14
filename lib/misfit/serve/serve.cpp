#include "misfit/serve/serve.h"

#include "misfit/serve/api.h"
#include "misfit/serve/http.h"

namespace misfit {
namespace {

std::string own_path() {
  constexpr const char* self = "/proc/self/exe";
  std::error_code error;
  const std::filesystem::path path = std::filesystem::read_symlink(self, error);
  return error ? self : path.string();
}

}  // namespace

void serve_page(const ServeOptions& options, const Registry& registry) {
  // Both now: a program that is replaced while the server runs (an upgrade) is found by its name.
  (void)hash_of_program();
  serve::Api api(options.session, registry, options.program.empty() ? own_path() : options.program);
  serve::HttpServer server(options.port, serve::random_token(), [&](const serve::Ask& ask) { return api.answer(ask); });
  if (options.ready) options.ready(server.address());
  server.run();
}

}  // namespace misfit
