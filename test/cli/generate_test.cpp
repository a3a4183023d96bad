#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <random>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include <fcntl.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/parallel.h>
#include <sixdof/configuration/shard_file.h>
#include "bench/common/run_guarded.h"

#include "run_program.h"

namespace sixdof {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using Clock = std::chrono::steady_clock;

/// Two different meshes, both kinds of bucket on different grids.
const std::vector<std::string> k_job{
    "generate",    "--a",    "bumpy-sphere-200", "--b", "torus-knot-600", "--grid", "45/60", "--volume-grid", "90",
    "--distances", "0,5,20", "--volumes",        "5",   "--threads",      "1"};
constexpr std::size_t k_shards = 12;

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// A run of the program in the background.
class Running {
 public:
  explicit Running(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), SIXDOF_PROGRAM);
    std::vector<char*> pointers;
    for (std::string& argument : arguments) pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    pid_ = ::fork();
    if (pid_ != 0) return;
    const int nowhere = ::open("/dev/null", O_WRONLY);
    ::dup2(nowhere, STDOUT_FILENO);
    ::dup2(nowhere, STDERR_FILENO);
    ::execv(pointers[0], pointers.data());
    std::_Exit(127);
  }
  void send(int signal) const { ::kill(pid_, signal); }
  /// Exit code, or 128 + signal.
  int wait() const {
    int status = 0;
    ::waitpid(pid_, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

 private:
  pid_t pid_ = -1;
};

class Generate : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) /
              (std::string("sixdof_generate_") + testing::UnitTest::GetInstance()->current_test_info()->name() +
               std::to_string(::getpid()));
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// The job with further arguments; an option with a value that it has already takes the new value.
  static std::vector<std::string> job_with(const std::vector<std::string>& more) {
    std::vector<std::string> arguments = k_job;
    for (std::size_t i = 0; i < more.size(); ++i) {
      const auto known = more[i].starts_with("--") ? std::ranges::find(arguments, more[i]) : arguments.end();
      if (known != arguments.end()) {
        *std::next(known) = more[++i];
      } else {
        arguments.push_back(more[i]);
      }
    }
    return arguments;
  }
  test::ProgramResult run(const std::vector<std::string>& arguments) const {
    std::string command = SIXDOF_PROGRAM;
    for (const std::string& argument : arguments) command += " '" + argument + "'";
    return test::run_program(command);
  }
  test::ProgramResult make_shards(const std::string& where, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"--shards", std::to_string(k_shards), "-o", folder_ / where};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(job_with(arguments));
  }
  test::ProgramResult merge(const std::string& where) const {
    return run({"merge", folder_ / where, "-o", folder_ / (where + ".h5")});
  }
  /// The set that one process makes without shards.
  std::string undisturbed() const {
    const auto result = run(job_with({"-o", folder_ / "undisturbed.h5"}));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return bytes_of(folder_ / "undisturbed.h5");
  }
  /// Files in a folder with this end of the name; none where the folder does not exist yet.
  std::size_t count(const std::string& where, const std::string& end) const {
    std::size_t n = 0;
    std::error_code absent;
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / where, absent)) {
      n += entry.path().string().ends_with(end) ? 1 : 0;
    }
    return n;
  }

  std::filesystem::path folder_;
};

TEST_F(Generate, ShardsMergeToTheBytesOfTheWholeSet) {
  const std::string expected = undisturbed();
  ASSERT_EQ(make_shards("all").exit_code, 0);
  EXPECT_EQ(merge("all").exit_code, 0);
  EXPECT_EQ(bytes_of(folder_ / "all.h5"), expected);
  // Each as a process of its own, in another order, with other threads.
  for (std::size_t number = k_shards; number >= 1; --number) {
    const auto result = make_shards("one-by-one", {"--shard", std::to_string(number), "--threads", "2"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
  }
  EXPECT_EQ(merge("one-by-one").exit_code, 0);
  EXPECT_EQ(bytes_of(folder_ / "one-by-one.h5"), expected);
}

TEST_F(Generate, ShardsOfMeshesInFilesMergeToTheBytesOfTheWholeSet) {
  const std::string mesh = folder_ / "my.ply";
  ASSERT_EQ(run({"models", "make", "bumpy-sphere-200", "-o", mesh}).exit_code, 0);
  ASSERT_EQ(run(job_with({"--a", mesh, "-o", folder_ / "whole.h5"})).exit_code, 0);
  ASSERT_EQ(make_shards("shards", {"--a", mesh}).exit_code, 0);
  ASSERT_EQ(merge("shards").exit_code, 0);
  EXPECT_EQ(bytes_of(folder_ / "shards.h5"), bytes_of(folder_ / "whole.h5"));
  const auto info = run({"info", folder_ / "shards.h5"});
  EXPECT_THAT(info.out, HasSubstr(mesh + " (" + mesh + ")"));
  EXPECT_THAT(run({"info", folder_ / "shards.h5", "--json"}).out, HasSubstr("\"absolute_path\": \"" + mesh + "\""));
  // A path is no part of a set's content.
  EXPECT_THAT(info.out, Not(HasSubstr("torus-knot-600.")));
}

TEST_F(Generate, TakesPercentagesBelowOne) {
  const std::string set = folder_ / "set.h5";
  const auto made = run(job_with({"--distances", "0.5,0,12.125,1:2", "--volumes", "0.5,5", "-o", set}));
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const std::string out = run({"info", set}).out;
  std::size_t before = 0;
  for (const char* const bucket : {"\ndistance/00 ", "\ndistance/0.5 ", "\ndistance/01 ", "\ndistance/02 ",
                                   "\ndistance/12.125 ", "\nvolume/0.5 ", "\nvolume/05 "}) {
    const std::size_t at = out.find(bucket);
    ASSERT_NE(at, std::string::npos) << bucket << out;
    EXPECT_GT(at, before) << bucket;
    before = at;
  }
  const auto verified = run({"verify", set, "--sample", "20"});
  EXPECT_EQ(verified.exit_code, 0) << verified.out << verified.err;
  const auto motions = run({"verify", set, "--motions", "3", "--json"});
  ASSERT_EQ(motions.exit_code, 0) << motions.out << motions.err;
  const auto lines = nlohmann::json::parse(motions.out).at("motions");
  EXPECT_EQ(lines.size(), 12u) << "three kinds, four lengths";
  for (const auto& line : lines) EXPECT_EQ(line.at("motions"), 3) << line;
  EXPECT_THAT(run({"verify", set, "--motions", "2"}).out, HasSubstr("tumble 100 %"));
  for (const char* const bad : {"0.5:2", "1:2.5", "0.0001", "1e-1", ".5", "-1", "100.5", "1."}) {
    const auto refused = run(job_with({"--distances", bad, "-o", folder_ / "bad.h5"}));
    EXPECT_EQ(refused.exit_code, k_exit_error) << bad;
    EXPECT_THAT(refused.err, HasSubstr(std::string("percentages '") + bad + "'"));
  }
}

TEST_F(Generate, WarnsOfOddSizesAndOfBucketsThatNothingReaches) {
  std::ofstream(folder_ / "tiny.off") << "OFF\n4 4 0\n0 0 0\n.001 0 0\n0 .001 0\n0 0 .001\n"
                                         "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
  const auto made = run(job_with({"--b", folder_ / "tiny.off", "-o", folder_ / "set.h5"}));
  EXPECT_EQ(made.exit_code, 0) << made.err;
  EXPECT_THAT(made.err, AllOf(HasSubstr("sixdof: warning: bumpy-sphere-200 is "), HasSubstr(" times as large as tiny"),
                              HasSubstr("set.h5: no configuration reaches volume 5 %\n")));
  EXPECT_EQ(std::ranges::count(made.err, '\n'), 2);
  ASSERT_EQ(make_shards("shards", {"--b", folder_ / "tiny.off"}).exit_code, 0);
  EXPECT_THAT(merge("shards").err, HasSubstr("no configuration reaches volume 5 %\n"));
  for (const std::vector<std::string>& other :
       {std::vector<std::string>{"verify", folder_ / "set.h5", "--sample", "1"},
        {"query", "--a", "bumpy-sphere-200", "--b", folder_ / "tiny.off", "--pose", "3 0 0 1 0 0 0"}}) {
    EXPECT_THAT(run(other).err, HasSubstr(" times as large as tiny")) << other.front();
  }
}

TEST_F(Generate, ResumeKeepsValidShardsAndMakesTheOthersAgain) {
  ASSERT_EQ(make_shards("set").exit_code, 0);
  const auto first = folder_ / "set" / shard_file_name({.number = 1, .count = k_shards});
  const auto second = folder_ / "set" / shard_file_name({.number = 2, .count = k_shards});
  const std::string bytes = bytes_of(second);
  const auto kept = std::filesystem::last_write_time(first);
  std::filesystem::resize_file(second, bytes.size() / 2);
  EXPECT_THAT(merge("set").err, AllOf(HasSubstr("cannot be merged"), HasSubstr(second.string())));
  EXPECT_EQ(make_shards("set").exit_code, k_exit_error) << "without --resume nothing is replaced";

  const auto resumed = make_shards("set", {"--resume"});
  EXPECT_EQ(resumed.exit_code, 0);
  EXPECT_THAT(resumed.err, HasSubstr("made again: " + second.string()));
  EXPECT_THAT(resumed.out, HasSubstr("1 of 12 shards"));
  EXPECT_EQ(bytes_of(second), bytes);
  EXPECT_EQ(std::filesystem::last_write_time(first), kept);

  // Shards of another job are not replaced.
  const auto foreign = make_shards("set", {"--resume", "--distances", "0"});
  EXPECT_EQ(foreign.exit_code, k_exit_error);
  EXPECT_THAT(foreign.err, AllOf(HasSubstr(first.string()), HasSubstr("the buckets are")));
  EXPECT_EQ(std::filesystem::last_write_time(first), kept);
}

TEST_F(Generate, RefusesShardsThatCannotBe) {
  EXPECT_THAT(make_shards("set", {"--shard", "13"}).err, HasSubstr("shard 13 of 12"));
  EXPECT_THAT(run(job_with({"--shards", "45", "-o", folder_ / "set"})).err, HasSubstr("distinct rotations"));
  EXPECT_THAT(run(job_with({"--resume", "-o", folder_ / "set.h5"})).err, HasSubstr("go with --shards"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "set"));
}

TEST_F(Generate, ShowsProgressOnlyWhereAsked) {
  const auto silent = run(job_with({"-o", folder_ / "set.h5"}));
  EXPECT_EQ(silent.err, "");
  const auto shown = make_shards("set", {"--progress"});
  EXPECT_THAT(shown.err, AllOf(HasSubstr("distances 0/"), HasSubstr("volumes 0/"), Not(HasSubstr("\r"))));
  EXPECT_EQ(run({"merge", folder_ / "set", "-o", folder_ / "merged.h5"}).err, "");
  EXPECT_THAT(run({"merge", folder_ / "set", "-o", folder_ / "merged.h5", "--progress"}).err, HasSubstr("merged 1/"));
}

TEST_F(Generate, PlansThePapersSet) {
  const auto counts = run({"generate", "--grid", "paper", "--distances", "0:30", "--volumes", "0:10", "--plan"});
  EXPECT_EQ(counts.exit_code, 0) << counts.err;
  EXPECT_THAT(counts.out, AllOf(HasSubstr("7488, of which 6384 distinct"), HasSubstr("1008, of which 744 distinct"),
                                HasSubstr("64695456, of which 54819408 computed")));
  EXPECT_THAT(counts.out, Not(HasSubstr("CPU-hours")));
  const auto estimate = run(job_with({"--plan", "--shards", "5", "--plan-seconds", "0.2"}));
  EXPECT_EQ(estimate.exit_code, 0) << estimate.err;
  for (const char* expected :
       {"distances", "volumes", "us per configuration", "CPU-hours", "seed 1", "time of one shard",
        "memory of a process", "5 shards of", "median", "p99", "greatest", "(rotation ", "configurations sampled"}) {
    EXPECT_THAT(estimate.out, HasSubstr(expected));
  }
  EXPECT_THAT(run(job_with({"--plan", "--shards", "1000"})).err, HasSubstr("distinct rotations"));
  EXPECT_THAT(run(job_with({"--plan", "--plan-seconds", "0"})).out, Not(HasSubstr("CPU-hours")));
  EXPECT_EQ(run(job_with({"--plan", "--plan-seconds", "-1"})).exit_code, k_exit_usage);
}

/// kill -9 a random time after a random number of shards: every file with a shard's name is valid, and --resume and
/// merge give the bytes of the undisturbed set. SIXDOF_SEED repeats the draws.
TEST_F(Generate, SurvivesKillsAtAnyTime) {
  constexpr int k_rounds = 20;
  const char* const wish = std::getenv("SIXDOF_SEED");
  const unsigned seed = wish != nullptr ? static_cast<unsigned>(std::atoi(wish)) : std::random_device{}();
  std::cout << "SIXDOF_SEED=" << seed << std::endl;
  std::mt19937_64 random(seed);
  const std::string expected = undisturbed();
  const auto start = Clock::now();
  ASSERT_EQ(make_shards("timed").exit_code, 0);
  const double seconds_per_shard = std::chrono::duration<double>(Clock::now() - start).count() / k_shards;

  int killed = 0, with_some = 0;
  for (int round = 0; round < k_rounds; ++round) {
    SCOPED_TRACE("seed " + std::to_string(seed) + ", round " + std::to_string(round));
    const std::string where = "round-" + std::to_string(round);
    const Running running(job_with({"--shards", std::to_string(k_shards), "-o", folder_ / where, "--resume"}));
    // Counted from a shard, not from the start, the kill comes before the end at any speed of the machine.
    const auto awaited = std::uniform_int_distribution<std::size_t>(0, k_shards - 3)(random);
    const auto deadline = Clock::now() + std::chrono::seconds(60);
    while (count(where, ".h5") < awaited && Clock::now() < deadline) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    std::this_thread::sleep_for(
        std::chrono::duration<double>(std::uniform_real_distribution<double>(0.0, 2.0 * seconds_per_shard)(random)));
    running.send(SIGKILL);
    killed += running.wait() == 128 + SIGKILL ? 1 : 0;
    std::size_t finished = 0;
    if (std::filesystem::exists(folder_ / where)) {
      for (const auto& entry : std::filesystem::directory_iterator(folder_ / where)) {
        if (entry.path().extension() != ".h5") continue;
        EXPECT_NO_THROW(ShardFile(entry.path()).check_values());
        ++finished;
      }
    }
    with_some += finished > 0 && finished < k_shards ? 1 : 0;
    const auto resumed = make_shards(where, {"--resume"});
    EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
    EXPECT_EQ(resumed.err, "") << "no shard was damaged";
    EXPECT_EQ(count(where, ".partial"), 0u);
    const auto merged = merge(where);
    EXPECT_EQ(merged.exit_code, 0) << merged.err;
    EXPECT_EQ(bytes_of(folder_ / (where + ".h5")), expected);
    std::filesystem::remove_all(folder_ / where);
  }
  // Most kills came before the end, and some between two shards.
  EXPECT_GT(killed, k_rounds / 2);
  EXPECT_GT(with_some, k_rounds / 4);
}

TEST_F(Generate, UsesNoMoreThreadsThanThereAre) {
  const std::string most = std::to_string(parallel::most_threads());
  const auto many = run({"generate", "--a", "cone-1k", "--grid", "90", "--distances", "5", "--threads", "1000", "-o",
                         folder_ / "many.h5"});
  EXPECT_EQ(many.exit_code, 0) << many.err;
  EXPECT_EQ(many.err, "sixdof: --threads 1000: this process may use " + most + " at once; " + most + " are used\n");
  const auto plan = run(job_with({"--plan", "--plan-seconds", "0.1", "--threads", "1000"}));
  EXPECT_THAT(plan.out, HasSubstr("with " + most + " threads"));
  const auto none = run(
      {"generate", "--a", "cone-1k", "--grid", "90", "--distances", "5", "--threads", "0", "-o", folder_ / "none.h5"});
  EXPECT_EQ(none.err, "");
  EXPECT_EQ(bytes_of(folder_ / "many.h5"), bytes_of(folder_ / "none.h5"));
}

TEST_F(Generate, KilledMergeLeavesNoSetOrAWholeOne) {
  ASSERT_EQ(make_shards("set").exit_code, 0);
  ASSERT_EQ(merge("set").exit_code, 0);
  const auto output = folder_ / "set.h5";
  const std::string expected = bytes_of(output);
  std::filesystem::remove(output);
  for (int milliseconds = 0; milliseconds < 40; milliseconds += 2) {
    const Running running({"merge", folder_ / "set", "-o", output});
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
    running.send(SIGKILL);
    running.wait();
    if (!std::filesystem::exists(output)) continue;
    EXPECT_EQ(bytes_of(output), expected);
    std::filesystem::remove(output);
  }
  EXPECT_EQ(merge("set").exit_code, 0);
  EXPECT_EQ(bytes_of(output), expected);
  EXPECT_EQ(count("", ".partial"), 0u);
}

TEST_F(Generate, InterruptEndsWithItsCodeAndLeavesOnlyWholeShards) {
  // A grid fine enough that the work does not end before the signal.
  const Running running(job_with({"--grid", "20", "--shards", std::to_string(k_shards), "-o", folder_ / "set"}));
  while (!std::filesystem::exists(folder_ / "set" / shard_file_name({.number = 1, .count = k_shards}))) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  running.send(SIGINT);
  EXPECT_EQ(running.wait(), k_exit_interrupted);
  EXPECT_EQ(count("set", ".partial"), 0u);
  EXPECT_GE(count("set", ".h5"), 1u);
  EXPECT_LT(count("set", ".h5"), k_shards);
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / "set")) {
    EXPECT_NO_THROW(ShardFile(entry.path()).check_values());
  }
}

}  // namespace
}  // namespace sixdof
