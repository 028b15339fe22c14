#pragma once

#include <memory>
#include <ostream>
#include <string>

#include "misfit/show/blocks.h"

namespace misfit {

/// While it lives, what is written to `stream` goes on with control characters (but newline and tab) and bytes that are no UTF-8 as "\x1b":
/// names and headers of a user's files cannot steer the terminal. Errors of writing are those of `stream`.
class PrintableStream {
 public:
  explicit PrintableStream(std::ostream& stream);
  ~PrintableStream();
  PrintableStream(const PrintableStream&) = delete;
  PrintableStream& operator=(const PrintableStream&) = delete;

  /// Escapes of JSON ("\u009b") from now on.
  void use_json_escapes();

  /// The sequences of terminal_colours (show/blocks.h) pass from now on.
  void allow_colours();

  /// Flushes; empty if all that was written has arrived, else why not.
  [[nodiscard]] std::string failure();

 private:
  class Buffer;
  std::ostream& stream_;
  std::unique_ptr<Buffer> buffer_;
};

/// Of standard output: the width of a terminal, at most 110 characters, and colour unless NO_COLOR is set or TERM is "dumb"; a pipe or a
/// file gets 110 characters without colour.
[[nodiscard]] TextStyle terminal_style();

/// Opens what stands in for standard input, output and error where the caller has closed them: else the first file of results would get
/// their numbers, and what is printed would land in it. Writing to a closed standard output fails, as it should.
void reserve_standard_streams();

}  // namespace misfit
