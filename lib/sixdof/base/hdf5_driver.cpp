#include <sixdof/base/hdf5_driver.h>

#include <sys/stat.h>
#include <unistd.h>

#if H5_VERSION_GE(1, 13, 2)
#include <H5FDdevelop.h>
#endif

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <iterator>
#include <limits>
#include <span>

namespace sixdof::hdf5 {
namespace {

/// What HDF5 knows of an open file; its own part comes first.
struct OpenFile {
  H5FD_t head = {};
  Channel* channel = nullptr;
  haddr_t allocated = 0;  ///< End of what HDF5 has given out.
};

OpenFile& of(H5FD_t* file) { return *reinterpret_cast<OpenFile*>(file); }
const OpenFile& of(const H5FD_t* file) { return *reinterpret_cast<const OpenFile*>(file); }

void keep_failure(Channel& channel) {
  if (channel.failure == 0) channel.failure = errno == 0 ? EIO : errno;
}

/// What HDF5 copies with a list of properties.
struct Link {
  Channel* channel;
};

H5FD_t* open_file(const char* /*name*/, unsigned flags, hid_t file_access, haddr_t /*largest*/) {
  const auto* const link = static_cast<const Link*>(H5Pget_driver_info(file_access));
  if (link == nullptr) return nullptr;
  if ((flags & H5F_ACC_TRUNC) != 0 && ::ftruncate(link->channel->descriptor, 0) != 0) {
    keep_failure(*link->channel);
    return nullptr;
  }
  auto* const file = new OpenFile;
  file->channel = link->channel;
  return &file->head;
}

herr_t close_file(H5FD_t* file) {
  delete &of(file);
  return 0;
}

/// The same as of HDF5's own driver ("sec2"), since the layout of a file depends on them.
herr_t features(const H5FD_t* /*file*/, unsigned long* flags) {
  *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
           H5FD_FEAT_AGGREGATE_SMALLDATA | H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;
  return 0;
}

haddr_t end_of_allocated(const H5FD_t* file, H5FD_mem_t /*type*/) { return of(file).allocated; }

herr_t set_end_of_allocated(H5FD_t* file, H5FD_mem_t /*type*/, haddr_t end) {
  of(file).allocated = end;
  return 0;
}

haddr_t end_of_file(const H5FD_t* file, H5FD_mem_t /*type*/) {
  struct stat state = {};
  if (::fstat(of(file).channel->descriptor, &state) == 0) return static_cast<haddr_t>(state.st_size);
  keep_failure(*of(file).channel);
  return HADDR_UNDEF;
}

herr_t read_block(H5FD_t* file, H5FD_mem_t /*type*/, hid_t /*transfer*/, haddr_t at, std::size_t size, void* to) {
  auto* bytes = static_cast<char*>(to);
  while (size > 0) {
    const ssize_t count = ::pread(of(file).channel->descriptor, bytes, size, static_cast<off_t>(at));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) {
      keep_failure(*of(file).channel);
      return -1;
    }
    if (count == 0) {  // behind the end are zeros
      std::memset(bytes, 0, size);
      return 0;
    }
    bytes += count;
    at += static_cast<haddr_t>(count);
    size -= static_cast<std::size_t>(count);
  }
  return 0;
}

herr_t write_block(H5FD_t* file, H5FD_mem_t /*type*/, hid_t /*transfer*/, haddr_t at, std::size_t size,
                   const void* from) {
  Channel& channel = *of(file).channel;
  const auto* bytes = static_cast<const char*>(from);
  channel.written.add(at, std::as_bytes(std::span(bytes, size)));
  while (size > 0 && channel.failure == 0) {
    errno = ENOSPC;  // of a write of no bytes
    const ssize_t count = ::pwrite(channel.descriptor, bytes, size, static_cast<off_t>(at));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) {
      keep_failure(channel);
      break;
    }
    bytes += count;
    at += static_cast<haddr_t>(count);
    size -= static_cast<std::size_t>(count);
  }
  return 0;
}

/// HDF5 gives out more than it uses in the end.
herr_t cut_off(H5FD_t* file, hid_t /*transfer*/, hbool_t /*closing*/) {
  Channel& channel = *of(file).channel;
  if (channel.failure == 0 && ::ftruncate(channel.descriptor, static_cast<off_t>(of(file).allocated)) != 0) {
    keep_failure(channel);
  }
  return 0;
}

const H5FD_class_t& driver() {
  static const H5FD_class_t made = [] {
    H5FD_class_t d = {};
#if H5_VERSION_GE(1, 13, 2)
    d.version = H5FD_CLASS_VERSION;
    d.value = static_cast<H5FD_class_value_t>(512);  // the first that HDF5 leaves to others for tests
#endif
    d.name = "sixdof";
    d.maxaddr = static_cast<haddr_t>(std::numeric_limits<off_t>::max());
    d.fc_degree = H5F_CLOSE_STRONG;
    d.fapl_size = sizeof(Link);
    d.open = open_file;
    d.close = close_file;
    d.query = features;
    d.get_eoa = end_of_allocated;
    d.set_eoa = set_end_of_allocated;
    d.get_eof = end_of_file;
    d.read = read_block;
    d.write = write_block;
    d.truncate = cut_off;
    constexpr H5FD_mem_t k_lists[] = H5FD_FLMAP_DICHOTOMY;  // as sec2
    std::copy(std::begin(k_lists), std::end(k_lists), std::begin(d.fl_map));
    return d;
  }();
  return made;
}

}  // namespace

herr_t use_channel(hid_t file_access, Channel& channel) {
  static const hid_t registered = H5FDregister(&driver());
  const Link link{&channel};
  return registered < 0 ? -1 : H5Pset_driver(file_access, registered, &link);
}

}  // namespace sixdof::hdf5
