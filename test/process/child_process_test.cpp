#include <sixdof/process/child_process.h>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <memory>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace sixdof {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

/// Long enough for a busy machine.
constexpr double k_patience_s = 60.0;

std::vector<std::string> shell(const std::string& command) { return {"/bin/sh", "-c", command}; }

/// The failure of an exchange.
ChildFailure failure_of(ChildProcess& process, double seconds = k_patience_s) {
  try {
    const TimeLimit expired = expires_after(seconds);
    process.send("question", expired);
    return {Status::ok, process.receive(expired)};
  } catch (const ChildFailure& failure) {
    return failure;
  }
}
ChildFailure failure_of(const std::string& command, double seconds = k_patience_s) {
  ChildProcess process(shell(command), {}, 0);
  return failure_of(process, seconds);
}

bool is_running(pid_t process) { return ::kill(process, 0) == 0; }

/// Waits until it has ended.
bool ends_soon(pid_t process) {
  for (int i = 0; i < 6000 && is_running(process); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  return !is_running(process);
}

TEST(HowItEnded, SaysSignalOrExitCode) {
  EXPECT_STREQ(how_it_ended(SIGSEGV, false).what(), "ended by signal 11 (Segmentation fault)");
  EXPECT_EQ(how_it_ended(SIGSEGV, false).status, Status::crashed);
  EXPECT_STREQ(how_it_ended(W_EXITCODE(3, 0), false).what(), "ended with exit code 3");
  EXPECT_STREQ(how_it_ended(W_EXITCODE(127, 0), false).what(), "could not be started (exit code 127)");
  EXPECT_EQ(how_it_ended(SIGKILL, false).status, Status::crashed) << "a kill by hand";
  EXPECT_EQ(how_it_ended(SIGKILL, true).status, Status::out_of_memory) << "the kernel's kill";
  EXPECT_STREQ(how_it_ended(SIGABRT, true).what(), "out of memory: ended by signal 6 (Aborted)");
}

TEST(ChildProcess, ExchangesLines) {
  ChildProcess process({"cat"}, {}, 0);
  const TimeLimit expired = expires_after(k_patience_s);
  process.send("one", expired);
  process.send("two", expired);
  EXPECT_EQ(process.receive(expired), "one");
  EXPECT_EQ(process.receive(expired), "two");
  const std::string longer(3'000'000, 'x');
  ChildProcess counter(shell("read line; echo ${#line}"), {}, 0);
  counter.send(longer, expired);
  EXPECT_EQ(counter.receive(expired), "3000000");
}

TEST(ChildProcess, SaysHowItEnded) {
  EXPECT_STREQ(failure_of("read x; exit 7").what(), "ended with exit code 7");
  EXPECT_STREQ(failure_of("read x; kill -SEGV $$").what(), "ended by signal 11 (Segmentation fault)");
  EXPECT_EQ(failure_of("exit 0").status, Status::crashed);
  EXPECT_STREQ(failure_of("exec /no/such/program").what(), "could not be started (exit code 127)");
  const ChildFailure closed = failure_of("exec >&-; sleep 600");
  EXPECT_EQ(closed.status, Status::crashed);
  EXPECT_STREQ(closed.what(), "closed its standard streams");
  EXPECT_EQ(failure_of("read x; printf half").status, Status::crashed) << "a line without an end";
}

TEST(ChildProcess, WhatAProgramWroteBeforeItEndedIsReceived) {
  ChildProcess process(shell("echo early"), {}, 0);
  // Mostly it has ended then, and the request cannot be sent. The answer is the same where it has not.
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  EXPECT_STREQ(failure_of(process).what(), "early");
  EXPECT_STREQ(failure_of(process).what(), "ended with exit code 0");
}

TEST(ChildProcess, EndsTheSilentAndTheEndless) {
  EXPECT_EQ(failure_of("sleep 600", 0.2).status, Status::timed_out);
  EXPECT_EQ(failure_of("while :; do :; done", 0.2).status, Status::timed_out);
  const ChildFailure endless = failure_of("exec tr '\\0' x < /dev/zero");
  EXPECT_EQ(endless.status, Status::failed);
  EXPECT_THAT(endless.what(), StartsWith("wrote a line of more than"));
  ChildProcess deaf(shell("sleep 600"), {}, 0);
  try {
    deaf.send(std::string(10'000'000, 'x'), expires_after(0.2));
    ADD_FAILURE() << "nobody reads";
  } catch (const ChildFailure& failure) {
    EXPECT_EQ(failure.status, Status::timed_out);
  }
}

TEST(ChildProcess, NoteOfMemoryDecidesWhyItEnded) {
  std::string note = "echo '";
  note.append(ChildProcess::k_memory_note).append("'; ");
  const ChildFailure killed = failure_of(note + "kill -ABRT $$");
  EXPECT_EQ(killed.status, Status::out_of_memory);
  EXPECT_STREQ(killed.what(), "out of memory: ended by signal 6 (Aborted)");
  EXPECT_STREQ(failure_of(note + "echo answer; sleep 600").what(), "answer") << "the note is no answer";
  ChildProcess early(shell(note + "kill -ABRT $$"), {}, 0);
  std::this_thread::sleep_for(std::chrono::milliseconds(300));  // it most likely ends before it is asked
  EXPECT_EQ(failure_of(early).status, Status::out_of_memory);
}

TEST(ChildProcess, LimitsMemory) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "their shadow memory counts";
#endif
  ChildProcess process(shell("ulimit -d"), {}, std::size_t{200} << 20);
  EXPECT_EQ(process.receive(expires_after(k_patience_s)), "204800");
  EXPECT_GT(default_memory_limit(), std::size_t{100} << 20);
}

TEST(ChildProcess, FindsFilesFromThreeOn) {
  const int file = high_descriptor(::open("/dev/zero", O_RDONLY | O_CLOEXEC));
  EXPECT_GE(file, 100);
  ChildProcess process(shell("readlink /proc/self/fd/3; readlink /proc/self/fd/4 || echo none"), {file}, 0);
  EXPECT_EQ(process.receive(expires_after(k_patience_s)), "/dev/zero");
  EXPECT_EQ(process.receive(expires_after(k_patience_s)), "none") << "no other descriptor of this program";
  ::close(file);
}

TEST(ChildProcess, EndsWithTheObjectAndWhatItStarted) {
  pid_t child = 0, grandchild = 0;
  {
    ChildProcess process(shell("sleep 600 & echo $!; echo $$; wait"), {}, 0);
    const TimeLimit expired = expires_after(k_patience_s);
    grandchild = std::stoi(process.receive(expired));
    child = std::stoi(process.receive(expired));
    EXPECT_TRUE(is_running(child) && is_running(grandchild));
  }
  EXPECT_TRUE(ends_soon(child));
  EXPECT_TRUE(ends_soon(grandchild));
}

TEST(ChildProcess, EndsWithTheThreadThatMadeIt) {
  std::unique_ptr<ChildProcess> process;
  pid_t child = 0;
  std::thread([&] {
    process = std::make_unique<ChildProcess>(shell("echo $$; while :; do sleep 1; done"), std::vector<int>{}, 0);
    child = std::stoi(process->receive(expires_after(k_patience_s)));
  }).join();
  EXPECT_THAT(failure_of(*process).what(), HasSubstr("signal 9"));
}

/// Starts `rest` with $! of a process that has left group and session, and whose parent has ended.
std::string with_daemon(const std::string& rest) {
  return "setsid sh -c 'sleep 600 > /dev/null & echo $!' & wait; " + rest;
}

TEST(ChildProcess, ADaemonEndsWithTheObject) {
  pid_t daemon = 0;
  {
    ChildProcess process(shell(with_daemon("read x")), {}, 0);
    daemon = std::stoi(process.receive(expires_after(k_patience_s)));
    EXPECT_TRUE(is_running(daemon));
  }
  EXPECT_FALSE(is_running(daemon)) << "at once";
}

TEST(ChildProcess, ADaemonEndsWithTheProgram) {
  ChildProcess process(shell(with_daemon("read x; exit 5")), {}, 0);
  const pid_t daemon = std::stoi(process.receive(expires_after(k_patience_s)));
  EXPECT_TRUE(is_running(daemon));
  EXPECT_STREQ(failure_of(process).what(), "ended with exit code 5");
  EXPECT_FALSE(is_running(daemon));
}

TEST(ChildProcess, EndsProcessesThatStartOthersWithoutAnEnd) {
  // Each generation adds a byte, starts the next one in a session of its own, and ends.
  const std::string file = ::testing::TempDir() + "sixdof-generations-" + std::to_string(::getpid());
  const std::string generation = "[ -e \"$1\" ] && printf x >> \"$1\" && { setsid sh -c \"$0\" \"$0\" \"$1\" & }";
  std::ofstream(file).close();
  {
    ChildProcess process({"/bin/sh", "-c", "setsid sh -c \"$0\" \"$0\" \"$1\" & echo begun; read x", generation, file},
                         {}, 0);
    EXPECT_EQ(process.receive(expires_after(k_patience_s)), "begun");
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
  const auto generations = std::filesystem::file_size(file);
  EXPECT_GT(generations, 1u);
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  EXPECT_EQ(std::filesystem::file_size(file), generations);
  std::filesystem::remove(file);  // would end them, too
}

TEST(ChildProcess, ManyChildrenEndWithTheObject) {
  constexpr int k_children = 200;
  std::vector<pid_t> children;
  {
    ChildProcess process(shell("i=0; while [ $i -lt 200 ]; do sleep 600 & echo $!; i=$((i + 1)); done; read x"), {}, 0);
    for (int i = 0; i < k_children; ++i) children.push_back(std::stoi(process.receive(expires_after(k_patience_s))));
    EXPECT_TRUE(std::ranges::all_of(children, is_running));
  }
  EXPECT_TRUE(std::ranges::none_of(children, is_running));
}

/// A child of this process that is no concern of any ChildProcess.
class Bystander {
 public:
  Bystander() : process_(::fork()) {
    if (process_ != 0) return;
    while (true) ::pause();
  }
  ~Bystander() {
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
  }
  Bystander(const Bystander&) = delete;
  Bystander& operator=(const Bystander&) = delete;

  bool has_ended() const { return ::waitpid(process_, nullptr, WNOHANG) != 0; }

 private:
  pid_t process_;
};

TEST(ChildProcess, OtherChildrenOfThisProgramLive) {
  const Bystander before;
  {
    ChildProcess process(shell(with_daemon("read x")), {}, 0);
    process.receive(expires_after(k_patience_s));
    const Bystander meanwhile;
    EXPECT_THAT(failure_of(process).what(), HasSubstr("ended with exit code"));
    EXPECT_FALSE(meanwhile.has_ended());
  }
  EXPECT_FALSE(before.has_ended());
}

TEST(ChildProcess, EndsWithAKilledProgram) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  const pid_t program = ::fork();
  if (program == 0) {
    ChildProcess process(shell("echo $$; " + with_daemon("read x")), {}, 0);
    for (int i = 0; i < 2; ++i) write_line(ends[1], process.receive(expires_after(k_patience_s)));
    while (true) ::pause();
  }
  std::string text;
  while (std::ranges::count(text, '\n') < 2) {
    char c = 0;
    ASSERT_EQ(::read(ends[0], &c, 1), 1);
    text += c;
  }
  const pid_t child = std::stoi(text), daemon = std::stoi(text.substr(text.find('\n')));
  EXPECT_TRUE(is_running(child) && is_running(daemon));
  ::kill(program, SIGKILL);
  ::waitpid(program, nullptr, 0);
  EXPECT_TRUE(ends_soon(child));
  EXPECT_TRUE(ends_soon(daemon));
  ::close(ends[0]);
  ::close(ends[1]);
}

TEST(ChildProcess, ItsKeeperHoldsNeitherMemoryNorFiles) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "their own functions need the memory";
#endif
  const std::vector<char> memory(std::size_t{256} << 20, 'x');
  const auto anonymous_kb_of_keeper = [] {
    ChildProcess process(shell("sleep 0.2; grep RssAnon /proc/$PPID/status; ls /proc/$PPID/fd | wc -l"), {}, 0);
    const std::string line = process.receive(expires_after(k_patience_s));
    EXPECT_EQ(process.receive(expires_after(k_patience_s)), "0");
    return std::stoi(line.substr(line.find_first_of("0123456789")));
  };
  constexpr int k_most_kb = 8 << 10;  // stack, thread-local data, variables of libraries
  EXPECT_LT(anonymous_kb_of_keeper(), k_most_kb);
  int in_a_thread = 0;
  std::thread([&] { in_a_thread = anonymous_kb_of_keeper(); }).join();
  EXPECT_LT(in_a_thread, k_most_kb);
  EXPECT_EQ(memory[memory.size() / 2], 'x') << "that of this program stays";
}

}  // namespace
}  // namespace sixdof
