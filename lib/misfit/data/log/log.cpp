#include "misfit/data/log/log.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <set>

#include "misfit/core/error.h"
#include "misfit/core/mapped_file.h"
#include "misfit/core/shown.h"
#include "misfit/core/text.h"
#include "misfit/data/log/csv_log.h"
#include "misfit/data/log/readers.h"
#include "misfit/data/log/zip.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;

enum class Format { mat5, hdf5, npy, npz, ulog, dataflash, csv, refused };

struct Mark {
  std::size_t at;
  std::string_view bytes;
  Format format;
  std::string_view what_to_do;  ///< of one that is refused
};

using namespace std::string_view_literals;
constexpr auto classic_netcdf = "a classic NetCDF file is not read: write it as NetCDF 4 (nccopy -k nc4 FILE FILE4)"sv;
constexpr std::array marks = {
    Mark{0, "MATLAB 7.3"sv, Format::hdf5, ""},
    Mark{0, "\x89HDF\r\n\x1a\n"sv, Format::hdf5, ""},
    Mark{126, "IM"sv, Format::mat5, ""},
    Mark{126, "MI"sv, Format::mat5, ""},
    Mark{0, "\x93NUMPY"sv, Format::npy, ""},
    Mark{0, "ULog\x01\x12\x35"sv, Format::ulog, ""},
    Mark{0, "\xA3\x95"sv, Format::dataflash, ""},
    Mark{0, "PK\x03\x04"sv, Format::npz, ""},
    Mark{0, "PK\x05\x06"sv, Format::npz, ""},
    Mark{0, "PAR1"sv, Format::refused,
         "a Parquet file is not read: write it as CSV or NPZ (Python: pandas.read_parquet(FILE).to_csv(\"FILE.csv\"))"},
    Mark{0, "ARROW1"sv, Format::refused,
         "an Arrow file is not read: write it as CSV (Python: pandas.read_feather(FILE).to_csv(\"FILE.csv\"))"},
    Mark{0, "\xD0\xCF\x11\xE0"sv, Format::refused, "an Excel workbook (.xls) is not read: save the sheet as CSV"},
    Mark{0, "\x1F\x8B"sv, Format::refused, "a gzip archive: unpack it first (gunzip FILE)"},
    Mark{0, "7z\xBC\xAF\x27\x1C"sv, Format::refused, "a 7z archive: unpack it first"},
    Mark{0, "\x28\xB5\x2F\xFD"sv, Format::refused, "a zstd archive: unpack it first (unzstd FILE)"},
    Mark{0, "MDF "sv, Format::refused, "an MDF file is not read: write it as CSV or MAT (Python: asammdf)"},
    Mark{0, "#ROSBAG"sv, Format::refused, "a ROS bag is not read: write its topics as CSV (rostopic echo -p)"},
    Mark{0, "\x89MCAP0"sv, Format::refused, "an MCAP file is not read: write its topics as CSV"},
    Mark{0, "SQLite format 3"sv, Format::refused, "a database (ROS 2 bag?) is not read: write its topics as CSV"},
    Mark{0, "CDF\x01"sv, Format::refused, classic_netcdf},
    Mark{0, "CDF\x02"sv, Format::refused, classic_netcdf},
    Mark{0, "CDF\x05"sv, Format::refused, classic_netcdf},
    Mark{0, "TDSm"sv, Format::refused, "a TDMS file is not read: write it as CSV (Python: nptdms)"},
    Mark{0, "\x80\x04\x95"sv, Format::refused, "a pickle of Python is not read, for it is a program: save numbers as NPZ or CSV"},
    Mark{0, "RIFF"sv, Format::refused, "sound or film is not read as a log: write numbers as CSV, or give a film as video"},
};

struct Found {
  Format format = Format::csv;
  std::string what_to_do;
};

/// What a file of this ending has to begin with: text under such a name is a damaged or a renamed file, and no CSV.
struct Ending {
  std::string_view end, what;
};
constexpr std::array endings = {Ending{".mat", "MAT file"},  Ending{".h5", "HDF5 file"},     Ending{".hdf5", "HDF5 file"},
                                Ending{".hdf", "HDF5 file"}, Ending{".nc", "NetCDF 4 file"}, Ending{".npy", "NPY file"},
                                Ending{".npz", "NPZ file"},  Ending{".ulg", "ULog"},         Ending{".bin", "DataFlash log"}};
constexpr std::array sheets = {Ending{".xlsx", "an Excel workbook (.xlsx)"}, Ending{".ods", "a sheet of LibreOffice (.ods)"}};

Found format_of_bytes(std::string_view front) {
  for (const Mark& m : marks) {
    if (front.size() >= m.at && front.substr(m.at).starts_with(m.bytes)) return {m.format, std::string(m.what_to_do)};
  }
  constexpr std::size_t mat4_head = 20;
  const bool zeros = front.size() >= mat4_head && front.substr(0, mat4_head).find('\0') != std::string_view::npos;
  if (zeros) return {Format::refused, "its first bytes are of no format that is read"};
  return {};
}

std::string front_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string front(128, '\0');
  file.read(front.data(), static_cast<std::streamsize>(front.size()));
  front.resize(static_cast<std::size_t>(std::max<std::streamsize>(file.gcount(), 0)));
  return front;
}

/// Text is CSV under any other name, as under .xls, which many instruments give it.
Found format_of(const fs::path& path) {
  const std::string end = lower_case(path.extension().string());
  Found found = format_of_bytes(front_of(path));
  for (const Ending& sheet : sheets) {
    if (end == sheet.end && found.format == Format::npz)  // a ZIP archive, cut off perhaps
      return {Format::refused, fmt::format("{} is not read: save the sheet as CSV", sheet.what)};
  }
  if (found.format != Format::csv) return found;
  for (const Ending& ending : endings) {
    if (end == ending.end) {
      return {Format::refused, fmt::format("called {}, but its first bytes are those of no {}: damaged, or a text, which is read as .csv",
                                           end, ending.what)};
    }
  }
  return found;
}

/// XLSX, ODS and others are ZIP archives too, whatever they are called.
void refuse_other_archive(const Bytes& bytes, const std::vector<ZipMember>& members) {
  const auto has = [&](std::string_view name) {
    return std::any_of(members.begin(), members.end(), [&](const ZipMember& m) { return m.name.find(name) != std::string::npos; });
  };
  if (has(".npy")) return;
  const std::string office = has("xl/") ? "an Excel workbook (.xlsx)" : has("content.xml") ? "a sheet of LibreOffice (.ods)" : "";
  if (!office.empty()) throw InputError({bytes.source(), 0, 0}, office + " is not read: save the sheet as CSV");
  throw InputError({bytes.source(), 0, 0}, "a ZIP archive without arrays (.npy): unpack it first, and give one of its files");
}

/// A reader over a mapped file, which lives as long as it.
class MappedReader : public LogReader {
 public:
  MappedReader(const fs::path& path, Format format) : file_(path), bytes_(path.string(), file_.bytes()) {
    reader_ = make(path, format);
    log_ = reader_->log();
  }

 protected:
  void read_values(const std::vector<std::size_t>& channels) override {
    reader_->read(channels);
    for (const std::size_t c : channels) log_.channels[c].values = reader_->release(c);
  }

 private:
  std::unique_ptr<LogReader> make(const fs::path& path, Format format) {
    if (format == Format::mat5) return read_mat5(bytes_);
    if (format == Format::npy) return read_npy(bytes_, path.stem().string());
    if (format == Format::ulog) return read_ulog(bytes_);
    if (format == Format::dataflash) return read_dataflash(bytes_);
    refuse_other_archive(bytes_, zip_members(bytes_));
    return read_npz(bytes_);
  }

  MappedFile file_;
  Bytes bytes_;
  std::unique_ptr<LogReader> reader_;
};

/// HDF5 allows a block of the user's own in front: the mark then stands at 512, 1024, …
bool has_hdf5_mark(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  constexpr std::streamoff last = 1 << 16;
  for (std::streamoff at = 512; at <= last; at *= 2) {
    std::string mark(8, '\0');
    if (!file.seekg(at) || !file.read(mark.data(), 8)) return false;
    if (mark == "\x89HDF\r\n\x1a\n"sv) return true;
  }
  return false;
}

}  // namespace

namespace {

/// The channels that `name` may be: the one of that name, or all that end with it.
std::vector<std::size_t> meant_by(const Log& log, const std::string& name) {
  std::vector<std::size_t> ends;
  for (std::size_t i = 0; i < log.channels.size(); ++i) {
    const std::string& own = log.channels[i].name;
    if (own == name) return {i};
    if (own.ends_with("." + name) || own.ends_with("/" + name)) ends.push_back(i);
  }
  return ends;
}

}  // namespace

std::optional<std::size_t> Log::find(const std::string& name) const {
  const std::vector<std::size_t> meant = meant_by(*this, name);
  return meant.size() == 1 ? std::optional(meant.front()) : std::nullopt;
}

std::size_t Log::index_of(const std::string& name) const {
  const std::vector<std::size_t> meant = meant_by(*this, name);
  if (meant.size() == 1) return meant.front();
  std::vector<std::string> names;
  for (const std::size_t i : meant) names.push_back(channels[i].name);
  if (!names.empty())
    throw InputError({source, 0, 0}, "'" + shown(name) + "' may be one of " + some_names(name, names) + ": write it in full");
  for (const LogChannel& c : channels) names.push_back(c.name);
  throw InputError({source, 0, 0}, "no channel '" + shown(name) + "'" + suggest(name, names));
}

void LogReader::read(const std::vector<std::size_t>& channels) {
  std::set<std::size_t> missing;
  for (const std::size_t c : channels) {
    if (log_.channels.at(c).values.empty()) missing.insert(c);
  }
  if (!missing.empty()) read_values({missing.begin(), missing.end()});
}

std::unique_ptr<LogReader> open_log(const fs::path& path) {
  const MappedFile readable(path);  // throws if not
  const Found found = format_of(path);
  if (found.format == Format::refused && has_hdf5_mark(path)) return read_hdf5(path);
  if (found.format == Format::refused) throw InputError({path.string(), 0, 0}, found.what_to_do + "; read are " + formats_of_logs());
  if (found.format == Format::hdf5) return read_hdf5(path);
  if (found.format == Format::csv) return read_csv_log(path);
  return std::make_unique<MappedReader>(path, found.format);
}

bool is_binary_log(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error) && format_of(path).format != Format::csv;
}

bool is_recording_name(std::string_view name) {
  constexpr std::array<std::string_view, 14> ends = {".csv", ".txt", ".dat", ".tsv", ".mat", ".h5",  ".hdf5",
                                                     ".hdf", ".nc",  ".npy", ".npz", ".ulg", ".bin", ".log"};
  return std::any_of(ends.begin(), ends.end(), [&](std::string_view end) { return name.ends_with(end); });
}

std::string formats_of_logs() { return "CSV, MAT, HDF5, NPY, NPZ, ULog and DataFlash .bin"; }

}  // namespace misfit
