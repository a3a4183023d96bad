#pragma once

#include <filesystem>
#include <string_view>

namespace sixdof {

/// A file that appears complete or not at all.
///
/// Write to temporary_path(), then call commit(): it flushes the data to the disk (fsync), renames the file to the
/// target and flushes the directory. Without commit() the destructor removes the temporary file and the target stays as
/// it was. The temporary file lies in the target's directory, has a name that is unique to this process and object, and
/// ends in ".partial".
class AtomicFile {
 public:
  /// @throws BadFile if the target's directory does not exist or is not writable.
  explicit AtomicFile(std::filesystem::path target);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  const std::filesystem::path& temporary_path() const { return temporary_; }

  /// @throws BadFile if flushing or renaming fails (disk full, permission).
  void commit();

 private:
  std::filesystem::path target_;
  std::filesystem::path temporary_;
  bool committed_ = false;
};

/// Removes the temporary file of every AtomicFile of this process that is not committed. For a program that is about to
/// end without unwinding; may be called from any thread.
void remove_own_partials();

/// Removes temporary files of `target` whose writers were killed. Files of processes that run on this machine stay. A
/// writer on another machine would lose its file and fail in commit(): a target must have one writer at a time.
void remove_stale_partials(const std::filesystem::path& target);

/// Writes `content` to `target` by an AtomicFile. @throws BadFile
void write_file_atomically(const std::filesystem::path& target, std::string_view content);

}  // namespace sixdof
