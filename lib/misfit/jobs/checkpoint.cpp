#include "misfit/jobs/checkpoint.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <system_error>
#include <tuple>

#include "misfit/core/files.h"
#include "misfit/core/written_files.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;
using Word = std::array<char, 8>;

constexpr std::uint64_t fnv_start = 14695981039346656037ULL;
constexpr std::uint64_t largest_record = 1ULL << 32;  // more is no size but rubbish

Word bytes_of(std::uint64_t number) {
  Word word;
  std::memcpy(word.data(), &number, word.size());
  return word;
}

std::uint64_t number_of(const Word& word) {
  std::uint64_t number = 0;
  std::memcpy(&number, word.data(), word.size());
  return number;
}

std::uint64_t checksum(std::string_view bytes, std::uint64_t hash = fnv_start) {
  constexpr std::uint64_t prime = 1099511628211ULL;
  for (const unsigned char c : bytes) hash = (hash ^ c) * prime;
  return hash;
}

std::string_view view(const Word& word) { return {word.data(), word.size()}; }

constexpr std::string_view head_start = "misfit checkpoint ";

std::string head_of(const std::string& digest) { return std::string(head_start) + "1 " + digest + "\n"; }

std::string record_of(std::uint64_t job, std::string_view bytes) {
  std::string record;
  record.reserve(bytes.size() + 3 * sizeof(Word));
  record.append(view(bytes_of(job))).append(view(bytes_of(bytes.size()))).append(bytes);
  return record.append(view(bytes_of(checksum(record))));
}

/// True if a whole record that holds was read.
bool read_record(std::istream& in, CheckpointEntry& entry, std::string& bytes) {
  Word job, size, sum;
  if (!in.read(job.data(), 8) || !in.read(size.data(), 8)) return false;
  entry.job = number_of(job);
  entry.size = number_of(size);
  if (entry.size > largest_record) return false;
  bytes.resize(entry.size);
  if (!in.read(bytes.data(), static_cast<std::streamsize>(entry.size)) || !in.read(sum.data(), 8)) return false;
  return number_of(sum) == checksum(bytes, checksum(view(size), checksum(view(job))));
}

/// A checkpoint is written where no file is, or over one that begins as a checkpoint does (as far as it goes).
bool begins_as_ours(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::string start(head_start.size(), '\0');
  in.read(start.data(), static_cast<std::streamsize>(start.size()));
  start.resize(in.gcount());
  return head_start.starts_with(start);
}

/// WriteError where something lies that is no checkpoint.
void refuse_foreign(const fs::path& path) { check_place(path.parent_path(), path.filename().string(), {}, begins_as_ours(path)); }

std::string reason(int code) { return std::generic_category().message(code); }

std::int64_t seconds_now() {
  return std::chrono::duration_cast<std::chrono::seconds>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

CheckpointContent read_checkpoint(const fs::path& path, const std::string& digest) {
  CheckpointContent content;
  std::ifstream in(path, std::ios::binary);
  const std::string head = head_of(digest);
  std::string start(head.size(), '\0');
  if (!in.read(start.data(), static_cast<std::streamsize>(start.size())) || start != head) return content;
  content.ours = true;
  content.valid = head.size();
  CheckpointEntry entry;
  std::string bytes;
  while (read_record(in, entry, bytes)) {
    entry.offset = content.valid + 2 * sizeof(Word);
    content.valid = entry.offset + entry.size + sizeof(Word);
    content.entries.push_back(entry);
  }
  return content;
}

CheckpointWriter::CheckpointWriter(fs::path path, const std::string& digest) : path_(std::move(path)), synced_(seconds_now()) {
  refuse_foreign(path_);
  file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
  if (file_ < 0) throw WriteError(path_.string() + " cannot be written: " + reason(errno));
  try {
    if (::flock(file_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
      throw RunError("another misfit is at work in " + path_.parent_path().string());
    const CheckpointContent before = read_checkpoint(path_, digest);
    length_ = before.valid;
    if (::ftruncate(file_, static_cast<off_t>(length_)) != 0) throw WriteError(path_.string() + " cannot be written: " + reason(errno));
    if (!before.ours) write_whole(head_of(digest));
  } catch (...) {
    ::close(file_);
    throw;
  }
}

CheckpointWriter::~CheckpointWriter() { ::close(file_); }

void CheckpointWriter::write_whole(std::string_view bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t n = ::pwrite(file_, bytes.data() + done, bytes.size() - done, static_cast<off_t>(length_ + done));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) {
      const std::string why = reason(n == 0 ? ENOSPC : errno);
      std::ignore = ::ftruncate(file_, static_cast<off_t>(length_)) == 0;  // if not, the checksum finds it
      throw WriteError(path_.string() + " cannot be written: " + why +
                       "; what was finished before is in it, and the same command continues from there");
    }
    done += n;
  }
  length_ += bytes.size();
}

void CheckpointWriter::append(std::uint64_t job, std::string_view bytes) {
  constexpr std::int64_t between_syncs = 5;
  const std::string record = record_of(job, bytes);
  const std::lock_guard lock(mutex_);
  write_whole(record);
  if (seconds_now() - synced_ < between_syncs) return;
  synced_ = seconds_now();
  flush();
}

void CheckpointWriter::sync() {
  const std::lock_guard lock(mutex_);
  flush();
}

void CheckpointWriter::flush() {
  if (::fdatasync(file_) != 0) throw WriteError(path_.string() + " cannot be written: " + reason(errno));
}

std::string read_checkpoint_entry(const fs::path& path, const CheckpointEntry& entry) {
  std::ifstream in(path, std::ios::binary);
  std::string bytes(entry.size, '\0');
  in.seekg(static_cast<std::streamoff>(entry.offset));
  if (!in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()))) throw RunError(path.string() + " has changed while it was read");
  return bytes;
}

bool is_checkpoint_of_ours(const fs::path& path) {
  std::error_code none;
  return fs::symlink_status(path, none).type() == fs::file_type::regular && begins_as_ours(path);
}

std::string pack_numbers(const std::vector<double>& numbers) {
  std::string bytes(numbers.size() * sizeof(double), '\0');
  if (!numbers.empty()) std::memcpy(bytes.data(), numbers.data(), bytes.size());
  return bytes;
}

std::vector<double> unpack_numbers(std::string_view bytes) {
  if (bytes.size() % sizeof(double) != 0) throw RunError("a stored result is not a list of numbers");
  std::vector<double> numbers(bytes.size() / sizeof(double));
  if (!numbers.empty()) std::memcpy(numbers.data(), bytes.data(), bytes.size());
  return numbers;
}

}  // namespace misfit
