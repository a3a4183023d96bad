#include <sixdof/process/child_process.h>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>
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
bool ends(pid_t process) {
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
  const std::string note = "echo '" + std::string(ChildProcess::k_memory_note) + "'; ";
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
  EXPECT_TRUE(ends(child));
  EXPECT_TRUE(ends(grandchild));
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

}  // namespace
}  // namespace sixdof
