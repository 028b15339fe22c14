#include "misfit/serve/http.h"

#include <fmt/format.h>
#include <httplib.h>
#include <poll.h>
#include <sys/random.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <optional>
#include <thread>

#include "misfit/core/error.h"
#include "misfit/core/watch.h"
#include "misfit/page/assets.h"

namespace misfit::serve {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t threads = 16, waiting = 48;
constexpr std::size_t most_of_body = 1 << 20, most_of_request = most_of_body + (1 << 18);
constexpr std::chrono::seconds to_begin{2}, to_ask{10}, to_take{60};

/// One connection, with limits of bytes and time that httplib has not.
class Connection : public httplib::Stream {
 public:
  explicit Connection(int socket) : socket_(socket) {}
  ~Connection() override {
    ::shutdown(socket_, SHUT_RDWR);
    ::close(socket_);
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// Something has come before `to_begin` is over.
  [[nodiscard]] bool begins() const { return ready(POLLIN, Clock::now() + to_begin); }
  [[nodiscard]] bool is_readable() const override { return begin_ < end_ || ready(POLLIN, begun_ + to_ask); }
  [[nodiscard]] bool is_writable() const override { return ready(POLLOUT, begun_ + to_take); }
  ssize_t read(char* to, std::size_t size) override {
    if (begin_ == end_ && !fill()) return -1;
    const std::size_t n = std::min(size, end_ - begin_);
    std::memcpy(to, buffer_.data() + begin_, n);
    begin_ += n;
    return static_cast<ssize_t>(n);
  }
  ssize_t write(const char* from, std::size_t size) override {
    return is_writable() ? ::send(socket_, from, size, MSG_NOSIGNAL | MSG_DONTWAIT) : -1;
  }
  void get_remote_ip_and_port(std::string& /*ip*/, int& /*port*/) const override {}
  void get_local_ip_and_port(std::string& /*ip*/, int& /*port*/) const override {}
  [[nodiscard]] socket_t socket() const override { return socket_; }

 private:
  [[nodiscard]] bool ready(short event, Clock::time_point until) const {
    pollfd one{socket_, event, 0};
    for (;;) {
      const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(until - Clock::now()).count();
      if (left <= 0 || interrupted()) return false;
      const int n = ::poll(&one, 1, static_cast<int>(std::min<long>(left, 200)));
      if (n > 0) return true;
      if (n < 0 && errno != EINTR) return false;
    }
  }
  bool fill() {
    if (total_ >= most_of_request || !is_readable()) return false;
    const ssize_t n = ::recv(socket_, buffer_.data(), buffer_.size(), 0);
    if (n <= 0) return false;
    begin_ = 0;
    end_ = static_cast<std::size_t>(n);
    total_ += end_;
    return true;
  }

  int socket_;
  Clock::time_point begun_ = Clock::now();
  std::array<char, 16384> buffer_{};
  std::size_t begin_ = 0, end_ = 0, total_ = 0;
};

thread_local bool too_many = false;

/// Threads for requests: what comes beyond those that are answered and those that wait is closed at once.
class Workers : public httplib::TaskQueue {
 public:
  Workers() : pool_(threads) {}
  void enqueue(std::function<void()> answer) override {
    if (open_ >= threads + waiting) {
      too_many = true;
      answer();
      too_many = false;
      return;
    }
    ++open_;
    pool_.enqueue([this, answer = std::move(answer)] {
      answer();
      --open_;
    });
  }
  void shutdown() override { pool_.shutdown(); }

 private:
  std::atomic<std::size_t> open_ = 0;
  httplib::ThreadPool pool_;
};

/// In a time that does not depend on where they differ.
bool same(const std::string& a, const std::string& b) {
  unsigned different = a.size() == b.size() ? 0U : 1U;
  for (std::size_t i = 0; i < a.size() && i < b.size(); ++i) different |= static_cast<unsigned char>(a[i] ^ b[i]);
  return different == 0;
}

void put(const Answer& answer, httplib::Response& to) {
  to.status = answer.status;
  to.set_content(answer.body, answer.type);
}

Answer refusal(int status, const std::string& why) { return {status, why + "\n", "text/plain; charset=utf-8"}; }

[[noreturn]] void refuse_port(int port) {
  if (port <= 0) throw RunError("no free port on 127.0.0.1: end another server, or give one with --port N");
  throw RunError(fmt::format(
      "port {} of 127.0.0.1 cannot be used: another program has it, or it needs root (below 1024); choose another with --port N, "
      "or leave --port out for a free one",
      port));
}

const httplib::Headers headers = {
    {"Content-Security-Policy",
     "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; connect-src 'self'; base-uri 'none'; "
     "form-action 'none'; frame-ancestors 'none'"},
    {"X-Content-Type-Options", "nosniff"},
    {"Referrer-Policy", "no-referrer"},
    {"Cross-Origin-Resource-Policy", "same-origin"},
    {"Cross-Origin-Opener-Policy", "same-origin"},
    {"Cache-Control", "no-store"}};

}  // namespace

class HttpServer::Server : public httplib::Server {
 public:
  Server(int port, std::string token, HttpServer::Handler handler) : token_(std::move(token)), handler_(std::move(handler)) {
    new_task_queue = [] { return new Workers; };
    set_socket_options([](socket_t socket) {  // not SO_REUSEPORT: nobody else may listen beside
      const int yes = 1;
      ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    set_payload_max_length(most_of_body);
    set_default_headers(headers);
    set_pre_routing_handler([this](const httplib::Request& ask, httplib::Response& to) { return before_body(ask, to); });
    for (const char* path : {"/api/job", "/api/stop", "/api/check", "/api/save"})
      Post(path, [this](const httplib::Request& ask, httplib::Response& to) { put(answer(ask), to); });
    set_exception_handler(
        [](const httplib::Request&, httplib::Response& to, std::exception_ptr) {  // NOLINT(performance-unnecessary-value-param)
          put(refusal(500, "misfit could not answer this"), to);
        });
    port_ = port > 0 ? (bind_to_port("127.0.0.1", port) ? port : -1) : bind_to_any_port("127.0.0.1");
    if (port_ <= 0) refuse_port(port);
  }

  [[nodiscard]] int port() const { return port_; }
  [[nodiscard]] const std::string& token() const { return token_; }

 private:
  bool process_and_close_socket(socket_t socket) override {
    Connection connection(socket);
    if (too_many || !connection.begins()) return false;
    bool closed = false;
    // The page of this machine needs neither compression nor parts; one request per connection leaves nothing open.
    return process_request(connection, true, closed, [](httplib::Request& ask) {
      ask.headers.erase("Accept-Encoding");
      ask.headers.erase("Range");
      ask.ranges.clear();
    });
  }

  /// Everything but the bodies of POST. Whoever is refused is refused before his body is read.
  HandlerResponse before_body(const httplib::Request& ask, httplib::Response& to) {
    if (const auto refused = refuse(ask)) {
      put(*refused, to);
      return HandlerResponse::Handled;
    }
    if (ask.method == "POST") return HandlerResponse::Unhandled;
    put(ask.method == "GET" ? answer(ask) : refusal(405, "GET and POST only"), to);
    return HandlerResponse::Handled;
  }

  [[nodiscard]] std::optional<Answer> refuse(const httplib::Request& ask) const {
    if (ask.get_header_value_count("Host") != 1 || !is_own(ask.get_header_value("Host")))
      return refusal(403, "this address is not that of the page");
    if (ask.has_header("Origin") && !is_own_origin(ask)) return refusal(403, "another page may not ask");
    const std::string site = ask.get_header_value("Sec-Fetch-Site");
    if (ask.method == "POST" && !site.empty() && site != "same-origin") return refusal(403, "another page may not ask");
    if (ask.path != "/" && asset(ask.path) != nullptr) return std::nullopt;
    const std::string token = ask.path == "/" ? ask.get_param_value("token") : ask.get_header_value("X-Misfit-Token");
    if (!same(token, token_)) return refusal(403, "open the address that misfit has printed, with its token");
    return std::nullopt;
  }
  [[nodiscard]] bool is_own(const std::string& host) const {
    return host == fmt::format("127.0.0.1:{}", port_) || host == fmt::format("localhost:{}", port_);
  }
  [[nodiscard]] bool is_own_origin(const httplib::Request& ask) const {
    constexpr std::string_view scheme = "http://";
    const std::string origin = ask.get_header_value("Origin");
    return ask.get_header_value_count("Origin") == 1 && origin.starts_with(scheme) && is_own(origin.substr(scheme.size()));
  }

  static const page::Asset* asset(const std::string& path) {
    for (const page::Asset& one : page::assets()) {
      if (one.path == path) return &one;
    }
    return nullptr;
  }
  [[nodiscard]] Answer answer(const httplib::Request& ask) const {
    if (const page::Asset* one = ask.method == "GET" ? asset(ask.path) : nullptr)
      return {200, std::string(one->content), std::string(one->type)};
    Ask plain{ask.method, ask.path, {}, ask.body};
    for (const auto& [name, value] : ask.params) plain.parameters.emplace(name, value);
    return handler_(plain);
  }

  std::string token_;
  HttpServer::Handler handler_;
  int port_ = -1;
};

HttpServer::HttpServer(int port, std::string token, Handler handler)
    : server_(std::make_unique<Server>(port, std::move(token), std::move(handler))) {}

HttpServer::~HttpServer() = default;

int HttpServer::port() const { return server_->port(); }

std::string HttpServer::address() const { return fmt::format("http://127.0.0.1:{}/?token={}", server_->port(), server_->token()); }

void HttpServer::run() {
  std::atomic<bool> ended = false;
  std::thread listener([&] {
    server_->listen_after_bind();
    ended = true;
  });
  while (!interrupted() && !ended) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  while (!server_->is_running() && !ended) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  server_->stop();
  listener.join();
  if (!interrupted()) throw RunError("the system no longer takes connections to 127.0.0.1: the page has ended");
}

std::string random_token() {
  std::array<unsigned char, 16> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    throw RunError("the system gives no random numbers");
  std::string text;
  for (const unsigned char byte : bytes) text += fmt::format("{:02x}", byte);
  return text;
}

}  // namespace misfit::serve
