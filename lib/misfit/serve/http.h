#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>

namespace misfit::serve {

/// A request that has passed the guard: from this machine, for this server, with its token.
struct Ask {
  std::string method;  ///< "GET", "POST"
  std::string path;    ///< "/api/state"
  std::map<std::string, std::string> parameters;
  std::string body;
};

struct Answer {
  int status = 200;
  std::string body;
  std::string type = "application/json";
};

/// A server for one reader on this machine. Every request must name this server as its Host and, where it says so, as its Origin; all but
/// the assets need the token (header X-Misfit-Token; for the page itself ?token=). A request has 10 seconds and 1.2 MB; 16 are answered at
/// a time, 48 wait, what comes beyond is refused.
class HttpServer {
 public:
  using Handler = std::function<Answer(const Ask&)>;  ///< several threads call it at once

  /// Binds 127.0.0.1:port (0: a free one). RunError if that cannot be done.
  HttpServer(int port, std::string token, Handler handler);
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  [[nodiscard]] int port() const;
  /// "http://127.0.0.1:PORT/?token=TOKEN"
  [[nodiscard]] std::string address() const;
  /// Answers until the process is interrupted.
  void run();

 private:
  class Server;
  std::unique_ptr<Server> server_;
};

/// 128 bits from the kernel, as 32 hexadecimal digits.
[[nodiscard]] std::string random_token();

}  // namespace misfit::serve
