// The script that `sixdof completion bash` prints, in a bash that is asked what it would complete.

#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

#include <gmock/gmock.h>

#include "run_program.h"
#include "scratch_folder.h"

namespace sixdof {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::IsSupersetOf;
using ::testing::Not;
using ::testing::UnorderedElementsAre;
using Words = std::vector<std::string>;

class Completion : public test::ScratchFolder {
 protected:
  Completion() {
    EXPECT_EQ(test::run_program(SIXDOF_PROGRAM " completion bash > " + path("sixdof.bash")).exit_code, 0);
    EXPECT_EQ(test::run_program(SIXDOF_BENCH_PROGRAM " --completion bash > " + path("sixdof-bench.bash")).exit_code, 0);
    std::filesystem::create_directories(path("work/folder"));
    std::ofstream(path("work/hull one.stl")) << "x";
    std::ofstream(path("work/hull.ply")) << "x";
  }

  /// What bash completes, of a line whose words are given as bash splits them: "=" is a word of its own.
  Words complete(const std::vector<std::string>& words) const {
    std::string line = "COMP_WORDS=(";
    for (const std::string& word : words) line += "'" + word + "' ";
    line += "); COMP_CWORD=" + std::to_string(words.size() - 1);
    std::ofstream(path("ask.bash")) << "set -u\nsource " << path(words[0] + ".bash") << "\ncd " << path("work") << "\n"
                                    << line << "\nfunction=$(complete -p " << words[0]
                                    << ")\nfunction=${function#*-F }\n${function%% *}\n"
                                    << "for word in \"${COMPREPLY[@]}\"; do printf '%s\\n' \"$word\"; done\n";
    const auto result = test::run_program("bash --norc " + path("ask.bash"));
    EXPECT_EQ(result.err, "") << line;
    Words found;
    std::istringstream lines(result.out);
    for (std::string word; std::getline(lines, word);) found.push_back(word);
    return found;
  }
};

TEST_F(Completion, OfCommands) {
  EXPECT_THAT(complete({"sixdof", ""}), IsSupersetOf({"models", "query", "generate", "scene", "completion"}));
  EXPECT_THAT(complete({"sixdof", "re"}), ElementsAre("repair", "report", "recommend"));
  EXPECT_THAT(complete({"sixdof", "scene", ""}), ElementsAre("make", "info", "play"));
  EXPECT_THAT(complete({"sixdof", "models", "m"}), ElementsAre("make"));
  EXPECT_THAT(complete({"sixdof", "completion", ""}), ElementsAre("bash"));
}

TEST_F(Completion, OfOptions) {
  EXPECT_THAT(complete({"sixdof", "query", "--a"}), ElementsAre("--a", "--along", "--algorithm", "--about"));
  EXPECT_THAT(complete({"sixdof", "-"}), IsSupersetOf({"--help", "--version"}));
  const Words options = complete({"sixdof", "scene", "play", "s.h5", "--"});
  EXPECT_THAT(options, IsSupersetOf({"--algorithms", "--question", "--frames", "--list", "--json"}));
  EXPECT_THAT(options, Not(Contains("--pose")));
}

TEST_F(Completion, OfValues) {
  EXPECT_THAT(complete({"sixdof", "query", "--algorithm", "exa"}),
              ElementsAre("exact", "exact-contacts", "exact-depth", "exact-way-out", "exact-penetration"));
  EXPECT_THAT(complete({"sixdof", "query", "--algorithm", "=", "brute"}), ElementsAre("brute-force"));
  EXPECT_THAT(complete({"sixdof", "query", "--algorithm", "="}), IsSupersetOf({"exact", "ist", "vps"}));
  EXPECT_THAT(complete({"sixdof", "query", "--a", "torus-k"}),
              IsSupersetOf({"torus-knot-1k", "torus-knot-10k", "torus-knot-100k"}));
  EXPECT_THAT(complete({"sixdof", "recommend", "--metric", "gamma_F_d"}), ElementsAre("gamma_F_deg"));
  EXPECT_THAT(complete({"sixdof", "recommend", "--order", ""}), ElementsAre("random", "motion"));
  EXPECT_THAT(complete({"sixdof", "query", "--isolate", "=", "th"}), ElementsAre("third-party"));
  EXPECT_THAT(complete({"sixdof", "quality", "--scenario", "I"}), ElementsAre("Ia", "Ib", "II", "III", "IV"));
  EXPECT_THAT(complete({"sixdof", "conform", "--checks", "Wit"}), ElementsAre("Witnesses"));
  EXPECT_THAT(complete({"sixdof", "agree", "--pair", "torus"}), Contains("torus-knot-10k"));
  // A number, a pose: nothing to complete.
  EXPECT_THAT(complete({"sixdof", "generate", "--threads", ""}), IsEmpty());
  // Behind a flag anything may follow.
  EXPECT_THAT(complete({"sixdof", "scene", "make", "--json", "gia"}), ElementsAre("giant"));
}

TEST_F(Completion, OfTheLastElementOfAList) {
  EXPECT_THAT(complete({"sixdof", "query", "--only", "collide,dis"}), ElementsAre("collide,distance"));
  EXPECT_THAT(complete({"sixdof", "scene", "play", "--question", "touching,near,c"}),
              ElementsAre("touching,near,closest"));
  EXPECT_THAT(complete({"sixdof", "scene", "play", "--algorithms", "exact,all"}), ElementsAre("exact,all-pairs"));
}

TEST_F(Completion, OfFilesAndFolders) {
  EXPECT_THAT(complete({"sixdof", "info", "hu"}), UnorderedElementsAre("hull one.stl", "hull.ply"));
  EXPECT_THAT(complete({"sixdof", "models", "make", "-o", "hu"}), UnorderedElementsAre("hull one.stl", "hull.ply"));
  EXPECT_THAT(complete({"sixdof", "merge", ""}), ElementsAre("folder"));
  EXPECT_THAT(complete({"sixdof", "table", "a.json", "hull."}), ElementsAre("hull.ply"));
}

TEST_F(Completion, OfTheBenchmark) {
  EXPECT_THAT(complete({"sixdof-bench", "--benchmark_f"}), IsSupersetOf({"--benchmark_filter", "--benchmark_format"}));
  EXPECT_THAT(complete({"sixdof-bench", "--suite", "own"}), ElementsAre("own-pair"));
  EXPECT_THAT(complete({"sixdof-bench", "--b", "cone-1"}), IsSupersetOf({"cone-1k", "cone-10k", "cone-100k"}));
  EXPECT_THAT(complete({"sixdof-bench", "--set", "hull."}), ElementsAre("hull.ply"));
}

TEST_F(Completion, KnowsEveryCommandAndOption) {
  // Of the help of every command, which is made of the same definition by other code.
  const auto help = [](const std::string& command) {
    return test::run_program(std::string(SIXDOF_PROGRAM) + " " + command + " --help").out;
  };
  const Words commands = complete({"sixdof", ""});
  EXPECT_GE(commands.size(), 21u);
  for (const std::string& command : commands) {
    EXPECT_NE(help("").find("\n  " + command + " "), std::string::npos) << command;
    for (const std::string& option : complete({"sixdof", command, "--"})) {
      EXPECT_NE(help(command).find(option), std::string::npos) << command << " " << option;
    }
  }
}

TEST_F(Completion, RefusesAnotherShell) {
  const auto result = test::run_program(SIXDOF_PROGRAM " completion fish");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("fish not in {bash}"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace sixdof
