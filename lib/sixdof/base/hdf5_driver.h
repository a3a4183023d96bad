#pragma once

#include <hdf5.h>

#include <sixdof/base/write_log.h>

/// A file driver of HDF5 that reads and writes an open descriptor. Internal: use hdf5.h.
///
/// HDF5's own driver opens by name, so it would follow a link that someone put there in between. And after a failed
/// write HDF5 can neither close the data set nor the file: the descriptor, the room on the disk and an entry in its
/// tables stay until the process ends. This driver keeps the first failure and takes every later write as done, so that
/// HDF5 closes in order; who writes looks at `failure` before the file takes another's place.
namespace sixdof::hdf5 {

struct Channel {
  int descriptor = -1;  ///< Stays open when HDF5 closes the file.
  int failure = 0;      ///< errno of the first call that failed.
  WriteLog written = {};
};

/// Makes files that are opened with these access properties use the channel, which must live longer than they do.
/// @return HDF5's status
[[nodiscard]] herr_t use_channel(hid_t file_access, Channel& channel);

}  // namespace sixdof::hdf5
