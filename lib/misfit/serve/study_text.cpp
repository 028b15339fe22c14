#include "misfit/serve/study_text.h"

#include <algorithm>
#include <charconv>

#include "misfit/core/error.h"
#include "misfit/core/files.h"
#include "misfit/data/study_reader.h"
#include "misfit/model/declared.h"
#include "misfit/model/request.h"

namespace misfit::serve {
namespace {

namespace fs = std::filesystem;

/// Of a message that begins with "FILE:LINE".
TextFault fault_in(const fs::path& file, const std::string& message) {
  TextFault fault{message, 0};
  const std::string place = file.string() + ":";
  if (!message.starts_with(place)) return fault;
  const char* end = message.data() + message.size();
  const auto [after, error] = std::from_chars(message.data() + place.size(), end, fault.line);
  if (error != std::errc()) return {message, 0};
  return fault;
}

}  // namespace

std::optional<TextFault> fault_of(const fs::path& file, const std::string& text, const Registry& registry) {
  if (text.find('\0') != std::string::npos) return TextFault{"the text contains a byte 0", 0};
  try {
    const Study study = read_study_text(file, text);
    const std::shared_ptr<const Registry> declared = study_registry(study, registry);
    (void)read_model(study, *declared);
  } catch (const InputError& error) {
    return fault_in(file, error.what());
  } catch (const RunError& error) {
    return TextFault{error.what(), 0};
  }
  return std::nullopt;
}

std::optional<TextFault> save_text(const fs::path& file, const std::string& text, const std::string& hash_before,
                                   const Registry& registry) {
  if (auto fault = fault_of(file, text, registry)) return fault;
  std::error_code none;
  if (fs::symlink_status(file, none).type() != fs::file_type::regular)
    throw InputError(file.string() + ": is a link, which misfit does not write through: edit the file itself");
  if (hash_file(file) != hash_before)
    throw InputError(file.string() + ": was changed by somebody else since this page read it: reload it, and make the change again");
  const fs::perms mode = fs::status(file, none).permissions();
  write_atomically(file, text);
  fs::permissions(file, mode, none);
  return std::nullopt;
}

}  // namespace misfit::serve
