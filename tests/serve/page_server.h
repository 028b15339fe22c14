#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <csignal>
#include <thread>

#include "tests/apps/program.h"

/// `misfit open` as a process of its own, and a client that says what no browser would.
namespace program {

struct Reply {
  int status = 0;  ///< 0: closed without an answer
  std::string head, body;

  [[nodiscard]] json parsed() const { return json::parse(body); }
};

/// A connection to 127.0.0.1; -1 where there is none.
inline int connect_to(int port) {
  const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) return socket;
  ::close(socket);
  return -1;
}

/// Sends as much of `text` as is taken.
inline void send_all(int socket, const std::string& text) {
  for (std::size_t at = 0; at < text.size();) {
    const ssize_t n = ::send(socket, text.data() + at, text.size() - at, MSG_NOSIGNAL);
    if (n <= 0) return;
    at += static_cast<std::size_t>(n);
  }
}

inline Reply receive(int socket) {
  std::string all;
  char buffer[8192];
  for (ssize_t n = 0; (n = ::recv(socket, buffer, sizeof buffer, 0)) > 0;) all.append(buffer, static_cast<std::size_t>(n));
  ::close(socket);
  Reply reply;
  const std::size_t end = all.find("\r\n\r\n");
  if (end == std::string::npos || !all.starts_with("HTTP/1.1 ")) return reply;
  reply.status = std::stoi(all.substr(9, 3));
  reply.head = all.substr(0, end);
  reply.body = all.substr(end + 4);
  return reply;
}

class PageServer {
 public:
  explicit PageServer(const std::vector<std::string>& words) {
    std::vector<std::string> arguments{"open"};
    arguments.insert(arguments.end(), words.begin(), words.end());
    child_ = start(captured_.path(), arguments);
    const std::regex printed(R"(http://127\.0\.0\.1:(\d+)/\?token=([0-9a-f]{32})\n)");
    for (int k = 0; k < 600 && port_ == 0; ++k) {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      const std::string said = content(captured_.path() / "stdout");
      if (std::smatch match; std::regex_search(said, match, printed)) {
        port_ = std::stoi(match[1]);
        token_ = match[2];
      }
    }
    EXPECT_GT(port_, 0) << content(captured_.path() / "stderr");
  }
  ~PageServer() {
    if (child_ > 0) (void)end();
  }
  PageServer(const PageServer&) = delete;
  PageServer& operator=(const PageServer&) = delete;

  [[nodiscard]] int port() const { return port_; }
  [[nodiscard]] pid_t process() const { return child_; }
  [[nodiscard]] const std::string& token() const { return token_; }
  [[nodiscard]] std::string host() const { return "127.0.0.1:" + std::to_string(port_); }
  [[nodiscard]] std::string address() const { return "http://" + host() + "/?token=" + token_; }

  /// Exactly these bytes.
  [[nodiscard]] Reply raw(const std::string& text) const {
    const int socket = connect_to(port_);
    if (socket < 0) return {};
    send_all(socket, text);
    return receive(socket);
  }
  [[nodiscard]] Reply get(const std::string& path) const { return get(path, "Host: " + host() + "\r\nX-Misfit-Token: " + token_); }
  [[nodiscard]] Reply get(const std::string& path, const std::string& head) const {
    return raw("GET " + path + " HTTP/1.1\r\n" + head + "\r\n\r\n");
  }
  [[nodiscard]] Reply post(const std::string& path, const json& body) const {
    return post(path, body.dump(), "Host: " + host() + "\r\nX-Misfit-Token: " + token_);
  }
  [[nodiscard]] Reply post(const std::string& path, const std::string& body, const std::string& head) const {
    return raw("POST " + path + " HTTP/1.1\r\n" + head +
               "\r\nContent-Type: application/json\r\nContent-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body);
  }
  [[nodiscard]] json state() const { return get("/api/state").parsed(); }
  /// The command that is at work, when it has ended.
  [[nodiscard]] json job() const {
    json job = state()["job"];
    for (int k = 0; k < 6000 && job["state"] == "running"; ++k) {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      job = state()["job"];
    }
    return job;
  }

  /// As Ctrl-C.
  Outcome end() {
    ::kill(child_, SIGINT);
    Outcome outcome = finish(captured_.path(), child_);
    child_ = 0;
    return outcome;
  }
  void kill() {
    ::kill(child_, SIGKILL);
    (void)finish(captured_.path(), child_);
    child_ = 0;
  }

 private:
  TemporaryFolder captured_;
  pid_t child_ = 0;
  int port_ = 0;
  std::string token_;
};

}  // namespace program
