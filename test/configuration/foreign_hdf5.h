#pragma once

#include <filesystem>

#include <sixdof/base/atomic_file.h>
#include <sixdof/base/hdf5.h>

namespace sixdof::test {

/// Writes an HDF5 file with what write(file) puts into it.
template <class Write>
void write_hdf5(const std::filesystem::path& path, const Write& write) {
  AtomicFile output(path);
  {
    const hdf5::Session session;
    hdf5::File file = hdf5::File::create(output);
    write(file);
    file.close();
  }
  output.commit();
}

}  // namespace sixdof::test
