#include <sixdof/base/hdf5.h>

#include <algorithm>
#include <array>
#include <type_traits>

#include <fmt/format.h>

#include <sixdof/base/error.h>

namespace sixdof::hdf5 {
namespace {

/// Up to this many attributes stay inside the object's header, which has a checksum.
constexpr unsigned k_compact_attributes = 64;
constexpr unsigned k_deflate_level = 6;  ///< zlib's default.

std::mutex& library_mutex() {
  static std::mutex mutex;
  return mutex;
}

herr_t keep_first(unsigned /*depth*/, const H5E_error2_t* entry, void* out) {
  auto& words = *static_cast<std::string*>(out);
  if (words.empty() && entry->desc != nullptr) words = entry->desc;
  return 0;
}

Handle property_list(hid_t property_class) { return {H5Pcreate(property_class), H5Pclose}; }

/// Without times of creation: the same content gives the same bytes.
Handle object_properties(hid_t property_class) {
  Handle list = property_list(property_class);
  H5Pset_obj_track_times(list.id(), false);
  H5Pset_attr_phase_change(list.id(), k_compact_attributes, k_compact_attributes / 2);
  return list;
}

/// Stored and native type of a number.
template <class T>
std::pair<hid_t, hid_t> number_types() {
  if constexpr (std::is_same_v<T, std::int32_t>) return {H5T_STD_I32LE, H5T_NATIVE_INT32};
  if constexpr (std::is_same_v<T, std::uint32_t>) return {H5T_STD_U32LE, H5T_NATIVE_UINT32};
  if constexpr (std::is_same_v<T, std::uint64_t>) return {H5T_STD_U64LE, H5T_NATIVE_UINT64};
  if constexpr (std::is_same_v<T, float>) return {H5T_IEEE_F32LE, H5T_NATIVE_FLOAT};
  if constexpr (std::is_same_v<T, double>) return {H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE};
}

/// A stated size above this is an error, not a request for memory.
constexpr std::size_t k_most_values = std::size_t{1} << 36;

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

std::string last_error() {
  std::string words;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_first, &words);
  H5Eclear2(H5E_DEFAULT);
  return words.empty() ? "no reason given" : words;
}

File File::open(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) throw BadFile(path.string(), "no such file");
  if (!std::filesystem::is_regular_file(path, error)) throw BadFile(path.string(), "not a regular file");
  const Handle access = property_list(H5P_FILE_ACCESS);
  H5Pset_fclose_degree(access.id(), H5F_CLOSE_STRONG);
  Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.id()), H5Fclose);
  if (!file.valid()) {
    throw BadFile(path.string(), fmt::format("not a readable HDF5 file, or damaged ({})", last_error()));
  }
  return {std::move(file), path.string()};
}

File File::create(const std::filesystem::path& path, const std::filesystem::path& shown_as) {
  const Handle access = property_list(H5P_FILE_ACCESS);
  H5Pset_fclose_degree(access.id(), H5F_CLOSE_STRONG);
  H5Pset_libver_bounds(access.id(), H5F_LIBVER_V110, H5F_LIBVER_V110);
  const Handle creation = object_properties(H5P_FILE_CREATE);
  Handle file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation.id(), access.id()), H5Fclose);
  if (!file.valid()) throw BadFile(shown_as.string(), fmt::format("cannot be written ({})", last_error()));
  return {std::move(file), shown_as.string()};
}

void File::close() {
  check(H5Fflush(file_.id(), H5F_SCOPE_LOCAL), "/", "cannot be written");
  Handle closing = std::move(file_);
}

void File::refuse(const std::string& object, const std::string& cause) const {
  throw BadFile(name_, object == "/" ? "root" : object, cause);
}

void File::check(herr_t result, const std::string& object, const std::string& what) const {
  if (result < 0) refuse(object, fmt::format("{} ({})", what, last_error()));
}

bool File::exists(const std::string& object) const {
  const htri_t found = H5Lexists(file_.id(), object.c_str(), H5P_DEFAULT);
  check(found, object, "cannot be looked up");
  return found > 0;
}

void File::make_group(const std::string& object) {
  const Handle creation = object_properties(H5P_GROUP_CREATE);
  const Handle group(H5Gcreate2(file_.id(), object.c_str(), H5P_DEFAULT, creation.id(), H5P_DEFAULT), H5Gclose);
  check(group.valid() ? 0 : -1, object, "cannot be written");
}

void File::write_attribute(const std::string& object, const char* name, hid_t type, const void* value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle attribute(
      H5Acreate_by_name(file_.id(), object.c_str(), name, type, space.id(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
      H5Aclose);
  const std::string what = fmt::format("attribute {} cannot be written", name);
  check(attribute.valid() ? 0 : -1, object, what);
  check(H5Awrite(attribute.id(), type, value), object, what);
}

void File::write_attribute(const std::string& object, const char* name, const std::string& value) {
  // HDF5 has no strings of length 0; the terminator makes them 1.
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.id(), value.size() + 1);
  H5Tset_cset(type.id(), H5T_CSET_UTF8);
  write_attribute(object, name, type.id(), value.c_str());
}

void File::write_attribute(const std::string& object, const char* name, double value) {
  write_attribute(object, name, H5T_IEEE_F64LE, &value);
}

void File::write_attribute(const std::string& object, const char* name, std::uint64_t value) {
  write_attribute(object, name, H5T_STD_U64LE, &value);
}

Handle File::open_attribute(const std::string& object, const char* name) const {
  Handle attribute(H5Aopen_by_name(file_.id(), object.c_str(), name, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  check(attribute.valid() ? 0 : -1, object, fmt::format("attribute {} cannot be read", name));
  const Handle space(H5Aget_space(attribute.id()), H5Sclose);
  if (H5Sget_simple_extent_type(space.id()) != H5S_SCALAR) {
    refuse(object, fmt::format("attribute {} is not a single value", name));
  }
  return attribute;
}

std::string File::read_string(const std::string& object, const char* name) const {
  const Handle attribute = open_attribute(object, name);
  const Handle type(H5Aget_type(attribute.id()), H5Tclose);
  if (H5Tget_class(type.id()) != H5T_STRING || H5Tis_variable_str(type.id()) != 0) {
    refuse(object, fmt::format("attribute {} is not a string of fixed length", name));
  }
  std::string value(H5Tget_size(type.id()), '\0');
  check(H5Aread(attribute.id(), type.id(), value.data()), object, fmt::format("attribute {} cannot be read", name));
  value.resize(value.find('\0') == std::string::npos ? value.size() : value.find('\0'));
  return value;
}

void File::read_attribute(const std::string& object, const char* name, H5T_class_t type_class, hid_t memory_type,
                          void* value) const {
  const Handle attribute = open_attribute(object, name);
  const Handle type(H5Aget_type(attribute.id()), H5Tclose);
  if (H5Tget_class(type.id()) != type_class) {
    refuse(object, fmt::format("attribute {} is not {}", name, type_class == H5T_FLOAT ? "a number" : "a count"));
  }
  check(H5Aread(attribute.id(), memory_type, value), object, fmt::format("attribute {} cannot be read", name));
}

double File::read_number(const std::string& object, const char* name) const {
  double value = 0.0;
  read_attribute(object, name, H5T_FLOAT, H5T_NATIVE_DOUBLE, &value);
  return value;
}

std::uint64_t File::read_count(const std::string& object, const char* name) const {
  std::uint64_t value = 0;
  read_attribute(object, name, H5T_INTEGER, H5T_NATIVE_UINT64, &value);
  return value;
}

void File::write_dataset(const std::string& object, std::span<const hsize_t> size, hid_t stored_type, hid_t native_type,
                         const Handle& properties, const void* values) {
  const Handle space(H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr), H5Sclose);
  const Handle dataset(
      H5Dcreate2(file_.id(), object.c_str(), stored_type, space.id(), H5P_DEFAULT, properties.id(), H5P_DEFAULT),
      H5Dclose);
  check(dataset.valid() ? 0 : -1, object, "cannot be written");
  check(H5Dwrite(dataset.id(), native_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), object, "cannot be written");
}

Handle File::open_dataset(const std::string& object, hid_t stored_type) const {
  Handle dataset(H5Dopen2(file_.id(), object.c_str(), H5P_DEFAULT), H5Dclose);
  check(dataset.valid() ? 0 : -1, object, "cannot be opened");
  const Handle type(H5Dget_type(dataset.id()), H5Tclose);
  if (H5Tequal(type.id(), stored_type) <= 0) refuse(object, "is not of the expected type");
  return dataset;
}

void File::read_size(const Handle& dataset, const std::string& object, std::span<hsize_t> size) const {
  const Handle space(H5Dget_space(dataset.id()), H5Sclose);
  if (H5Sget_simple_extent_ndims(space.id()) != static_cast<int>(size.size())) {
    refuse(object, fmt::format("does not have {} dimensions", size.size()));
  }
  check(H5Sget_simple_extent_dims(space.id(), size.data(), nullptr), object, "has no size");
}

void File::write_matrix(const std::string& object, const double* values, std::size_t rows, std::size_t columns,
                        std::size_t chunk_rows) {
  const std::array<hsize_t, 2> size{rows, columns};
  const Handle properties = object_properties(H5P_DATASET_CREATE);
  if (chunk_rows != 0) {
    const std::array<hsize_t, 2> chunk{std::min(chunk_rows, rows), columns};
    H5Pset_chunk(properties.id(), 2, chunk.data());
    H5Pset_shuffle(properties.id());
    H5Pset_deflate(properties.id(), k_deflate_level);
    H5Pset_fletcher32(properties.id());
  }
  write_dataset(object, size, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, properties, values);
}

std::pair<std::size_t, std::size_t> File::matrix_size(const std::string& object) const {
  std::array<hsize_t, 2> size{};
  read_size(open_dataset(object, H5T_IEEE_F64LE), object, size);
  return {size[0], size[1]};
}

std::vector<double> File::read_matrix(const std::string& object) const {
  const auto [rows, columns] = matrix_size(object);
  if (columns != 0 && rows > k_most_values / columns) refuse(object, fmt::format("{} x {} values?", rows, columns));
  const Handle dataset = open_dataset(object, H5T_IEEE_F64LE);
  std::vector<double> values(rows * columns);
  check(H5Dread(dataset.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), object,
        "cannot be read");
  return values;
}

template <class T>
void File::write_values(const std::string& object, std::span<const T> values) {
  const auto [stored, native] = number_types<T>();
  const std::array<hsize_t, 1> size{values.size()};
  write_dataset(object, size, stored, native, object_properties(H5P_DATASET_CREATE), values.data());
}

template <class T>
std::vector<T> File::read_values(const std::string& object) const {
  const auto [stored, native] = number_types<T>();
  const Handle dataset = open_dataset(object, stored);
  std::array<hsize_t, 1> size{};
  read_size(dataset, object, size);
  if (size[0] > k_most_values) refuse(object, fmt::format("{} values?", size[0]));
  std::vector<T> values(size[0]);
  check(H5Dread(dataset.id(), native, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), object, "cannot be read");
  return values;
}

template void File::write_values(const std::string&, std::span<const std::int32_t>);
template void File::write_values(const std::string&, std::span<const std::uint32_t>);
template void File::write_values(const std::string&, std::span<const std::uint64_t>);
template void File::write_values(const std::string&, std::span<const float>);
template void File::write_values(const std::string&, std::span<const double>);
template std::vector<std::int32_t> File::read_values(const std::string&) const;
template std::vector<std::uint32_t> File::read_values(const std::string&) const;
template std::vector<std::uint64_t> File::read_values(const std::string&) const;
template std::vector<float> File::read_values(const std::string&) const;
template std::vector<double> File::read_values(const std::string&) const;

}  // namespace sixdof::hdf5
