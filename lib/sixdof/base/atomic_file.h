#pragma once

#include <filesystem>
#include <string_view>

namespace sixdof {

/// A file that appears complete or not at all.
///
/// Write to descriptor() by append(), then call commit(): it flushes the data to the disk (fsync), renames the file to
/// the target and flushes the directory. Without commit() the destructor removes the temporary file and the target
/// stays as it was. The temporary file lies in the target's directory and ends in ".partial". It is made by O_EXCL
/// under a name that nobody can foretell, so that no file or link that another user put there is ever written to.
///
/// A target that is a link stays one: the file that it leads to is replaced. A link in a folder that everyone can write
/// is followed only if it belongs to this user, to root or to the folder's owner. A file that is replaced keeps its
/// mode; a new one has the mode that the umask gives.
class AtomicFile {
 public:
  /// @throws BadFile if the target's directory does not exist or is not writable, the target is there and no regular
  ///   file, or it is a link that is not followed
  explicit AtomicFile(std::filesystem::path target);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// As it was given, for messages.
  const std::filesystem::path& target() const { return target_; }
  const std::filesystem::path& temporary_path() const { return temporary_; }
  /// Open for reading and writing until commit().
  int descriptor() const { return descriptor_; }

  /// @throws BadFile if not all of it could be written
  void append(std::string_view content);

  /// Writes the content of an empty file, flushes it to the disk and reads it again: a disk may say that a write was
  /// done which was not. @throws BadFile unless the file holds these bytes
  void store(std::string_view content);

  /// @throws BadFile if flushing, closing or renaming fails (disk full, permission). After a failure to flush the
  ///   directory, which is the last step, the new file is in its place.
  void commit();

 private:
  friend void check_writable(const std::filesystem::path& target);
  void flush();
  /// Removes the temporary file unless it has been renamed.
  void discard();

  std::filesystem::path target_;
  std::filesystem::path replaced_;  ///< The target with its links followed.
  std::filesystem::path temporary_;
  int descriptor_ = -1;
  bool committed_ = false;
};

/// A folder of this process that nobody else can read or write, and that is removed with all that it holds unless it is
/// committed. It lies beside `target`, has a name that nobody can foretell, and ends in ".partial".
class PrivateFolder {
 public:
  /// @throws BadFile naming the target
  explicit PrivateFolder(const std::filesystem::path& target);
  ~PrivateFolder();
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

  /// Renames the folder to the target, with the mode that the umask gives. @throws BadFile
  void commit(const std::filesystem::path& target);

 private:
  std::filesystem::path path_;
};

/// @throws BadFile if AtomicFile could not be made, so that a long work need not begin
void check_writable(const std::filesystem::path& target);

/// The path with every link in it followed. @throws BadFile if a link is one that AtomicFile does not follow, or if
/// there are too many
std::filesystem::path follow_links(const std::filesystem::path& path);

/// Writes all of `content`, also after interruptions and short writes. @return errno, 0 on success
int write_all(int descriptor, std::string_view content);

/// Removes the temporary file of every AtomicFile of this process that is not committed. For a program that is about to
/// end without unwinding; may be called from any thread.
void remove_own_partials();

/// Removes temporary files of `target` whose writers were killed. Files of processes that run on this machine stay. A
/// writer on another machine would lose its file and fail in commit(): a target must have one writer at a time.
void remove_stale_partials(const std::filesystem::path& target);

/// Writes `content` to `target` by an AtomicFile, and compares what the disk has with it before it takes its place.
/// @throws BadFile
void write_file_atomically(const std::filesystem::path& target, std::string_view content);

}  // namespace sixdof
