// What others on this machine, other pages in the same browser, and names in a study may try: misfit open refuses all of it.
#include <gmock/gmock.h>

#include <array>

#include "tests/apps/oscillator_study.h"
#include "tests/serve/page_server.h"

namespace {

using namespace program;
using testing::AnyOf;
using testing::HasSubstr;
using testing::Not;

const std::vector<std::string> all_questions = {"/api/state",  "/api/motion",      "/api/where",  "/api/samples", "/api/candidates",
                                                "/api/curves", "/api/calibration", "/api/ladder", "/api/study",   "/api/session"};
const std::vector<std::string> all_orders = {"/api/job", "/api/stop", "/api/check", "/api/save"};

/// A page without results.
class Attacked : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    study = new OscillatorStudy;
    server = new PageServer({study->path("study.toml").string()});
  }
  static void TearDownTestSuite() {
    delete server;
    delete study;
  }
  static std::string token() { return "\r\nX-Misfit-Token: " + server->token(); }
  static std::string own() { return "Host: " + server->host(); }
  static void expect_alive() { EXPECT_EQ(server->get("/api/state").status, 200); }

  static inline OscillatorStudy* study = nullptr;
  static inline PageServer* server = nullptr;
};

TEST_F(Attacked, TheOwnerIsAnswered) {
  EXPECT_EQ(server->get("/?token=" + server->token(), own()).status, 200);
  EXPECT_EQ(server->state()["study"]["name"], "an oscillator");
}

TEST_F(Attacked, AnotherHostIsRefused) {
  for (const std::string& host : {std::string("evil.example"), "evil.example:" + std::to_string(server->port()), std::string("127.0.0.1"),
                                  "127.0.0.1.evil.example:" + std::to_string(server->port())}) {
    EXPECT_EQ(server->get("/api/state", "Host: " + host + token()).status, 403) << host;
    EXPECT_EQ(server->get("/page.js", "Host: " + host).status, 403) << host;
  }
  EXPECT_EQ(server->get("/api/state", "X-Misfit-Token: " + server->token()).status, 403) << "no host";
  EXPECT_EQ(server->get("/api/state", own() + "\r\nHost: evil.example" + token()).status, 403) << "two hosts";
}

TEST_F(Attacked, AnotherOriginIsRefused) {
  for (const char* origin : {"http://evil.example", "null", "http://127.0.0.1:1", "https://127.0.0.1", "file://"}) {
    EXPECT_EQ(server->get("/api/state", own() + token() + "\r\nOrigin: " + origin).status, 403) << origin;
    EXPECT_EQ(server->post("/api/stop", "{}", own() + token() + "\r\nOrigin: " + origin).status, 403) << origin;
  }
  EXPECT_EQ(server->post("/api/stop", "{}", own() + token() + "\r\nSec-Fetch-Site: cross-site").status, 403);
  EXPECT_EQ(server->post("/api/stop", "{}", own() + token() + "\r\nOrigin: http://" + server->host()).status, 200);
}

TEST_F(Attacked, WithoutItsTokenNothingIsTold) {
  const std::string wrong = std::string(31, '0') + "1";
  for (const std::string& path : all_questions) {
    EXPECT_EQ(server->get(path, own()).status, 403) << path;
    EXPECT_EQ(server->get(path + "?token=" + server->token(), own()).status, 403) << path;  // a link is no permission
    EXPECT_EQ(server->get(path, own() + "\r\nX-Misfit-Token: " + wrong).status, 403) << path;
    EXPECT_EQ(server->get(path, own() + "\r\nX-Misfit-Token: ").status, 403) << path;
  }
  for (const std::string& path : all_orders) EXPECT_EQ(server->post(path, "{}", own()).status, 403) << path;
  EXPECT_EQ(server->get("/", own()).status, 403);
  EXPECT_EQ(server->get("/?token=" + wrong, own()).status, 403);
  EXPECT_THAT(server->get("/api/study", own()).body, Not(HasSubstr("oscillator")));
}

TEST_F(Attacked, TokensAreNotThoseOfAnotherServer) {
  const PageServer other({study->path("study.toml").string()});
  EXPECT_NE(other.token(), server->token());
  EXPECT_EQ(other.get("/api/state", "Host: " + other.host() + token()).status, 403);
}

TEST_F(Attacked, APathInAParameterIsNoPath) {
  const std::vector<std::string> values = {"../../../etc/passwd",
                                           "%2e%2e%2f%2e%2e%2fetc%2fpasswd",
                                           "/etc/passwd",
                                           "-1",
                                           "1e3",
                                           "0x1",
                                           "1%20",
                                           "99999999999999999999999",
                                           "",
                                           "%00",
                                           "$(id)",
                                           "1;id"};
  for (const std::string& value : values) {
    for (const char* question :
         {"/api/motion?method=", "/api/motion?model=", "/api/where?model=", "/api/samples?experiment=", "/api/samples?quantity=",
          "/api/samples?model=", "/api/added?model=", "/api/added?experiment=", "/api/added?candidate=", "/api/frame?film=",
          "/api/frame?t=", "/api/candidates?model=", "/api/curves?model=", "/api/study?model="}) {
      const Reply reply = server->get(std::string(question) + value);
      EXPECT_EQ(reply.status, 400) << question << value;
      EXPECT_THAT(reply.body, Not(HasSubstr("root:"))) << question << value;
    }
  }
}

TEST_F(Attacked, APathIsNoFile) {
  for (const char* path : {"/../../../../etc/passwd", "/..%2f..%2f..%2fetc/passwd", "/study.toml", "/out/run.json", "//etc/passwd",
                           "/page.js/../study.toml", "/api/../etc/passwd", "/api/"}) {
    const Reply reply = server->get(path);
    EXPECT_THAT(reply.status, AnyOf(400, 404)) << path;
    EXPECT_THAT(reply.body, Not(AnyOf(HasSubstr("root:"), HasSubstr("oscillator")))) << path;
  }
  for (const char* method : {"PUT", "DELETE", "OPTIONS", "PATCH"})
    EXPECT_EQ(server->raw(std::string(method) + " /api/state HTTP/1.1\r\n" + own() + token() + "\r\n\r\n").status, 405) << method;
}

TEST_F(Attacked, OnlyVerbsEffectsAndNamesThatAreKnownAreRun) {
  for (const char* verb : {"", "batch", "init", "open", "export", "run; id", "--version", "../misfit", "run\n"})
    EXPECT_EQ(server->post("/api/job", {{"verb", verb}}).status, 400) << verb;
  for (const char* effect : {"", "--out", "--out=/tmp/x", "$(touch x)", "../coulomb_friction", "coulomb_friction;id", "system:/etc/passwd"})
    EXPECT_EQ(server->post("/api/job", {{"verb", "add"}, {"effect", effect}}).status, 400) << effect;
  for (const auto& [what, name, value] : std::vector<std::array<std::string, 3>>{{"free", "k", "yes"},
                                                                                 {"free", "k=1 --out", "true"},
                                                                                 {"free", "../k", "true"},
                                                                                 {"free", "", "true"},
                                                                                 {"value", "k", "3"},
                                                                                 {"roughness", "k", "auto"},
                                                                                 {"validation", "steps", "1"},
                                                                                 {"validation", "steps", "1 2]\nseed = 3"},
                                                                                 {"validation", "steps", "nan 2"},
                                                                                 {"validation", "$(id)", "1 2"}})
    EXPECT_EQ(server->post("/api/job", {{"verb", "set"}, {"what", what}, {"name", name}, {"value", value}}).status, 400)
        << what << name << value;
  for (const char* body : {"[]", "{", "\"run\"", "{\"verb\": 1}", "{\"verb\": [\"run\"]}"})
    EXPECT_EQ(server->post("/api/job", body, own() + token()).status, 400) << body;
  EXPECT_EQ(server->state()["job"]["state"], "none");
  EXPECT_FALSE(fs::exists(study->path("out"))) << "nothing was recorded, and looking makes no folder";
}

TEST_F(Attacked, HugeBodiesAreNotRead) {
  const std::string head = "POST /api/check HTTP/1.1\r\n" + own() + token() + "\r\nContent-Type: application/json\r\n";
  EXPECT_THAT(server->raw(head + "Content-Length: 2000000\r\n\r\n" + std::string(2'000'000, ' ')).status, AnyOf(413, 0));
  EXPECT_THAT(server->raw(head + "Content-Length: 99999999999\r\n\r\n" + std::string(3'000'000, ' ')).status, AnyOf(413, 400, 0));
  std::string chunks = head + "Transfer-Encoding: chunked\r\n\r\n";
  for (int k = 0; k < 40; ++k) chunks += "10000\r\n" + std::string(0x10000, ' ') + "\r\n";
  EXPECT_THAT(server->raw(chunks).status, AnyOf(413, 400, 0));
  expect_alive();
}

TEST_F(Attacked, EndlessHeadersAreNotRead) {
  std::string head = "GET /api/state HTTP/1.1\r\n" + own() + token() + "\r\n";
  for (int k = 0; k < 400'000; ++k) head += "X-" + std::to_string(k) + ": y\r\n";
  EXPECT_THAT(server->raw(head + "\r\n").status, AnyOf(400, 0));
  EXPECT_THAT(server->get("/" + std::string(100'000, 'a')).status, AnyOf(414, 400, 0));
  EXPECT_THAT(server->get("/api/state", own() + token() + "\r\nX-Long: " + std::string(1'000'000, 'a')).status, AnyOf(400, 0));
  expect_alive();
}

TEST_F(Attacked, AThousandConnectionsAreOutlived) {
  std::vector<int> idle;
  for (int k = 0; k < 1000; ++k) {
    const int socket = connect_to(server->port());
    if (socket >= 0) idle.push_back(socket);
  }
  EXPECT_GT(idle.size(), 500U);
  std::size_t threads = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator("/proc/" + std::to_string(server->process()) + "/task")) ++threads;
  EXPECT_LT(threads, 40U);
  Reply reply;
  for (int k = 0; k < 60 && reply.status != 200; ++k) {
    reply = server->get("/api/state");
    if (reply.status != 200) std::this_thread::sleep_for(std::chrono::seconds(1));
  }
  EXPECT_EQ(reply.status, 200);
  for (const int socket : idle) ::close(socket);
  expect_alive();
}

TEST_F(Attacked, NothingListensBeyondLoopback) {
  int here = 0;
  for (const char* table : {"/proc/net/tcp", "/proc/net/tcp6"}) {
    std::ifstream lines(table);
    std::string line;
    char port[8];
    std::snprintf(port, sizeof port, ":%04X", static_cast<unsigned>(server->port()));
    while (std::getline(lines, line)) {
      std::istringstream cells(line);
      std::string number, local, remote, state;
      cells >> number >> local >> remote >> state;
      if (state != "0A" || !local.ends_with(port)) continue;  // 0A: listens
      EXPECT_EQ(local.substr(0, local.find(':')), "0100007F") << line;
      ++here;
    }
  }
  EXPECT_EQ(here, 1);
}

TEST_F(Attacked, ThePageRunsNoScriptThatStandsInIt) {
  const Reply page = server->get("/?token=" + server->token(), own());
  EXPECT_THAT(page.head, HasSubstr("Content-Security-Policy: default-src 'none'; script-src 'self'; style-src 'self';"));
  EXPECT_THAT(page.head, Not(HasSubstr("unsafe")));
  EXPECT_THAT(page.head, HasSubstr("X-Content-Type-Options: nosniff"));
  EXPECT_THAT(page.head, HasSubstr("Referrer-Policy: no-referrer"));
  EXPECT_THAT(page.body, Not(AnyOf(HasSubstr("<script>"), HasSubstr("style="), HasSubstr("onclick"))));
  EXPECT_THAT(page.body, Not(HasSubstr("oscillator"))) << "the page is the same for every study";
  EXPECT_THAT(server->get("/api/state").head, HasSubstr("application/json"));
}

}  // namespace
