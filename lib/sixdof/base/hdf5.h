#pragma once

#include <hdf5.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

/// HDF5's C interface with handles that close themselves and errors as exceptions. For this project's own sources.

namespace sixdof::hdf5 {

/// Every call of HDF5 needs a Session. Debian's library is not thread-safe: there is one Session at a time in the
/// process. While it lives, HDF5 does not print its error stack.
class Session {
 public:
  Session();
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

 private:
  std::unique_lock<std::mutex> lock_;
  H5E_auto2_t old_handler_ = nullptr;
  void* old_data_ = nullptr;
};

/// An identifier with the function that closes it.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle& operator=(Handle&&) = delete;
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  hid_t id() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// How HDF5 calls a type of number in a file and in memory.
struct NumberType {
  hid_t stored, native;
};

template <class T>
NumberType number_type() {
  if constexpr (std::is_same_v<T, std::int32_t>) return {H5T_STD_I32LE, H5T_NATIVE_INT32};
  if constexpr (std::is_same_v<T, std::uint32_t>) return {H5T_STD_U32LE, H5T_NATIVE_UINT32};
  if constexpr (std::is_same_v<T, std::uint64_t>) return {H5T_STD_U64LE, H5T_NATIVE_UINT64};
  if constexpr (std::is_same_v<T, float>) return {H5T_IEEE_F32LE, H5T_NATIVE_FLOAT};
  if constexpr (std::is_same_v<T, double>) return {H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE};
}

/// An HDF5 file. Objects are named by their path inside the file, "/" for the root. Every method throws BadFile
/// "FILE: OBJECT: CAUSE" if it fails.
///
/// The bytes of a file depend on what is written alone: it holds no times of creation. All structures have checksums
/// (format of HDF5 1.10, strings of fixed length), so that a damaged byte is an error.
class File {
 public:
  /// For reading. A file of another layout than create() gives, which has no checksums, is refused.
  static File open(const std::filesystem::path& path);
  /// For writing; replaces a file at `path`. Messages call the file `shown_as`.
  static File create(const std::filesystem::path& path, const std::filesystem::path& shown_as);

  /// Flushes and closes. Without it, a failure to write (full disk) is not reported.
  void close();

  bool exists(const std::string& object) const;
  void make_group(const std::string& object);
  /// Names of the objects in a group, without the group's own, in the order of their bytes.
  std::vector<std::string> names(const std::string& group) const;

  bool has_attribute(const std::string& object, const char* name) const;
  void write_attribute(const std::string& object, const char* name, const std::string& value);
  /// T: double or std::uint64_t.
  template <class T>
  void write_attribute(const std::string& object, const char* name, T value) {
    write_attribute(object, name, number_type<T>().stored, &value);
  }
  std::string read_string(const std::string& object, const char* name) const;
  /// T: double or std::uint64_t.
  template <class T>
  T read_attribute(const std::string& object, const char* name) const;

  /// A float64 matrix, row-major. `chunk_rows` = 0 stores it in one piece without filters; otherwise in chunks of that
  /// many rows with shuffle, deflate and a Fletcher-32 checksum.
  void write_matrix(const std::string& object, const double* values, std::size_t rows, std::size_t columns,
                    std::size_t chunk_rows);

  /// (rows, columns) of a two-dimensional float64 dataset.
  std::pair<std::size_t, std::size_t> matrix_size(const std::string& object) const;
  std::vector<double> read_matrix(const std::string& object) const { return read_dataset<double, 2>(object); }

  /// A one-dimensional dataset in one piece, without filters. T: std::int32_t, std::uint32_t, std::uint64_t, float or
  /// double, stored little-endian; read_values() throws if another type is stored.
  template <class T>
  void write_values(const std::string& object, std::span<const T> values) {
    write_dataset(object, std::array<hsize_t, 1>{values.size()}, number_type<T>(), 0, values.data());
  }
  template <class T>
  std::vector<T> read_values(const std::string& object) const {
    return read_dataset<T, 1>(object);
  }

 private:
  File(Handle file, std::string name) : file_(std::move(file)), name_(std::move(name)) {}
  [[noreturn]] void refuse(const std::string& object, const std::string& cause) const;
  /// Throws with HDF5's own reason if `result`, an identifier or a status, is negative.
  void check(hid_t result, const std::string& object, const std::string& what) const;
  Handle checked(Handle handle, const std::string& object, const std::string& what) const;
  void write_attribute(const std::string& object, const char* name, hid_t type, const void* value);
  /// The attribute and its type.
  std::pair<Handle, Handle> open_attribute(const std::string& object, const char* name) const;
  void write_dataset(const std::string& object, std::span<const hsize_t> size, NumberType type, std::size_t chunk_rows,
                     const void* values);
  /// @param size filled with one element for each dimension that the dataset must have
  Handle open_dataset(const std::string& object, hid_t stored_type, std::span<hsize_t> size) const;
  /// The product of the dimensions. Throws if the file has too few bytes for so many values.
  std::size_t value_count(const std::string& object, const Handle& dataset, std::span<const hsize_t> size,
                          std::size_t value_bytes) const;

  template <class T, std::size_t dimensions>
  std::vector<T> read_dataset(const std::string& object) const {
    const NumberType type = number_type<T>();
    std::array<hsize_t, dimensions> size{};
    const Handle dataset = open_dataset(object, type.stored, size);
    std::vector<T> values(value_count(object, dataset, size, sizeof(T)));
    check(H5Dread(dataset.id(), type.native, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), object, "cannot be read");
    return values;
  }

  Handle file_;
  std::string name_;
};

}  // namespace sixdof::hdf5
