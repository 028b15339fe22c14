#include "apps/terminal.h"

#include <fcntl.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <streambuf>
#include <string>
#include <system_error>
#include <tuple>

#include "misfit/core/shown.h"

namespace misfit {

/// Hands on at once what it gets, but for the bytes of a character that has not ended yet.
class PrintableStream::Buffer : public std::streambuf {
 public:
  explicit Buffer(std::streambuf* to) : to_(to) {}

  Escapes escapes = Escapes::plain;
  bool colours = false;

  [[nodiscard]] std::streambuf* to() const { return to_; }
  [[nodiscard]] int error() const { return error_; }

  void end() { hand_on(pending_.size()); }

 protected:
  int_type overflow(int_type c) override {
    if (traits_type::eq_int_type(c, traits_type::eof())) return traits_type::not_eof(c);
    const char one = traits_type::to_char_type(c);
    return xsputn(&one, 1) == 1 ? c : traits_type::eof();
  }

  std::streamsize xsputn(const char* text, std::streamsize size) override {
    pending_.append(text, size);
    return hand_on(pending_.size() - unfinished_bytes(pending_)) ? size : 0;
  }

  int sync() override {
    errno = 0;
    return noted(to_->pubsync() == 0) ? 0 : -1;
  }

 private:
  bool hand_on(std::size_t bytes) {
    const std::string text = passed(std::string_view(pending_).substr(0, bytes));
    pending_.erase(0, bytes);
    const auto size = static_cast<std::streamsize>(text.size());
    errno = 0;
    return noted(to_->sputn(text.data(), size) == size);
  }

  /// Printable, but for the sequences that may pass.
  [[nodiscard]] std::string passed(std::string_view text) const {
    if (!colours) return printable(text, escapes);
    std::string out;
    while (!text.empty()) {
      const std::size_t escape = std::min(text.find('\033'), text.size());
      out += printable(text.substr(0, escape), escapes);
      text.remove_prefix(escape);
      const auto known = std::find_if(terminal_colours::all.begin(), terminal_colours::all.end(),
                                      [&](std::string_view sequence) { return text.starts_with(sequence); });
      const std::size_t length = known != terminal_colours::all.end() ? known->size() : std::min<std::size_t>(text.size(), 1);
      out += known != terminal_colours::all.end() ? std::string(*known) : printable(text.substr(0, length), escapes);
      text.remove_prefix(length);
    }
    return out;
  }

  bool noted(bool good) {
    if (!good && error_ == 0) error_ = errno;
    return good;
  }

  std::streambuf* to_;
  std::string pending_;
  int error_ = 0;  ///< errno of the first failure, where there was one
};

PrintableStream::PrintableStream(std::ostream& stream) : stream_(stream), buffer_(std::make_unique<Buffer>(stream.rdbuf())) {
  stream_.rdbuf(buffer_.get());
}

PrintableStream::~PrintableStream() {
  buffer_->end();
  stream_.rdbuf(buffer_->to());
}

void PrintableStream::use_json_escapes() { buffer_->escapes = Escapes::json; }

void PrintableStream::allow_colours() { buffer_->colours = true; }

std::string PrintableStream::failure() {
  stream_.flush();
  if (stream_.good()) return {};
  return buffer_->error() == 0 ? "it cannot be written to" : std::generic_category().message(buffer_->error());
}

TextStyle terminal_style() {
  TextStyle style;
  if (::isatty(STDOUT_FILENO) != 1) return style;
  constexpr std::size_t narrowest = 40;
  winsize size{};
  if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) {
    style.table = std::max<std::size_t>(size.ws_col - 1, narrowest);
    style.width = std::min(style.table, style.width);
  }
  const char* no_colour = std::getenv("NO_COLOR");
  const char* terminal = std::getenv("TERM");
  const bool refused = no_colour != nullptr && *no_colour != '\0';
  style.colour = !refused && terminal != nullptr && std::string_view(terminal) != "dumb";
  return style;
}

void reserve_standard_streams() {
  for (const int number : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(number, F_GETFD) >= 0 || errno != EBADF) continue;
    std::ignore = ::open(number == STDOUT_FILENO ? "/dev/full" : "/dev/null", O_RDWR);  // takes the lowest free number
  }
}

}  // namespace misfit
