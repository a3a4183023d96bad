#pragma once

#include <filesystem>
#include <string_view>

namespace sixdof {

/// A file that appears whole or not at all.
///
/// Write to temporary_path(), then call commit(): the data is flushed to the disk (fsync), renamed over the target, and
/// the directory entry is flushed. Without commit() the destructor removes the temporary file and the target stays as
/// it was. The temporary name lies in the target's directory, is unique to this process and object, and ends in
/// ".partial".
class AtomicFile {
 public:
  /// @throws BadFile if the target's directory does not exist or is not writable.
  explicit AtomicFile(std::filesystem::path target);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  const std::filesystem::path& temporary_path() const { return temporary_; }

  /// @throws BadFile if flushing or renaming fails (disk full, permission); the temporary file is removed then.
  void commit();

 private:
  std::filesystem::path target_;
  std::filesystem::path temporary_;
  bool committed_ = false;
};

/// Removes temporary files that writers of `target` left when they were killed. Those of processes that live on this
/// machine stay; a writer on another machine would lose its file and fail in commit(), so a target has one writer.
void remove_stale_partials(const std::filesystem::path& target);

/// Writes `content` to `target`, whole or not at all. @throws BadFile
void write_file_atomically(const std::filesystem::path& target, std::string_view content);

}  // namespace sixdof
