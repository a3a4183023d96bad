#include "bench/study/stress_processes.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstring>
#include <exception>
#include <limits>
#include <memory>
#include <new>
#include <string>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>
#include <sixdof/process/child_process.h>

namespace sixdof::study {
namespace {

using Clock = std::chrono::steady_clock;
using nlohmann::json;
using stability::Verdict;

constexpr int k_exit_memory = 90, k_exit_thrown = 91;

/// What a process is at; shared with its parent.
struct Beacon {
  std::atomic<std::uint64_t> beats;
  CaseId id;
  std::array<double, 12> pose;  ///< R by columns, t.
};

std::array<double, 12> numbers(const Pose& X) {
  std::array<double, 12> all{};
  std::copy(X.R.data(), X.R.data() + 9, all.begin());
  std::copy(X.t.data(), X.t.data() + 3, all.begin() + 9);
  return all;
}

struct Unmap {
  void operator()(Beacon* beacon) const { ::munmap(beacon, sizeof(Beacon)); }
};
using BeaconPointer = std::unique_ptr<Beacon, Unmap>;

BeaconPointer make_beacon() {
  void* const memory = ::mmap(nullptr, sizeof(Beacon), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw Error("stress: no memory to share with a process");
  return BeaconPointer(new (memory) Beacon{});
}

/// A NaN or an infinity would not come back.
double finite(double x) { return std::isfinite(x) ? x : std::numeric_limits<double>::max(); }

json to_json(const CaseId& id) { return {id.field, id.genes}; }

CaseId id_of(const json& pair) { return {pair.at(0).get<std::size_t>(), pair.at(1).get<stability::Genes>()}; }

std::string to_text(const StressCell& cell) {
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

void read_text(const std::string& text, StressCell& cell) {
  const json all = json::parse(text);
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

/// In the child: runs the cell, writes it, ends.
[[noreturn]] void work(const StressPlan& plan, const StressCell& cell, Beacon& beacon, int output) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, SIG_DFL);
  limit_resources(static_cast<std::size_t>(plan.memory_bytes));
  // Libraries print before they abort; the verdict says it.
  const int nowhere = ::open("/dev/null", O_WRONLY);
  ::dup2(nowhere, STDOUT_FILENO);
  ::dup2(nowhere, STDERR_FILENO);
  try {
    const StressWatch watch{.begins_case = [&](const CaseId& id) { beacon.id = id, beacon.pose = {}, ++beacon.beats; },
                            .prepares = [&] { ++beacon.beats; },
                            .asks = [&](const Pose& X_AB) { beacon.pose = numbers(X_AB), ++beacon.beats; }};
    const std::string text = to_text(run_cell(*cell.family, *cell.algorithm, plan.effort, plan.seed, watch));
    for (std::size_t at = 0; at < text.size();) {
      const ssize_t written = ::write(output, text.data() + at, text.size() - at);
      if (written <= 0) ::_exit(k_exit_thrown);
      at += static_cast<std::size_t>(written);
    }
    ::_exit(0);
  } catch (const std::bad_alloc&) {
    ::_exit(k_exit_memory);
  } catch (...) {
    ::_exit(k_exit_thrown);
  }
}

/// A running cell. Its process is killed with the object.
class Process {
 public:
  Process(const StressPlan& plan, StressCell& cell) : cell_(cell), beacon_(make_beacon()) {
    int ends[2];
    if (::pipe(ends) != 0) throw Error(fmt::format("stress: {}", std::strerror(errno)));
    input_ = ends[0];
    id_ = ::fork();
    if (id_ == 0) {
      ::close(ends[0]);
      work(plan, cell, *beacon_, ends[1]);
    }
    ::close(ends[1]);
    ::fcntl(input_, F_SETFL, O_NONBLOCK);
    if (id_ < 0) {
      ::close(input_);
      throw Error(fmt::format("stress: {}", std::strerror(errno)));
    }
  }
  ~Process() {
    if (!ended_) {
      ::kill(id_, SIGKILL);
      ::waitpid(id_, nullptr, 0);
    }
    ::close(input_);
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  /// Reads what there is. @returns whether the cell is done
  bool poll(double silence_s) {
    char block[4096];
    for (ssize_t n = 0; (n = ::read(input_, block, sizeof(block))) > 0;)
      text_.append(block, static_cast<std::size_t>(n));
    int status = 0;
    if (::waitpid(id_, &status, WNOHANG) == id_) {
      ended_ = true;
      for (ssize_t n = 0; (n = ::read(input_, block, sizeof(block))) > 0;)
        text_.append(block, static_cast<std::size_t>(n));
      finish(status);
      return true;
    }
    if (const std::uint64_t beats = beacon_->beats; beats != beats_) {
      beats_ = beats;
      last_beat_ = Clock::now();
    }
    const std::chrono::duration<double> silent = Clock::now() - last_beat_;
    if (silent.count() < silence_s) return false;
    lose(Verdict::hung, fmt::format("no answer in {:.0f} s", silent.count()));
    return true;
  }

 private:
  void finish(int status) {
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0 && !text_.empty()) return read_text(text_, cell_);
    // Nobody here sends SIGKILL to a process that has not been given up: the kernel did, for want of memory.
    const bool killed = WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL;
    const bool said_so = WIFEXITED(status) && WEXITSTATUS(status) == k_exit_memory;
    const ChildFailure end = how_it_ended(status, killed || said_so);
    lose(end.status == Status::out_of_memory ? Verdict::out_of_memory : Verdict::crashed, end.what());
  }

  /// The case and the pose that the process was asked last.
  void lose(Verdict verdict, std::string words) {
    cell_.id = cell_.slow_id = beacon_->id;
    cell_.cases = std::max<std::size_t>(1, cell_.cases);
    cell_.settings = cell_.algorithm->settings().to_string();
    cell_.worst = {.verdict = verdict, .metric = "process", .unit = "1", .words = std::move(words)};
    const stability::Case member = make_case(*cell_.family, cell_.id);
    for (std::size_t i = 0; i < member.shots.size(); ++i) {
      if (numbers(member.shots[i].pose()) == beacon_->pose) cell_.worst.shot = i;
    }
  }

  StressCell& cell_;
  BeaconPointer beacon_;
  pid_t id_ = -1;
  int input_ = -1;
  bool ended_ = false;
  std::string text_;
  std::uint64_t beats_ = 0;
  Clock::time_point last_beat_ = Clock::now();
};

}  // namespace

std::vector<StressCell> run_stress(const StressPlan& plan,
                                   const std::function<void(std::size_t done, std::size_t total)>& progress) {
  std::vector<StressCell> cells;
  for (const stability::Family* family : plan.families) {
    for (const Algorithm* algorithm : plan.algorithms) {
      StressCell& cell = cells.emplace_back();
      cell.family = family;
      cell.algorithm = algorithm;
    }
  }
  std::vector<std::unique_ptr<Process>> running;
  std::size_t begun = 0, done = 0;
  while (done < cells.size()) {
    while (begun < cells.size() && running.size() < plan.processes) {
      running.push_back(std::make_unique<Process>(plan, cells[begun++]));
    }
    done += std::erase_if(running, [&](const auto& process) { return process->poll(plan.silence_s); });
    progress(done, cells.size());
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return cells;
}

}  // namespace sixdof::study
