#pragma once

#include <hdf5.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <sixdof/base/atomic_file.h>

/// HDF5's C interface with handles that close themselves and errors as exceptions. For this project's own sources.
/// `test/architecture` holds that HDF5 is called here only, and that no result of it is ignored.

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

/// An identifier with the function that closes it. HDF5 may write as it closes an object, so whoever goes on afterwards
/// calls close(); the destructor is for unwinding, where another failure is being reported.
class Handle {
 public:
  Handle(hid_t id, herr_t (*closer)(hid_t)) : id_(id), close_(closer) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle& operator=(Handle&&) = delete;
  ~Handle() {
    if (id_ >= 0) static_cast<void>(close());
  }
  hid_t id() const { return id_; }
  /// @return HDF5's status
  [[nodiscard]] herr_t close() { return close_(std::exchange(id_, -1)); }

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
  /// For writing into `output`, which must live longer. Messages name its target. The file is made in memory: after a
  /// failed write to a disk HDF5 can close neither the dataset nor the file.
  static File create(AtomicFile& output);

  /// Closes a file that was written and stores it by AtomicFile::store(). To be called before AtomicFile::commit().
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
    write_dataset(object, std::array<hsize_t, 1>{values.size()}, number_type<T>(), 0, std::as_bytes(values));
  }
  template <class T>
  std::vector<T> read_values(const std::string& object) const {
    return read_dataset<T, 1>(object);
  }

 private:
  File(Handle file, std::string name) : file_(std::move(file)), name_(std::move(name)) {}
  [[noreturn]] void refuse(const std::string& object, const std::string& cause) const;
  /// Throws with HDF5's reason if `result`, an identifier or a status, is negative.
  void check(hid_t result, const std::string& object, const std::string& what) const;
  Handle checked(Handle handle, const std::string& object, const std::string& what) const;
  /// Closes the handles in this order.
  template <class... Handles>
  void close_all(const std::string& object, Handles&... handles) const {
    (check(handles.close(), object, "cannot be closed"), ...);
  }
  void write_attribute(const std::string& object, const char* name, hid_t type, const void* value);
  /// Calls read(attribute, type, bytes) for a scalar attribute. @return what it returns
  template <class Read>
  auto with_attribute(const std::string& object, const char* name, const Read& read) const;
  void write_dataset(const std::string& object, std::span<const hsize_t> size, NumberType type, std::size_t chunk_rows,
                     std::span<const std::byte> values);
  /// @param size filled with one element for each dimension that the dataset must have
  Handle open_dataset(const std::string& object, hid_t stored_type, std::span<hsize_t> size) const;
  /// The product of the dimensions. Throws if the file has too few bytes for so many values.
  std::size_t value_count(const std::string& object, const Handle& dataset, std::span<const hsize_t> size,
                          std::size_t value_bytes) const;
  template <class T, std::size_t dimensions>
  std::vector<T> read_dataset(const std::string& object) const {
    const NumberType type = number_type<T>();
    std::array<hsize_t, dimensions> size{};
    Handle dataset = open_dataset(object, type.stored, size);
    std::vector<T> values(value_count(object, dataset, size, sizeof(T)));
    check(H5Dread(dataset.id(), type.native, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), object, "cannot be read");
    close_all(object, dataset);
    return values;
  }

  AtomicFile* output_ = nullptr;              ///< Of a file that is written.
  std::unique_ptr<std::vector<char>> image_;  ///< Likewise: its bytes. Outlives file_.
  Handle file_;
  std::string name_;
};

}  // namespace sixdof::hdf5
