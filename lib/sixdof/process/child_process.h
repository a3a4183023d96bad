#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <sys/types.h>

#include <sixdof/base/error.h>
#include <sixdof/base/separate_process.h>
#include <sixdof/query/algorithm.h>

namespace sixdof {

/// Why a process gives no more answers; it has ended, or was ended. The words do not name the process.
struct ChildFailure : Error {
  ChildFailure(Status why, const std::string& words) : Error(words), status(why) {}
  Status status;  ///< crashed, timed_out, out_of_memory; failed for a line that is no part of the protocol.
};

/// True once the time for an answer is over.
using TimeLimit = std::function<bool()>;

/// @param seconds from now on
TimeLimit expires_after(double seconds);

/// Of a process that ended by itself. @param wait_status of waitpid()
/// @param ran_out_of_memory it said so before, or the kernel ended a process for want of memory at that time
/// @returns the status and words: "ended by signal 11 (Segmentation fault)"
ChildFailure how_it_ended(int wait_status, bool ran_out_of_memory);

/// A program that runs beside this one and exchanges lines with it over its standard input and output; its standard
/// error is this program's. The program and all that it has started end with this object, and also with the thread that
/// made it, however that thread ends (keeper.h). Ctrl-C does not reach it: it has a process group of its own.
class ChildProcess {
 public:
  /// @param words program and arguments; the program is looked for in PATH
  /// @param files descriptors that the program finds as 3, 4, ...; see high_descriptor()
  /// @param memory_bytes most data that it may have (RLIMIT_DATA); 0 for no limit
  /// @throws Error if no process can be made
  ChildProcess(const std::vector<std::string>& words, const std::vector<int>& files, std::size_t memory_bytes);
  /// Closes the program's input, and kills it if it does not end by that.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Sends a line; a line break is added. @throws ChildFailure, after which the object is of no more use
  void send(std::string_view line, const TimeLimit& expired);

  /// The next line, without its break. @throws ChildFailure likewise; for a line longer than k_longest_line too
  std::string receive(const TimeLimit& expired);

  /// To be called before a request: a line that is there already answers no request, and would be taken for the answer
  /// to this one. @throws ChildFailure likewise
  void expect_no_line();

  /// Whether the calling thread made it: it ends with no other one.
  bool ends_with_this_thread() const;

  static constexpr std::size_t k_longest_line = std::size_t{16} << 20;

  /// The line by which a program says that an allocation failed, any time. receive() passes over it. If the program
  /// then ends without an answer, its status is out_of_memory.
  static constexpr std::string_view k_memory_note = R"({"note":"out of memory"})";

 private:
  /// Takes what the program has written so far into `received_`.
  void read_what_is_there();
  /// The next line that is no note, if a whole one is there.
  std::optional<std::string> take_line();
  [[noreturn]] void give_up(Status status, const std::string& words);
  [[noreturn]] void closed();
  bool has_ended() const;
  void end();

  std::shared_ptr<const char> thread_;  ///< Stands for the thread that made it.
  pid_t process_ = -1;                  ///< The program's keeper, which ends as the program does.
  int input_ = -1, output_ = -1;        ///< Of the program.
  int wait_status_ = 0;
  bool ended_ = false;
  bool noted_memory_ = false;
  long kernel_kills_ = 0;  ///< For want of memory, when it began.
  std::string received_;
  std::size_t searched_ = 0;  ///< Of `received_`, without a line break.
};

/// What a program writes for receive(): the line and its break. @throws Error if the other side is gone
void write_line(int output, std::string line);

/// Moves a descriptor to a number of 100 or more, so that 3, 4, ... are free for a program that is started. The copy is
/// closed on exec, the given one is closed now. @throws Error
int high_descriptor(int descriptor);

/// Limits this process and what it starts: no core file, and no more data than that (RLIMIT_DATA; 0 for no limit). In
/// sanitized programs the data are not limited, since their shadow memory counts. A signal handler may call it.
void limit_resources(std::size_t memory_bytes);

}  // namespace sixdof
