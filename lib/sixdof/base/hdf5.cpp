#include <sixdof/base/hdf5.h>

#include <algorithm>
#include <exception>
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
  const bool walked = H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_first, &words) >= 0;
  const bool cleared = H5Eclear2(H5E_DEFAULT) >= 0;
  if (!walked || !cleared) words += words.empty() ? "its own list of errors failed" : "; its own list of errors failed";
  constexpr std::string_view k_systems_words = "error message = '";
  if (const std::size_t begin = words.find(k_systems_words); begin != std::string::npos) {
    words.erase(0, begin + k_systems_words.size());
    words.erase(std::min(words.find('\''), words.size()));
  }
  // HDF5 1.14 does not say which filter, nor why.
  if (words.find("filter returned failure") != std::string::npos) words += ": damaged, or a wrong checksum";
  return words.empty() ? "no reason given" : words;
}

/// For calls that need no file: properties, types, spaces. @throws Error if `result` is negative
hid_t must(hid_t result, const char* what) {
  if (result < 0) throw Error(fmt::format("HDF5: {} ({})", what, last_error()));
  return result;
}

Handle scalar_space() { return {must(H5Screate(H5S_SCALAR), "no scalar"), H5Sclose}; }

/// Without times of creation: the same content gives the same bytes.
Handle object_properties(hid_t property_class) {
  Handle list(must(H5Pcreate(property_class), "no list of properties"), H5Pclose);
  must(H5Pset_obj_track_times(list.id(), false), "no files without times");
  must(H5Pset_attr_phase_change(list.id(), k_compact_attributes, k_compact_attributes / 2), "no compact attributes");
  return list;
}

Handle file_access() {
  Handle access(must(H5Pcreate(H5P_FILE_ACCESS), "no list of properties"), H5Pclose);
  must(H5Pset_fclose_degree(access.id(), H5F_CLOSE_STRONG), "no strong closing");
  return access;
}

/// Byte of the superblock (version 3) where the address of the file's end stands, 8 bytes, lowest first.
constexpr std::size_t k_end_of_file_at = 28;
constexpr std::size_t k_image_step = std::size_t{1} << 20;  ///< By which an image grows.

/// Makes a file with these access properties lie in `image`, which must live longer than it. The image is complete when
/// HDF5 has closed the file.
void keep_in_memory(hid_t file_access, std::vector<char>& image) {
  H5FD_file_image_callbacks_t callbacks = {};
  callbacks.udata = &image;
  callbacks.udata_copy = [](void* user) { return user; };
  callbacks.udata_free = [](void*) -> herr_t { return 0; };
  callbacks.image_free = [](void*, H5FD_file_image_op_t, void*) -> herr_t { return 0; };
  callbacks.image_realloc = [](void*, std::size_t size, H5FD_file_image_op_t, void* user) -> void* {
    try {
      auto& bytes = *static_cast<std::vector<char>*>(user);
      bytes.resize(size);
      return bytes.data();
    } catch (const std::exception&) {
      return nullptr;
    }
  };
  must(H5Pset_fapl_core(file_access, k_image_step, false), "no files in memory");
  must(H5Pset_file_image_callbacks(file_access, &callbacks), "no images of files");
}

/// Bytes of a value of this type.
std::size_t size_of(hid_t type) {
  const std::size_t bytes = H5Tget_size(type);
  must(bytes == 0 ? -1 : 0, "a type without a size");
  return bytes;
}

}  // namespace

Session::Session() : lock_(library_mutex()) {
  // After a damaged file, HDF5 1.10 may fail to close itself at exit and print "infinite loop closing library". Handles
  // close themselves, so it need not. It refuses where the library is in use already.
  [[maybe_unused]] static const herr_t no_closing_at_exit = H5dont_atexit();
  must(H5open(), "cannot be used");
  must(H5Eget_auto2(H5E_DEFAULT, &old_handler_, &old_data_), "no handler of errors");
  must(H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr), "no handler of errors");
}

Session::~Session() {
  // It fails only where the library is closed; nobody is left then who would print.
  static_cast<void>(H5Eset_auto2(H5E_DEFAULT, old_handler_, old_data_));
}

File File::open(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) throw BadFile(path.string(), "no such file");
  if (!std::filesystem::is_regular_file(path, error)) throw BadFile(path.string(), "not a regular file");
  std::string first(k_first_bytes.size(), '\0');
  std::ifstream(path, std::ios::binary).read(first.data(), static_cast<std::streamsize>(first.size()));
  if (first != k_first_bytes) throw BadFile(path.string(), "not a readable HDF5 file of this project, or damaged");
  Handle access = file_access();
  Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.id()), H5Fclose);
  if (file.id() < 0) {
    throw BadFile(path.string(), fmt::format("not a readable HDF5 file, or damaged ({})", last_error()));
  }
  must(access.close(), "properties cannot be closed");
  return {std::move(file), path.string()};
}

File File::create(AtomicFile& output) {
  auto image = std::make_unique<std::vector<char>>();
  const std::string name = output.target().string();
  Handle access = file_access();
  must(H5Pset_libver_bounds(access.id(), H5F_LIBVER_V110, H5F_LIBVER_V110), "no format of 1.10");
  keep_in_memory(access.id(), *image);
  Handle creation = object_properties(H5P_FILE_CREATE);
  // HDF5 opens and reads a file of the given name, though it is made in memory: here is none.
  constexpr const char* k_no_file = "/dev/null/sixdof";
  File made({H5Fcreate(k_no_file, H5F_ACC_TRUNC, creation.id(), access.id()), H5Fclose}, name);
  made.image_ = std::move(image);
  made.output_ = &output;
  made.check(made.file_.id(), "/", "cannot be written");
  made.close_all("/", access, creation);
  return made;
}

void File::close() {
  check(file_.close(), "/", "cannot be written");
  std::size_t end = 0;  // HDF5 has asked for more bytes than it needs
  for (std::size_t i = 8; i-- > 0;) end = end << 8 | static_cast<unsigned char>((*image_)[k_end_of_file_at + i]);
  output_->store({image_->data(), std::min(end, image_->size())});
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
  Handle creation = object_properties(H5P_GROUP_CREATE);
  Handle group = checked({H5Gcreate2(file_.id(), object.c_str(), H5P_DEFAULT, creation.id(), H5P_DEFAULT), H5Gclose},
                         object, "cannot be written");
  close_all(object, group, creation);
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
  Handle space = scalar_space();
  Handle attribute = checked(
      {H5Acreate_by_name(file_.id(), object.c_str(), name, type, space.id(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
       H5Aclose},
      object, what);
  check(H5Awrite(attribute.id(), type, value), object, what);
  close_all(object, attribute, space);
}

void File::write_attribute(const std::string& object, const char* name, const std::string& value) {
  // HDF5 has no strings of length 0; the terminator makes them 1.
  Handle type(must(H5Tcopy(H5T_C_S1), "no strings"), H5Tclose);
  must(H5Tset_size(type.id(), value.size() + 1), "no strings of this length");
  must(H5Tset_cset(type.id(), H5T_CSET_UTF8), "no strings in UTF-8");
  write_attribute(object, name, type.id(), value.c_str());
  close_all(object, type);
}

template <class Read>
auto File::with_attribute(const std::string& object, const char* name, const Read& read) const {
  const std::string what = fmt::format("attribute {} cannot be read", name);
  Handle attribute =
      checked({H5Aopen_by_name(file_.id(), object.c_str(), name, H5P_DEFAULT, H5P_DEFAULT), H5Aclose}, object, what);
  Handle space = checked({H5Aget_space(attribute.id()), H5Sclose}, object, what);
  if (H5Sget_simple_extent_type(space.id()) != H5S_SCALAR) {
    refuse(object, fmt::format("attribute {} is not a single value", name));
  }
  Handle type = checked({H5Aget_type(attribute.id()), H5Tclose}, object, what);
  auto value = read(attribute.id(), type.id(), what);
  close_all(object, type, space, attribute);
  return value;
}

std::string File::read_string(const std::string& object, const char* name) const {
  return with_attribute(object, name, [&](hid_t attribute, hid_t type, const std::string& what) {
    if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) != 0) {
      refuse(object, fmt::format("attribute {} is not a string of fixed length", name));
    }
    std::string value(size_of(type), '\0');
    check(H5Aread(attribute, type, value.data()), object, what);
    return value.substr(0, value.find('\0'));
  });
}

template <class T>
T File::read_attribute(const std::string& object, const char* name) const {
  return with_attribute(object, name, [&](hid_t attribute, hid_t type, const std::string& what) {
    const hid_t native = number_type<T>().native;
    if (H5Tget_class(type) != H5Tget_class(native)) {
      refuse(object, fmt::format("attribute {} is not {}", name, std::is_integral_v<T> ? "a count" : "a number"));
    }
    T value{};
    check(H5Aread(attribute, native, &value), object, what);
    return value;
  });
}

template double File::read_attribute(const std::string& object, const char* name) const;
template std::uint64_t File::read_attribute(const std::string& object, const char* name) const;

void File::write_dataset(const std::string& object, std::span<const hsize_t> size, NumberType type,
                         std::size_t chunk_rows, std::span<const std::byte> values) {
  const auto dimensions = static_cast<int>(size.size());
  Handle properties = object_properties(H5P_DATASET_CREATE);
  if (chunk_rows != 0) {
    std::vector<hsize_t> chunk(size.begin(), size.end());
    chunk[0] = std::min<hsize_t>(chunk_rows, chunk[0]);
    must(H5Pset_chunk(properties.id(), dimensions, chunk.data()), "no chunks of this size");
    must(H5Pset_shuffle(properties.id()), "no filter \"shuffle\"");
    must(H5Pset_deflate(properties.id(), k_deflate_level), "no filter \"deflate\"");
    must(H5Pset_fletcher32(properties.id()), "no filter \"fletcher32\"");
  }
  Handle space(must(H5Screate_simple(dimensions, size.data(), nullptr), "no array of this size"), H5Sclose);
  Handle dataset = checked(
      {H5Dcreate2(file_.id(), object.c_str(), type.stored, space.id(), H5P_DEFAULT, properties.id(), H5P_DEFAULT),
       H5Dclose},
      object, "cannot be written");
  check(H5Dwrite(dataset.id(), type.native, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), object, "cannot be written");
  close_all(object, dataset, space, properties);  // chunks are written as their dataset is closed
}

void File::write_matrix(const std::string& object, const double* values, std::size_t rows, std::size_t columns,
                        std::size_t chunk_rows) {
  write_dataset(object, std::array<hsize_t, 2>{rows, columns}, number_type<double>(), chunk_rows,
                std::as_bytes(std::span(values, rows * columns)));
}

Handle File::open_dataset(const std::string& object, hid_t stored_type, std::span<hsize_t> size) const {
  Handle dataset = checked({H5Dopen2(file_.id(), object.c_str(), H5P_DEFAULT), H5Dclose}, object, "cannot be opened");
  Handle type = checked({H5Dget_type(dataset.id()), H5Tclose}, object, "has no type");
  if (H5Tequal(type.id(), stored_type) <= 0) refuse(object, "is not of the expected type");
  Handle space = checked({H5Dget_space(dataset.id()), H5Sclose}, object, "has no size");
  if (H5Sget_simple_extent_ndims(space.id()) != static_cast<int>(size.size())) {
    refuse(object, fmt::format("does not have {} dimensions", size.size()));
  }
  check(H5Sget_simple_extent_dims(space.id(), size.data(), nullptr), object, "has no size");
  close_all(object, space, type);
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
  Handle dataset = open_dataset(object, number_type<double>().stored, size);
  close_all(object, dataset);
  return {size[0], size[1]};
}

}  // namespace sixdof::hdf5
