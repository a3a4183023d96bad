#include "bench/common/interrupt.h"

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>

#include <gtest/gtest.h>

#include <sixdof/base/atomic_file.h>
#include <sixdof/base/error.h>
#include "bench/common/run_guarded.h"

namespace sixdof {
namespace {

namespace fs = std::filesystem;

/// The exit code of a process that does `work`; 128 + signal where a signal ends it.
int exit_code_of(const std::function<void()>& work) {
  const pid_t child = ::fork();
  if (child == 0) {
    work();
    std::_Exit(0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

struct Interrupt : ::testing::Test {
  const fs::path folder = fs::temp_directory_path() / ("sixdof-interrupt-" + std::to_string(::getpid()));
  Interrupt() { fs::create_directories(folder); }
  ~Interrupt() override { fs::remove_all(folder); }
};

TEST_F(Interrupt, EndsWorkThatDoesNotPollAndKeepsWhatIsFinished) {
  for (const int signal : {SIGINT, SIGTERM}) {
    fs::remove(folder / "kept");
    EXPECT_EQ(exit_code_of([&] {
                const InterruptGuard guard("program", [&] { write_file_atomically(folder / "kept", "rows"); });
                const AtomicFile half(folder / "half");
                std::ofstream(half.temporary_path()) << "half";
                std::raise(signal);
                for (;;) ::pause();
              }),
              k_exit_interrupted);
    EXPECT_TRUE(fs::exists(folder / "kept"));
    EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 1) << "no temporary file";
  }
}

TEST_F(Interrupt, LetsWorkThatPollsEndInOrder) {
  EXPECT_EQ(exit_code_of([&] {
              try {
                const InterruptGuard guard("program", [&] { std::_Exit(1); });
                InterruptGuard::check();
                std::raise(SIGINT);
                InterruptGuard::check();
              } catch (const Interrupted&) {
                std::_Exit(InterruptGuard::requested() ? 7 : 2);
              }
            }),
            7);
}

TEST_F(Interrupt, EndsAtOnceAtTheSecondSignal) {
  EXPECT_EQ(exit_code_of([&] {
              const InterruptGuard guard("program", [&] { std::_Exit(1); });
              std::raise(SIGINT);
              std::raise(SIGINT);
            }),
            128 + SIGINT);
}

TEST_F(Interrupt, GivesTheSignalsBack) {
  std::signal(SIGINT, SIG_DFL);  // a script's background jobs ignore it
  { const InterruptGuard guard("program"); }
  EXPECT_EQ(exit_code_of([] { std::raise(SIGINT); }), 128 + SIGINT);
  EXPECT_FALSE(InterruptGuard::requested());
}

}  // namespace
}  // namespace sixdof
