#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <sixdof/process/child_process.h>
#include <sixdof/process/protocol.h>
#include <sixdof/process/shared_memory.h>
#include <sixdof/query/algorithm.h>

namespace sixdof {

/// What a process of an algorithm may use.
struct ProcessLimits {
  double query_s = 10.0;                              ///< Wall time of one query.
  double prepare_s = 600.0;                           ///< Of the start of the program, and of preparing a pair.
  std::size_t memory_bytes = default_memory_limit();  ///< Data (RLIMIT_DATA); 0 for no limit.
  /// A process whose pair is no longer needed prepares the next one, if the program can ("again"): for many small
  /// pairs, where starting the program is most of the work. Without, no pair sees what another has left behind.
  bool reuse = false;
};

/// Processes of pairs that are no longer needed.
class SpareProcesses;

/// A program that answers the protocol (README.md).
struct RemoteProgram {
  std::vector<std::string> words;  ///< Program and arguments.
  ProcessLimits limits;
  std::shared_ptr<SpareProcesses> spare = nullptr;  ///< Of all queries of this program, if the limits say `reuse`.
};

/// With a place for spare processes where the limits want one.
RemoteProgram remote_program(std::vector<std::string> words, const ProcessLimits& limits);

/// What a program says of itself. @throws Error if it cannot be started, ends, is silent or answers nonsense
protocol::Greeting ask_greeting(const RemoteProgram& program);

/// What a process reads of a pair, and where it counts.
struct PairFiles;

/// A pair that is prepared in a process of its own, with files in memory for its meshes.
class RemoteQuery final : public Query {
 public:
  /// @throws BadMesh, BadArgument as the algorithm does; Error if the process ends or gives no answer
  RemoteQuery(RemoteProgram program, const Traits& traits, const Mesh& a, const Mesh& b, const Settings& settings);
  ~RemoteQuery() override;

  /// A kind of query that the program does not answer is unsupported, and not asked.
  ///
  /// If the process crashes, does not answer in time or sends a malformed reply, it is killed, and the status is
  /// crashed, timed_out, out_of_memory or failed. The next query starts a new process, which prepares the pair again. A
  /// pose that ended a process is not asked again: it keeps its status. After k_most_deaths in a row, or
  /// k_most_time_outs, all other poses have Status::failed until forgive().
  Outcome<bool> collide(const Pose& X_AB) override;
  Outcome<Separation> distance(const Pose& X_AB) override;
  Outcome<Response> respond(const Pose& X_AB) override;
  Outcome<Impact> cast(const Motion& motion) override;
  Outcome<Contacts> contacts(const Pose& X_AB, std::size_t most) override;

  Footprint footprint() const override { return prepared_.footprint; }
  std::vector<Work> work() const override { return work_; }

  static constexpr int k_most_deaths = 20;
  static constexpr int k_most_time_outs = 5;

  /// Resets the counts of crashes and time-outs, for a new row: its poses are asked again.
  void forgive() { deaths_in_a_row_ = time_outs_in_a_row_ = 0; }

  /// Wall time of the last query that was asked, in ns: as the process says or, where it does not, the round trip.
  double last_ns() const { return last_ns_; }
  /// Whether the process times its queries itself.
  bool is_timed_inside() const { return timed_inside_; }

  /// Wall and processor time of preparing, as the process says; empty where it does not.
  const protocol::Prepared& prepared() const { return prepared_; }

  /// Times of single queries as PassTimes has them, taken inside. In `failed` are the poses without an answer in any of
  /// the passes; their times mean nothing. Passes over more than protocol::k_most_poses poses are over that many at a
  /// time. A program that cannot time is asked pose by pose.
  /// @param evict_bytes read before each query, by a program that can time
  /// @throws Error if the process ends and no pose is the cause
  template <class Answer>
  protocol::Timed time_each(std::span<const Pose> poses, std::size_t passes, std::size_t evict_bytes = 0) {
    return time<Answer>(poses, {.passes = passes, .each = true, .evict_bytes = evict_bytes});
  }

  /// Wall and processor time of all passes together, likewise, without the poses in `failed`. Of a program that cannot
  /// time, both are the sum of its single times.
  template <class Answer>
  protocol::Timed time_together(std::span<const Pose> poses, std::size_t passes) {
    return time<Answer>(poses, {.passes = passes});
  }

 private:
  struct Death {
    Status status = Status::crashed;
    std::string words;
  };
  void start();
  bool take_spare(const Mesh& a, const Mesh& b);
  void prepare_pair(const TimeLimit& expired);
  std::string exchange(const protocol::Request& request, const TimeLimit& expired);
  TimeLimit stalled() const;
  bool gave_up() const { return deaths_in_a_row_ >= k_most_deaths || time_outs_in_a_row_ >= k_most_time_outs; }
  Status not_asked();
  Status died(const ChildFailure& failure);
  template <class Answer>
  Outcome<Answer> ask(const Pose& X_AB);
  template <class Answer>
  Outcome<Answer> ask(const protocol::Ask& request, const std::string& key);
  template <class Answer>
  protocol::Asked<Answer> exchange_ask(const protocol::Ask& request);
  template <class Answer>
  protocol::Timed time(std::span<const Pose> poses, const protocol::Time& how);
  template <class Answer>
  protocol::Timed time_by_asking(std::span<const Pose> poses, const protocol::Time& how);
  template <class Answer>
  std::vector<protocol::Failed> find_culprits(const protocol::Time& request, const ChildFailure& failure);
  template <class Answer>
  void time_chunk(std::span<const Pose> poses, std::size_t first, const protocol::Time& how, protocol::Timed& all);

  const RemoteProgram program_;
  const std::string name_;
  std::unique_ptr<PairFiles> files_;
  protocol::Prepare request_;
  protocol::Greeting greeting_;
  protocol::Prepared prepared_;
  std::unique_ptr<ChildProcess> process_;  ///< Null after a death.
  std::vector<Work> work_;
  double last_ns_ = 0.0;
  bool timed_inside_ = true;
  std::map<std::string, Death> deaths_;  ///< By kind of query and pose.
  int deaths_in_a_row_ = 0, time_outs_in_a_row_ = 0;
  std::string last_death_;  ///< Words.
};

}  // namespace sixdof
