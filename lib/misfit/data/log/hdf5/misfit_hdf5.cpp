// misfit_hdf5 list FILE        a line per array of numbers: A, path, group, unit, column-major or not, shape; separated by tabs
//                              N and a sentence: what was left out. The last line is E.
// misfit_hdf5 read FILE N…     the numbers of the arrays N, counted from 0 as they are listed, as doubles of this machine, in order of the
// file Status 1 and a sentence on stderr: the library refuses the file. Started by hdf5_reader.cpp.

#include <hdf5.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

namespace {

/// Closes an object of the library at the end of its scope.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  [[nodiscard]] hid_t id() const { return id_; }
  [[nodiscard]] bool ok() const { return id_ >= 0; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

struct Array {
  std::string path, member;  ///< member of a compound type; empty: the number itself
  std::string unit;
  std::vector<hsize_t> shape;
  bool matlab = false;
};

struct Contents {
  std::vector<Array> arrays;
  std::vector<std::string> notes;
  hsize_t file_size = 0;
};

herr_t keep_reason(unsigned /*level*/, const H5E_error2_t* error, void* text) {
  if (error->desc != nullptr) *static_cast<std::string*>(text) = error->desc;
  return 0;
}

[[noreturn]] void refuse(const std::string& what) {
  std::string reason;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, keep_reason, &reason);
  std::fprintf(stderr, "%s%s%s\n", what.c_str(), reason.empty() ? "" : ": ", reason.c_str());
  std::_Exit(1);
}

/// A text attribute; empty if there is none.
std::string text_attribute(hid_t object, const char* name) {
  if (H5Aexists(object, name) <= 0) return "";
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  const Handle type(attribute.ok() ? H5Aget_type(attribute.id()) : -1, H5Tclose);
  const Handle space(attribute.ok() ? H5Aget_space(attribute.id()) : -1, H5Sclose);
  if (!type.ok() || !space.ok() || H5Tget_class(type.id()) != H5T_STRING || H5Sget_simple_extent_npoints(space.id()) != 1) return "";
  if (H5Tis_variable_str(type.id()) > 0) {
    char* text = nullptr;
    const Handle memory(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(memory.id(), H5T_VARIABLE);
    H5Tset_cset(memory.id(), H5Tget_cset(type.id()));
    if (H5Aread(attribute.id(), memory.id(), static_cast<void*>(&text)) < 0 || text == nullptr) return "";
    std::string out(text);
    H5free_memory(text);
    return out;
  }
  constexpr std::size_t longest = 1000;
  const std::size_t size = H5Tget_size(type.id());
  if (size == 0 || size > longest) return "";
  std::vector<char> text(size + 1, '\0');
  if (H5Aread(attribute.id(), type.id(), text.data()) < 0) return "";
  return text.data();
}

/// One line, without tabs.
std::string line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\t' || c == '\n'; }, ' ');
  return text;
}

bool is_number(hid_t type) {
  const H5T_class_t kind = H5Tget_class(type);
  return kind == H5T_INTEGER || kind == H5T_FLOAT || kind == H5T_ENUM;
}

std::vector<hsize_t> shape_of(hid_t dataset) {
  const Handle space(H5Dget_space(dataset), H5Sclose);
  const int rank = space.ok() && H5Sget_simple_extent_type(space.id()) == H5S_SIMPLE ? H5Sget_simple_extent_ndims(space.id()) : 0;
  std::vector<hsize_t> shape(static_cast<std::size_t>(std::max(rank, 0)));
  if (rank > 0) H5Sget_simple_extent_dims(space.id(), shape.data(), nullptr);
  return shape;
}

/// No compression makes more numbers of a byte of the file than this.
bool can_be_in(hsize_t file_size, const std::vector<hsize_t>& shape) {
  constexpr hsize_t most_ratio = 1100;
  hsize_t most = file_size * most_ratio;
  for (const hsize_t n : shape) {
    if (n > most) return false;
    if (n > 0) most /= n;
  }
  return true;
}

void add_members(const std::string& path, hid_t type, const Array& common, Contents& out) {
  const int members = H5Tget_nmembers(type);
  for (int i = 0; i < members; ++i) {
    const Handle member(H5Tget_member_type(type, static_cast<unsigned>(i)), H5Tclose);
    char* name = H5Tget_member_name(type, static_cast<unsigned>(i));
    if (name == nullptr || !member.ok()) continue;
    Array array = common;
    array.member = name;
    H5free_memory(name);
    if (is_number(member.id())) {
      out.arrays.push_back(array);
    } else {
      out.notes.push_back("'" + path + "." + array.member + "' is left out: only numbers are read");
    }
  }
}

void add_dataset(const std::string& path, hid_t dataset, Contents& out) {
  const Handle type(H5Dget_type(dataset), H5Tclose);
  const std::string matlab = text_attribute(dataset, "MATLAB_class");
  std::string unit = text_attribute(dataset, "units");
  if (unit.empty()) unit = text_attribute(dataset, "unit");
  const Array array{path, "", line(unit), shape_of(dataset), !matlab.empty()};
  if (!type.ok() || array.shape.empty() || matlab == "char" || H5Aexists(dataset, "MATLAB_empty") > 0) return;
  if (!can_be_in(out.file_size, array.shape)) {
    out.notes.push_back("'" + path + "' is left out: more numbers than the file can hold");
  } else if (is_number(type.id())) {
    out.arrays.push_back(array);
  } else if (H5Tget_class(type.id()) == H5T_COMPOUND && matlab.empty()) {
    add_members(path, type.id(), array, out);
  } else {
    out.notes.push_back("'" + path + "' is left out: only arrays of numbers are read");
  }
}

herr_t visit(hid_t root, const char* name, const H5O_info_t* info, void* data) {
  auto& out = *static_cast<Contents*>(data);
  const std::string path(name);
  if (info->type != H5O_TYPE_DATASET || path.find('#') == 0) return 0;  // #refs#, #subsystem#: MATLAB's own
  const Handle dataset(H5Dopen2(root, name, H5P_DEFAULT), H5Dclose);
  if (!dataset.ok()) {
    out.notes.push_back("'" + path + "' is left out: the library cannot open it");
  } else {
    add_dataset(path, dataset.id(), out);
  }
  return 0;
}

Contents contents_of(hid_t file) {
  Contents out;
  H5Fget_filesize(file, &out.file_size);
  if (H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_INC, visit, &out, H5O_INFO_BASIC) < 0) refuse("its contents cannot be listed");
  return out;
}

void list(const Contents& contents) {
  for (const Array& a : contents.arrays) {
    const auto slash = a.path.rfind('/');
    std::string name = a.path, group = slash == std::string::npos ? "" : a.path.substr(0, slash);
    if (!a.member.empty()) {
      group = a.path;
      name += "/" + a.member;
    }
    if (a.matlab) {
      std::replace(name.begin(), name.end(), '/', '.');
      std::replace(group.begin(), group.end(), '/', '.');
    }
    std::printf("A\t%s\t%s\t%s\t%d", line(name).c_str(), line(group).c_str(), a.unit.c_str(), a.matlab ? 1 : 0);
    std::vector<hsize_t> shape = a.shape;
    if (a.matlab) std::reverse(shape.begin(), shape.end());
    for (const hsize_t n : shape) std::printf("\t%llu", static_cast<unsigned long long>(n));
    std::printf("\n");
  }
  for (const std::string& note : contents.notes) std::printf("N\t%s\n", line(note).c_str());
  std::printf("E\n");
}

/// In slabs of about a million numbers.
void read(hid_t file, const Array& array) {
  const Handle dataset(H5Dopen2(file, array.path.c_str(), H5P_DEFAULT), H5Dclose);
  if (!dataset.ok()) refuse("'" + array.path + "' cannot be opened");
  const Handle type(array.member.empty() ? H5Tcopy(H5T_NATIVE_DOUBLE) : H5Tcreate(H5T_COMPOUND, sizeof(double)), H5Tclose);
  if (!array.member.empty()) H5Tinsert(type.id(), array.member.c_str(), 0, H5T_NATIVE_DOUBLE);
  const Handle space(H5Dget_space(dataset.id()), H5Sclose);
  hsize_t row = 1;
  for (std::size_t i = 1; i < array.shape.size(); ++i) row *= array.shape[i];
  constexpr hsize_t slab = 1 << 20;
  const hsize_t rows = std::max<hsize_t>(1, slab / std::max<hsize_t>(row, 1));
  std::vector<double> values;
  for (hsize_t at = 0; at < array.shape[0] && row > 0; at += rows) {
    std::vector<hsize_t> start(array.shape.size(), 0), count = array.shape;
    start[0] = at;
    count[0] = std::min(rows, array.shape[0] - at);
    values.resize(count[0] * row);
    const Handle memory(H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr), H5Sclose);
    if (H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr) < 0 ||
        H5Dread(dataset.id(), type.id(), memory.id(), space.id(), H5P_DEFAULT, values.data()) < 0)
      refuse("the numbers of '" + array.path + "' cannot be read");
    if (std::fwrite(values.data(), sizeof(double), values.size(), stdout) != values.size()) std::_Exit(1);
  }
}

/// A damaged file may make the library loop, or want memory without end.
void limit(const char* path) {
  struct stat status {};
  const rlim_t size = ::stat(path, &status) == 0 ? static_cast<rlim_t>(status.st_size) : 0;
  constexpr rlim_t least_seconds = 10, bytes_per_second = 4'000'000;
  const rlimit seconds{least_seconds + size / bytes_per_second, least_seconds + size / bytes_per_second};
  ::setrlimit(RLIMIT_CPU, &seconds);
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
#ifndef __SANITIZE_ADDRESS__  // which maps terabytes
  constexpr rlim_t least_memory = rlim_t{2} << 30U;
  const rlimit memory{least_memory + size, least_memory + size};
  ::setrlimit(RLIMIT_AS, &memory);
#endif
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  limit(argv[2]);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const Handle file(H5Fopen(argv[2], H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!file.ok()) refuse("it cannot be opened");
  const Contents contents = contents_of(file.id());
  if (std::strcmp(argv[1], "list") == 0) {
    list(contents);
  } else {
    for (int i = 3; i < argc; ++i) {
      const auto n = std::strtoull(argv[i], nullptr, 10);
      if (n >= contents.arrays.size()) return 2;
      read(file.id(), contents.arrays[n]);
    }
  }
  std::_Exit(std::fflush(stdout) == 0 ? 0 : 1);  // the library has nothing to put in order
}
