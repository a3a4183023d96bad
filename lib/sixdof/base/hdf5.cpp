#include <sixdof/base/hdf5.h>

#include <algorithm>
#include <fstream>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sixdof/base/error.h>

namespace sixdof::hdf5 {
namespace {

/// Up to this many attributes stay inside the object's header, which has a checksum.
constexpr unsigned k_compact_attributes = 64;
constexpr unsigned k_deflate_level = 6;  ///< zlib's default.
/// deflate stores no more than 1,032 bytes in one (a match of 258 bytes in 2 bits).
constexpr double k_most_compression = 1032.0;
/// A file's first bytes: HDF5's signature, then the version of the superblock, which libver V110 writes.
constexpr std::string_view k_first_bytes{"\x89HDF\r\n\x1a\n\x03"};

std::mutex& library_mutex() {
  static std::mutex mutex;
  return mutex;
}

herr_t keep_first(unsigned /*depth*/, const H5E_error2_t* entry, void* out) {
  auto& words = *static_cast<std::string*>(out);
  if (words.empty() && entry->desc != nullptr) words = entry->desc;
  return 0;
}

/// The innermost entry of HDF5's error stack, e.g. "data error detected by Fletcher32 checksum"; clears the stack. Of
/// what the system refuses, its words alone ("No space left on device"): HDF5 adds the time and addresses.
std::string last_error() {
  std::string words;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_first, &words);
  H5Eclear2(H5E_DEFAULT);
  constexpr std::string_view k_systems_words = "error message = '";
  if (const std::size_t begin = words.find(k_systems_words); begin != std::string::npos) {
    words.erase(0, begin + k_systems_words.size());
    words.erase(std::min(words.find('\''), words.size()));
  }
  return words.empty() ? "no reason given" : words;
}

/// Without times of creation: the same content gives the same bytes.
Handle object_properties(hid_t property_class) {
  Handle list(H5Pcreate(property_class), H5Pclose);
  H5Pset_obj_track_times(list.id(), false);
  H5Pset_attr_phase_change(list.id(), k_compact_attributes, k_compact_attributes / 2);
  return list;
}

Handle file_access() {
  Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fclose_degree(access.id(), H5F_CLOSE_STRONG);
  return access;
}

}  // namespace

Session::Session() : lock_(library_mutex()) {
  // After a damaged file, HDF5 1.10 may fail to close itself at exit and print "infinite loop closing library". Handles
  // close themselves, so it need not. Without effect if the library is in use already.
  H5dont_atexit();
  H5open();
  H5Eget_auto2(H5E_DEFAULT, &old_handler_, &old_data_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

Session::~Session() { H5Eset_auto2(H5E_DEFAULT, old_handler_, old_data_); }

File File::open(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) throw BadFile(path.string(), "no such file");
  if (!std::filesystem::is_regular_file(path, error)) throw BadFile(path.string(), "not a regular file");
  std::string first(k_first_bytes.size(), '\0');
  std::ifstream(path, std::ios::binary).read(first.data(), static_cast<std::streamsize>(first.size()));
  if (first != k_first_bytes) throw BadFile(path.string(), "not a readable HDF5 file of this project, or damaged");
  Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, file_access().id()), H5Fclose);
  if (file.id() < 0) {
    throw BadFile(path.string(), fmt::format("not a readable HDF5 file, or damaged ({})", last_error()));
  }
  return {std::move(file), path.string()};
}

File File::create(const std::filesystem::path& path, const std::filesystem::path& shown_as) {
  const Handle access = file_access();
  H5Pset_libver_bounds(access.id(), H5F_LIBVER_V110, H5F_LIBVER_V110);
  const Handle creation = object_properties(H5P_FILE_CREATE);
  Handle file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation.id(), access.id()), H5Fclose);
  if (file.id() < 0) throw BadFile(shown_as.string(), fmt::format("cannot be written ({})", last_error()));
  return {std::move(file), shown_as.string()};
}

void File::close() {
  check(H5Fflush(file_.id(), H5F_SCOPE_LOCAL), "/", "cannot be written");
  Handle closing = std::move(file_);
}

void File::refuse(const std::string& object, const std::string& cause) const {
  throw BadFile(name_, object == "/" ? "root" : object, cause);
}

void File::check(hid_t result, const std::string& object, const std::string& what) const {
  if (result < 0) refuse(object, fmt::format("{} ({})", what, last_error()));
}

Handle File::checked(Handle handle, const std::string& object, const std::string& what) const {
  check(handle.id(), object, what);
  return handle;
}

bool File::exists(const std::string& object) const {
  const htri_t found = H5Lexists(file_.id(), object.c_str(), H5P_DEFAULT);
  check(found, object, "cannot be looked up");
  return found > 0;
}

void File::make_group(const std::string& object) {
  const Handle creation = object_properties(H5P_GROUP_CREATE);
  checked({H5Gcreate2(file_.id(), object.c_str(), H5P_DEFAULT, creation.id(), H5P_DEFAULT), H5Gclose}, object,
          "cannot be written");
}

std::vector<std::string> File::names(const std::string& group) const {
  std::vector<std::string> list;
  const auto add = [](hid_t, const char* name, const H5L_info_t*, void* out) -> herr_t {
    static_cast<std::vector<std::string>*>(out)->emplace_back(name);
    return 0;
  };
  check(H5Literate_by_name(file_.id(), group.c_str(), H5_INDEX_NAME, H5_ITER_INC, nullptr, add, &list, H5P_DEFAULT),
        group, "cannot be listed");
  return list;
}

bool File::has_attribute(const std::string& object, const char* name) const {
  const htri_t found = H5Aexists_by_name(file_.id(), object.c_str(), name, H5P_DEFAULT);
  check(found, object, fmt::format("attribute {} cannot be looked up", name));
  return found > 0;
}

void File::write_attribute(const std::string& object, const char* name, hid_t type, const void* value) {
  const std::string what = fmt::format("attribute {} cannot be written", name);
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle attribute = checked(
      {H5Acreate_by_name(file_.id(), object.c_str(), name, type, space.id(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
       H5Aclose},
      object, what);
  check(H5Awrite(attribute.id(), type, value), object, what);
}

void File::write_attribute(const std::string& object, const char* name, const std::string& value) {
  // HDF5 has no strings of length 0; the terminator makes them 1.
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.id(), value.size() + 1);
  H5Tset_cset(type.id(), H5T_CSET_UTF8);
  write_attribute(object, name, type.id(), value.c_str());
}

std::pair<Handle, Handle> File::open_attribute(const std::string& object, const char* name) const {
  Handle attribute = checked({H5Aopen_by_name(file_.id(), object.c_str(), name, H5P_DEFAULT, H5P_DEFAULT), H5Aclose},
                             object, fmt::format("attribute {} cannot be read", name));
  const Handle space(H5Aget_space(attribute.id()), H5Sclose);
  if (H5Sget_simple_extent_type(space.id()) != H5S_SCALAR) {
    refuse(object, fmt::format("attribute {} is not a single value", name));
  }
  Handle type(H5Aget_type(attribute.id()), H5Tclose);
  return {std::move(attribute), std::move(type)};
}

std::string File::read_string(const std::string& object, const char* name) const {
  const auto [attribute, type] = open_attribute(object, name);
  if (H5Tget_class(type.id()) != H5T_STRING || H5Tis_variable_str(type.id()) != 0) {
    refuse(object, fmt::format("attribute {} is not a string of fixed length", name));
  }
  std::string value(H5Tget_size(type.id()), '\0');
  check(H5Aread(attribute.id(), type.id(), value.data()), object, fmt::format("attribute {} cannot be read", name));
  return value.substr(0, value.find('\0'));
}

template <class T>
T File::read_attribute(const std::string& object, const char* name) const {
  const auto [attribute, type] = open_attribute(object, name);
  const hid_t native = number_type<T>().native;
  if (H5Tget_class(type.id()) != H5Tget_class(native)) {
    refuse(object, fmt::format("attribute {} is not {}", name, std::is_integral_v<T> ? "a count" : "a number"));
  }
  T value{};
  check(H5Aread(attribute.id(), native, &value), object, fmt::format("attribute {} cannot be read", name));
  return value;
}

template double File::read_attribute(const std::string& object, const char* name) const;
template std::uint64_t File::read_attribute(const std::string& object, const char* name) const;

void File::write_dataset(const std::string& object, std::span<const hsize_t> size, NumberType type,
                         std::size_t chunk_rows, const void* values) {
  const auto dimensions = static_cast<int>(size.size());
  const Handle properties = object_properties(H5P_DATASET_CREATE);
  if (chunk_rows != 0) {
    std::vector<hsize_t> chunk(size.begin(), size.end());
    chunk[0] = std::min<hsize_t>(chunk_rows, chunk[0]);
    H5Pset_chunk(properties.id(), dimensions, chunk.data());
    H5Pset_shuffle(properties.id());
    H5Pset_deflate(properties.id(), k_deflate_level);
    H5Pset_fletcher32(properties.id());
  }
  const Handle space(H5Screate_simple(dimensions, size.data(), nullptr), H5Sclose);
  const Handle dataset = checked(
      {H5Dcreate2(file_.id(), object.c_str(), type.stored, space.id(), H5P_DEFAULT, properties.id(), H5P_DEFAULT),
       H5Dclose},
      object, "cannot be written");
  check(H5Dwrite(dataset.id(), type.native, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), object, "cannot be written");
}

void File::write_matrix(const std::string& object, const double* values, std::size_t rows, std::size_t columns,
                        std::size_t chunk_rows) {
  write_dataset(object, std::array<hsize_t, 2>{rows, columns}, number_type<double>(), chunk_rows, values);
}

Handle File::open_dataset(const std::string& object, hid_t stored_type, std::span<hsize_t> size) const {
  Handle dataset = checked({H5Dopen2(file_.id(), object.c_str(), H5P_DEFAULT), H5Dclose}, object, "cannot be opened");
  const Handle type(H5Dget_type(dataset.id()), H5Tclose);
  if (H5Tequal(type.id(), stored_type) <= 0) refuse(object, "is not of the expected type");
  const Handle space(H5Dget_space(dataset.id()), H5Sclose);
  if (H5Sget_simple_extent_ndims(space.id()) != static_cast<int>(size.size())) {
    refuse(object, fmt::format("does not have {} dimensions", size.size()));
  }
  check(H5Sget_simple_extent_dims(space.id(), size.data(), nullptr), object, "has no size");
  return dataset;
}

std::size_t File::value_count(const std::string& object, const Handle& dataset, std::span<const hsize_t> size,
                              std::size_t value_bytes) const {
  hsize_t file_bytes = 0;
  check(H5Fget_filesize(file_.id(), &file_bytes), object, "has no size");
  const hsize_t stored = std::min<hsize_t>(H5Dget_storage_size(dataset.id()), file_bytes);
  // As doubles, which cannot overflow. What passes is far below 2^64.
  double bytes = static_cast<double>(value_bytes);
  std::size_t count = 1;
  for (const hsize_t n : size) {
    bytes *= static_cast<double>(n);
    count *= n;
  }
  if (bytes > k_most_compression * static_cast<double>(stored)) {
    refuse(object, fmt::format("{} values in {} bytes?", fmt::join(size, " x "), stored));
  }
  return count;
}

std::pair<std::size_t, std::size_t> File::matrix_size(const std::string& object) const {
  std::array<hsize_t, 2> size{};
  open_dataset(object, number_type<double>().stored, size);
  return {size[0], size[1]};
}

}  // namespace sixdof::hdf5
