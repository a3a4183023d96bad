#pragma once

#include <filesystem>
#include <mutex>
#include <string_view>

namespace sixdof {

/// A file that appears complete or not at all.
///
/// Write by append() or store(), then call commit(): it flushes the data to the disk, renames the file to the target
/// and flushes the directory. Without commit() the destructor removes the temporary file and the target stays as it
/// was. The temporary file lies beside the target, has a random name that ends in ".partial", and is opened by O_EXCL:
/// no file or link of another user is ever written to.
///
/// If the target is a link, the file that it leads to is replaced. A link in a folder that everyone can write is
/// followed only if it belongs to this user, to root or to the folder's owner. A file that is replaced keeps its mode.
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

/// A folder that only this user can read or write, removed with its content unless it is committed. It lies beside
/// `target` and has a random name that ends in ".partial".
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

/// @throws BadFile if an AtomicFile cannot be made. To be called before a long computation.
void check_writable(const std::filesystem::path& target);

/// The path with every link in it followed. @throws BadFile if a link is one that AtomicFile does not follow, or if
/// there are too many
std::filesystem::path follow_links(const std::filesystem::path& path);

/// Writes all of `content`, also after interruptions and short writes. @return errno, 0 on success
int write_all(int descriptor, std::string_view content);

/// Removes the temporary file of every AtomicFile of this process that is not committed. For a program that is about to
/// end without unwinding; may be called from any thread.
/// @return while it is held, no thread makes a new one: constructors wait
[[nodiscard]] std::unique_lock<std::mutex> remove_own_partials();

/// Removes temporary files of `target` whose writers were killed. Files of processes that run on this machine stay. A
/// writer on another machine would lose its file and fail in commit(): a target must have one writer at a time.
void remove_stale_partials(const std::filesystem::path& target);

/// Writes `content` to `target` by an AtomicFile, and compares what the disk has with it before it takes its place.
/// @throws BadFile
void write_file_atomically(const std::filesystem::path& target, std::string_view content);

}  // namespace sixdof
