#include "bench/study/stress_processes.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <exception>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sixdof/process/child_process.h>
#include <sixdof/process/shared_memory.h>
#include "bench/study/stress_worker.h"

namespace sixdof::study {
namespace {

using Clock = std::chrono::steady_clock;
using stability::Verdict;

/// The case and the pose that the process was asked last.
void lose(StressCell& cell, const StressBeacon& beacon, Verdict verdict, std::string words) {
  cell.id = cell.slow_id = beacon.id;
  cell.cases = std::max<std::size_t>(1, cell.cases);
  cell.settings = settings_of(*cell.algorithm, cell.which).to_string();
  cell.worst = {.verdict = verdict, .metric = "process", .unit = "1", .words = std::move(words)};
  const stability::Case member = make_case(*cell.family, cell.id);
  for (std::size_t i = 0; i < member.shots.size(); ++i) {
    if (pose_numbers(member.shots[i].pose()) == beacon.pose) cell.worst.shot = i;
  }
}

Verdict verdict_of(Status status) {
  if (status == Status::out_of_memory) return Verdict::out_of_memory;
  return status == Status::timed_out ? Verdict::hung : Verdict::crashed;
}

/// Runs a cell in a process of its own; ends the process once `stopped`.
void run_apart(const StressPlan& plan, StressCell& cell, const std::atomic<bool>& stopped) {
  const StressBeacon nothing{};
  const MemoryFile memory("sixdof-stress", std::as_bytes(std::span(&nothing, 1)));
  const SharedBeacon beacon(memory.descriptor());
  std::uint64_t beats = 0;
  Clock::time_point last_beat = Clock::now();
  const auto silent_s = [&] { return std::chrono::duration<double>(Clock::now() - last_beat).count(); };
  const TimeLimit silent = [&] {
    if (const std::uint64_t now = beacon->beats; now != beats) {
      beats = now;
      last_beat = Clock::now();
    }
    return stopped || silent_s() >= plan.timeout_s;
  };
  try {
    ChildProcess process(stress_cell_command(cell, plan.effort, plan.seed, plan.external), {memory.descriptor()},
                         static_cast<std::size_t>(plan.memory_bytes));
    read_result(process.receive(silent), cell);
  } catch (const ChildFailure& failure) {
    const bool hung = failure.status == Status::timed_out;
    lose(cell, *beacon, verdict_of(failure.status),
         hung ? fmt::format("no answer in {:.0f} s", silent_s()) : failure.what());
  } catch (const nlohmann::json::exception&) {
    lose(cell, *beacon, Verdict::crashed, "did not write a result");
  }
}

/// Runs all cells on as many threads as processes may run at once. Each thread takes the next cell.
class Run {
 public:
  Run(const StressPlan& plan, std::vector<StressCell>& cells) : plan_(plan), cells_(cells) {
    for (std::size_t i = 0; i < plan.processes; ++i) threads_.emplace_back([this] { work(); });
  }
  /// Ends the processes that still run.
  ~Run() {
    stopped_ = true;
    for (std::thread& thread : threads_) thread.join();
  }
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;

  /// @throws what a thread could not do
  std::size_t done() {
    const std::scoped_lock lock(mutex_);
    if (failure_) std::rethrow_exception(failure_);
    return done_;
  }

 private:
  void work() {
    for (std::size_t i = 0; !stopped_ && (i = next_++) < cells_.size(); ++done_) {
      try {
        run_apart(plan_, cells_[i], stopped_);
      } catch (...) {
        const std::scoped_lock lock(mutex_);
        failure_ = std::current_exception();
        return;
      }
    }
  }

  const StressPlan& plan_;
  std::vector<StressCell>& cells_;
  std::atomic<bool> stopped_ = false;
  std::atomic<std::size_t> next_ = 0, done_ = 0;
  std::mutex mutex_;
  std::exception_ptr failure_;
  std::vector<std::thread> threads_;
};

}  // namespace

std::vector<StressCell> run_stress(const StressPlan& plan,
                                   const std::function<void(std::size_t done, std::size_t total)>& progress) {
  std::vector<StressCell> cells;
  for (const stability::Family* family : plan.families) {
    for (const Algorithm* algorithm : plan.algorithms) {
      for (const StressSettings which : {StressSettings::coarsest, StressSettings::defaults}) {
        if (which == StressSettings::defaults && !(plan.at_defaults && has_finer_defaults(*algorithm))) continue;
        StressCell& cell = cells.emplace_back();
        cell.family = family;
        cell.algorithm = algorithm;
        cell.which = which;
      }
    }
  }
  Run run(plan, cells);
  for (std::size_t done = 0; done < cells.size();) {
    done = run.done();
    progress(done, cells.size());
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return cells;
}

}  // namespace sixdof::study
