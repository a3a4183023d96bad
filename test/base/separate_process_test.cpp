#include <sixdof/base/separate_process.h>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>

namespace sixdof {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool k_sanitized = true;  // What ends for want of memory does so in the sanitizer's own way.
#else
constexpr bool k_sanitized = false;
#endif

constexpr std::size_t k_mb = std::size_t{1} << 20;

using Work = std::function<std::string()>;

/// What work() returns in a process of its own, behind its length.
std::string run(const Work& work, const SeparateLimits& limits = {}) {
  std::string result;
  run_separately(
      [&](SeparateOutput& output) {
        const std::string bytes = work();
        const std::size_t size = bytes.size();
        output.write(&size, sizeof(size));
        output.write(bytes.data(), size);
      },
      [&](SeparateInput& input) {
        std::size_t size = 0;
        input.read(&size, sizeof(size));
        result.resize(size);
        input.read(result.data(), size);
      },
      limits);
  return result;
}

/// The words of the failure, or "gave N bytes".
std::string failure(const Work& work, const SeparateLimits& limits = {}) {
  try {
    return "gave " + std::to_string(run(work, limits).size()) + " bytes";
  } catch (const SeparateFailure& e) {
    return e.what();
  }
}

[[gnu::noinline]] std::size_t deeper(std::size_t depth, volatile char* above) {
  volatile char here[1000];
  here[0] = *above;
  return depth == 0 ? 0 : deeper(depth - 1, here) + static_cast<std::size_t>(here[0]);
}

TEST(SeparateProcess, GivesBackWhatTheWorkReturnedAndChangesNothingHere) {
  int counter = 3;
  const std::string empty = run([] { return std::string(); });
  EXPECT_EQ(empty, "");
  std::string large(5'000'000, 'x');
  large[4'000'001] = '\0';
  const std::string copy = run([&] { return ++counter, large; });
  EXPECT_EQ(copy, large);
  EXPECT_EQ(counter, 3);
}

TEST(SeparateProcess, EveryEndIsNamed) {
  EXPECT_EQ(failure([]() -> std::string {
              std::raise(SIGSEGV);
              return {};
            }),
            "ended by signal 11 (Segmentation fault)");
  EXPECT_EQ(failure([]() -> std::string { std::abort(); }), "ended by signal 6 (Aborted)");
  EXPECT_EQ(failure([]() -> std::string { ::_exit(0); }), "ended with exit code 0");
  EXPECT_EQ(failure([]() -> std::string { ::_exit(7); }), "ended with exit code 7");
  EXPECT_EQ(failure([]() -> std::string { throw Error("words"); }), "ended by an exception: words");
  EXPECT_EQ(failure([]() -> std::string { throw 5; }), "ended by signal 6 (Aborted)");
  EXPECT_EQ(failure([]() -> std::string {
              ::close(3);
              ::pause();
              return {};
            }),
            "ended by signal 9 (Killed)");
}

TEST(SeparateProcess, AResultThatIsNotWholeIsNone) {
  char byte = 0;
  const auto read_two = [&](SeparateInput& input) {
    input.read(&byte, 1);
    input.read(&byte, 1);
  };
  const auto words = [&](const std::function<void(SeparateOutput&)>& work) -> std::string {
    try {
      run_separately(work, read_two, {});
    } catch (const SeparateFailure& e) {
      return e.what();
    }
    return "whole";
  };
  EXPECT_EQ(words([](SeparateOutput& output) { output.write("ab", 2); }), "whole");
  EXPECT_EQ(words([](SeparateOutput& output) { output.write("ab", 2), output.finish(), std::abort(); }), "whole");
  EXPECT_EQ(words([](SeparateOutput& output) { output.write("a", 1); }), "ended with exit code 0");
  EXPECT_EQ(words([](SeparateOutput& output) { output.write("a", 1), std::abort(); }), "ended by signal 6 (Aborted)");
  EXPECT_THAT(words([](SeparateOutput& output) { output.write("a", 1), throw Error("late"); }),
              StartsWith("ended with"));
}

TEST(SeparateProcess, HandlersOfTheCallerAreNotItsOwn) {
  const auto before = std::signal(SIGSEGV, [](int) { ::_exit(0); });
  EXPECT_EQ(failure([]() -> std::string {
              std::raise(SIGSEGV);
              return {};
            }),
            "ended by signal 11 (Segmentation fault)");
  std::signal(SIGSEGV, before);
  EXPECT_EQ(failure([]() -> std::string {
              std::raise(SIGINT);
              return "!";
            }),
            "gave 1 bytes")
      << "Ctrl-C passes it by";
}

TEST(SeparateProcess, LimitsHold) {
  SeparateLimits limits;
  limits.processor_s = 1.0;
  EXPECT_EQ(failure(
                []() -> std::string {
                  volatile std::size_t turns = 0;
                  while (true) turns = turns + 1;
                },
                limits),
            "took longer than 1 s of processor time");
  limits = {};
  limits.wall_s = 0.25;
  EXPECT_EQ(failure(
                []() -> std::string {
                  ::pause();
                  return {};
                },
                limits),
            "took longer than 0.25 s");
  limits = {};
  limits.result_bytes = 100;
  EXPECT_EQ(failure([] { return std::string(93, 'x'); }, limits), "gave more than 100 bytes") << "with their length";
  EXPECT_EQ(failure([] { return std::string(92, 'x'); }, limits), "gave 92 bytes");
  const auto endless = []() -> std::string {
    volatile char start = 0;
    return std::to_string(deeper(std::size_t{1} << 40, &start));
  };
  EXPECT_EQ(failure(endless), "ended by signal 11 (Segmentation fault)");
}

TEST(SeparateProcess, MemoryIsLimitedBeyondWhatTheCallerHas) {
  const std::vector<char> of_the_caller(300 * k_mb, 'x');
  SeparateLimits limits;
  limits.memory_bytes = 200 * k_mb;
  const auto take = [](std::size_t bytes) { return std::string(std::to_string(std::vector<char>(bytes, 'y').back())); };
  EXPECT_EQ(failure([&] { return take(100 * k_mb); }, limits), "gave 3 bytes");
  const std::string words = failure([&] { return take(400 * k_mb); }, limits);
  if (k_sanitized) {
    EXPECT_THAT(words, StartsWith("ended "));
  } else {
    EXPECT_EQ(words, "ran out of 0.2 GB of memory");
  }
  EXPECT_EQ(of_the_caller.back(), 'x');
}

TEST(SeparateProcess, HasNoFilesOfTheCaller) {
  const int file = ::open("/dev/zero", O_RDONLY);
  ASSERT_GE(file, 0);
  char byte = 'x';
  EXPECT_EQ(run([&] { return std::to_string(::read(file, &byte, 1)); }), "-1");
  EXPECT_EQ(::read(file, &byte, 1), 1);
  ::close(file);
}

TEST(SeparateProcess, NoneIsLeftBehind) {
  for (int i = 0; i < 20; ++i) failure([] { return std::string(10, 'x'); });
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1) << "no child, neither alive nor unburied";
}

TEST(SeparateProcess, SeveralThreadsAtOnceEachGetTheirOwn) {
  constexpr int k_threads = 4, k_rounds = 50;
  std::atomic<int> wrong = 0;
  std::vector<std::thread> threads;
  for (int t = 0; t < k_threads; ++t) {
    threads.emplace_back([&, t] {
      for (int i = 0; i < k_rounds; ++i) {
        const std::string mine(static_cast<std::size_t>(1000 * t + i), static_cast<char>('a' + t));
        if (i % 5 == 4) {
          if (failure([]() -> std::string { std::abort(); }) != "ended by signal 6 (Aborted)") ++wrong;
        } else if (run([&] { return mine + mine; }) != mine + mine) {
          ++wrong;
        }
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace sixdof
