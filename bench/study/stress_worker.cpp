#include "bench/study/stress_worker.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <new>
#include <string>

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>
#include <sixdof/process/child_process.h>

namespace sixdof::study {
namespace {

using nlohmann::json;
using stability::Verdict;

/// No option of any command.
constexpr const char* k_word = "--stress-cell";
constexpr int k_beacon_descriptor = 3;
constexpr int k_exit_memory = 90, k_exit_thrown = 91;

/// A NaN or an infinity would not come back.
double finite(double x) { return std::isfinite(x) ? x : std::numeric_limits<double>::max(); }

json to_json(const CaseId& id) { return {id.field, id.genes}; }

CaseId id_of(const json& pair) { return {pair.at(0).get<std::size_t>(), pair.at(1).get<stability::Genes>()}; }

std::string result_line(const StressCell& cell) {
  const auto& worst = cell.worst;
  const json all{{"settings", cell.settings},
                 {"cases", cell.cases},
                 {"unsupported", cell.unsupported},
                 {"id", to_json(cell.id)},
                 {"slow_id", to_json(cell.slow_id)},
                 {"slow_shot", cell.slow_shot},
                 {"slowest", cell.slowest_seconds},
                 {"verdict", static_cast<int>(worst.verdict)},
                 {"metric", worst.metric},
                 {"value", finite(worst.value)},
                 {"unit", worst.unit},
                 {"excess", finite(worst.excess)},
                 {"shot", worst.shot},
                 {"words", worst.words}};
  return all.dump(-1, ' ', false, json::error_handler_t::replace);
}

/// Libraries print before they abort; the verdict says it. @returns a descriptor of what was standard output
int silence_standard_streams() {
  const int output = high_descriptor(::dup(STDOUT_FILENO));
  if (const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC); nowhere >= 0) {
    ::dup2(nowhere, STDOUT_FILENO);
    ::dup2(nowhere, STDERR_FILENO);
    ::close(nowhere);
  }
  return output;
}

StressCell run_job(const json& job, const FindAlgorithm& find) {
  const StressEffort effort{.samples = job.at("samples"),
                            .declared_samples = job.at("declared_samples"),
                            .generations = job.at("generations"),
                            .children = job.at("children")};
  const SharedBeacon beacon(k_beacon_descriptor);
  const StressWatch watch{.begins_case = [&](const CaseId& id) { beacon->id = id, beacon->pose = {}, ++beacon->beats; },
                          .prepares = [&] { ++beacon->beats; },
                          .asks = [&](const Pose& X_AB) { beacon->pose = pose_numbers(X_AB), ++beacon->beats; }};
  return run_cell(stability::find_family(job.at("family").get<std::string>()),
                  find(job.at("algorithm"), job.at("external").get<std::vector<std::string>>()),
                  job.at("at_defaults") ? StressSettings::defaults : StressSettings::coarsest, effort, job.at("seed"),
                  watch);
}

}  // namespace

std::array<double, 12> pose_numbers(const Pose& X_AB) {
  std::array<double, 12> all{};
  std::copy(X_AB.R.data(), X_AB.R.data() + 9, all.begin());
  std::copy(X_AB.t.data(), X_AB.t.data() + 3, all.begin() + 9);
  return all;
}

SharedBeacon::SharedBeacon(int descriptor) {
  void* const memory = ::mmap(nullptr, sizeof(StressBeacon), PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
  if (memory == MAP_FAILED) throw Error(fmt::format("stress: memory of two processes: {}", std::strerror(errno)));
  beacon_ = static_cast<StressBeacon*>(memory);
}

SharedBeacon::~SharedBeacon() { ::munmap(beacon_, sizeof(StressBeacon)); }

std::vector<std::string> stress_cell_command(const StressCell& cell, const StressEffort& effort, std::uint64_t seed,
                                             const std::vector<std::string>& external) {
  const json job{{"family", cell.family->name},
                 {"algorithm", cell.algorithm->traits().name},
                 {"at_defaults", cell.which == StressSettings::defaults},
                 {"samples", effort.samples},
                 {"declared_samples", effort.declared_samples},
                 {"generations", effort.generations},
                 {"children", effort.children},
                 {"seed", seed},
                 {"external", external}};
  return {"/proc/self/exe", k_word, job.dump()};
}

std::optional<int> run_stress_cell_if_asked(int argc, const char* const* argv, const FindAlgorithm& find) {
  if (argc != 3 || std::strcmp(argv[1], k_word) != 0) return std::nullopt;
  int output = -1;
  try {
    output = silence_standard_streams();
    write_line(output, result_line(run_job(json::parse(argv[2]), find)));
    return 0;
  } catch (const std::bad_alloc&) {
    if (output >= 0) write_line(output, std::string(ChildProcess::k_memory_note));
    return k_exit_memory;
  } catch (...) {
    return k_exit_thrown;
  }
}

void read_result(std::string_view line, StressCell& cell) {
  const json all = json::parse(line);
  all.at("settings").get_to(cell.settings);
  all.at("cases").get_to(cell.cases);
  all.at("unsupported").get_to(cell.unsupported);
  cell.id = id_of(all.at("id"));
  cell.slow_id = id_of(all.at("slow_id"));
  all.at("slow_shot").get_to(cell.slow_shot);
  all.at("slowest").get_to(cell.slowest_seconds);
  cell.worst = {.verdict = static_cast<Verdict>(all.at("verdict").get<int>()),
                .metric = all.at("metric"),
                .value = all.at("value"),
                .unit = all.at("unit"),
                .excess = all.at("excess"),
                .shot = all.at("shot"),
                .words = all.at("words")};
}

}  // namespace sixdof::study
