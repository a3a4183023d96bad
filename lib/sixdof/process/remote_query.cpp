#include <sixdof/process/remote_query.h>

#include <algorithm>
#include <chrono>
#include <numeric>
#include <utility>

#include <unistd.h>

#include <fmt/format.h>

#include <sixdof/process/spare_process.h>

namespace sixdof {

using namespace protocol;

namespace {

using Clock = std::chrono::steady_clock;

double nanoseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::nano>(Clock::now() - start).count();
}

/// Kind of query and pose, bit by bit.
template <class Answer>
std::string key_of(const Pose& X_AB) {
  std::string key(k_query<Answer>);
  key.append(reinterpret_cast<const char*>(X_AB.R.data()), sizeof(double) * 9);
  key.append(reinterpret_cast<const char*>(X_AB.t.data()), sizeof(double) * 3);
  return key;
}

/// Two clocks of one machine agree so well over a long time,
constexpr double k_clock_rate = 1.01;
/// and a coarse one ticks 64 times a second.
constexpr double k_clock_tick_ns = 2e7;

/// @throws Malformed for a time that a program states although less has passed here from request to reply
void require_passed(const char* key, double stated_ns, double passed_ns, double threads = 1.0) {
  if (stated_ns <= threads * (k_clock_rate * passed_ns + k_clock_tick_ns)) return;
  throw Malformed(fmt::format("\"{}\" of {:.3g} ns, but only {:.3g} ns have passed", key, stated_ns, passed_ns));
}

double processors() { return static_cast<double>(std::max(1L, ::sysconf(_SC_NPROCESSORS_CONF))); }

void require_passed(const Prepared& prepared, double passed_ns) {
  require_passed("ns", prepared.wall_ns.value_or(0.0), passed_ns);
  require_passed("cpu_ns", prepared.cpu_ns.value_or(0.0), passed_ns, processors());
}

/// The times of poses without an answer mean nothing.
void require_passed(const Timed& timed, std::size_t passes, double passed_ns) {
  require_passed("wall_ns", timed.wall_ns, passed_ns);
  require_passed("cpu_ns", timed.cpu_ns, passed_ns, processors());
  std::vector<bool> has_failed(timed.once_ns.size());
  for (const Failed& each : timed.failed) {
    if (each.place < has_failed.size()) has_failed[each.place] = true;
  }
  double once = 0.0, least = 0.0;
  for (std::size_t i = 0; i < timed.once_ns.size(); ++i) {
    if (has_failed[i]) continue;
    once += timed.once_ns[i];
    least += timed.least_ns[i];
  }
  require_passed("once_ns", once, passed_ns);
  require_passed("least_ns", static_cast<double>(passes) * least, passed_ns);
}

ChildFailure nonsense(const Malformed& e) {
  return {Status::failed, fmt::format("wrote a malformed reply: {}", e.what())};
}

}  // namespace

Greeting ask_greeting(const RemoteProgram& program) {
  ChildProcess process(program.words, {}, program.limits.memory_bytes);
  const TimeLimit expired = expires_after(program.limits.prepare_s);
  try {
    process.send(to_line(Hello{}), expired);
    return greeting_of(process.receive(expired));
  } catch (const Malformed& e) {
    throw Error(nonsense(e).what());
  }
}

RemoteQuery::RemoteQuery(RemoteProgram program, const Traits& traits, const Mesh& a, const Mesh& b,
                         const Settings& settings)
    : program_(std::move(program)), name_(traits.name) {
  const bool copies = &a == &b;
  request_.a = {a.name(), path_of_descriptor(k_vertices_a), path_of_descriptor(k_triangles_a), a.vertices().size(),
                a.triangles().size()};
  request_.b = {b.name(), path_of_descriptor(copies ? k_vertices_a : k_vertices_b),
                path_of_descriptor(copies ? k_triangles_a : k_triangles_b), b.vertices().size(), b.triangles().size()};
  request_.progress = path_of_descriptor(k_progress);
  for (const Parameter& each : traits.parameters) request_.settings.emplace_back(each.name, settings.choice(each.name));
  try {
    if (!take_spare(a, b)) {
      files_ = std::make_unique<PairFiles>(a, b);
      start();
    }
  } catch (const ChildFailure& failure) {
    throw Error(fmt::format("{}: {} while it prepared the pair: {}", name_, to_string(failure.status), failure.what()));
  }
  timed_inside_ = greeting_.times;
}

RemoteQuery::~RemoteQuery() {
  // A process that has been ended once has shown that it cannot be trusted with another pair.
  if (!program_.spare || !process_ || !greeting_.again || !deaths_.empty()) return;
  program_.spare->put({std::move(files_), std::move(process_), std::move(greeting_)});
}

/// Prepares the pair in the spare process. @returns false if there is none, or it ends or refuses, which may be for
/// what the pair before has left behind: a new process is to be asked then
bool RemoteQuery::take_spare(const Mesh& a, const Mesh& b) {
  if (!program_.spare) return false;
  SpareProcesses::Parts parts = program_.spare->take();
  if (!parts.process) return false;
  files_ = std::move(parts.files);
  process_ = std::move(parts.process);
  greeting_ = std::move(parts.greeting);
  files_->set(a, b);
  try {
    prepare_pair(expires_after(program_.limits.prepare_s));
    return true;
  } catch (const Error&) {
    return false;
  }
}

/// A new process with the pair prepared. @throws ChildFailure, what the algorithm refuses
void RemoteQuery::start() {
  process_ = std::make_unique<ChildProcess>(program_.words, files_->descriptors(), program_.limits.memory_bytes);
  const TimeLimit expired = expires_after(program_.limits.prepare_s);
  try {
    greeting_ = greeting_of(exchange(Hello{}, expired));
  } catch (const Malformed& e) {
    process_.reset();
    throw nonsense(e);
  }
  prepare_pair(expired);
}

/// @throws ChildFailure, what the algorithm refuses
void RemoteQuery::prepare_pair(const TimeLimit& expired) {
  try {
    const auto sent = Clock::now();
    const std::string line = exchange(request_, expired);
    const double passed_ns = nanoseconds_since(sent);
    const auto reply = prepared_of(line);
    if (const auto* const prepared = std::get_if<Prepared>(&reply)) {
      require_passed(*prepared, passed_ns);
      prepared_ = *prepared;
      return;
    }
    process_.reset();
    const Refusal& refusal = std::get<Refusal>(reply);
    if (refusal.kind == Refusal::Kind::bad_mesh) throw BadMesh(refusal.words);
    if (refusal.kind == Refusal::Kind::bad_argument) throw BadArgument(refusal.words);
    throw Error(fmt::format("{}: {}", name_, refusal.words));
  } catch (const Malformed& e) {
    process_.reset();
    throw nonsense(e);
  }
}

/// @throws ChildFailure
std::string RemoteQuery::exchange(const Request& request, const TimeLimit& expired) {
  try {
    // A program may greet before it is asked.
    if (!std::holds_alternative<Hello>(request)) process_->expect_no_line();
    process_->send(to_line(request), expired);
    return process_->receive(expired);
  } catch (const ChildFailure&) {
    process_.reset();
    throw;
  }
}

/// True once no further query of a Time request has begun for as long as one may take. A program that does not count
/// has that time for every query, see time_chunk().
TimeLimit RemoteQuery::stalled() const {
  return [this, last = std::uint64_t{0}, since = Clock::now()]() mutable {
    const std::uint64_t now = files_->counter.get();
    if (now != last) {
      last = now;
      since = Clock::now();
    }
    return nanoseconds_since(since) > 1e9 * program_.limits.query_s;
  };
}

Status RemoteQuery::not_asked() {
  return fail(Status::failed, fmt::format("not asked after {} crashes or timeouts in a row, the last: {}",
                                          deaths_in_a_row_, last_death_));
}

/// Counts a death. @returns its status, with diagnosis()
Status RemoteQuery::died(const ChildFailure& failure) {
  process_.reset();
  ++deaths_in_a_row_;
  time_outs_in_a_row_ = failure.status == Status::timed_out ? time_outs_in_a_row_ + 1 : 0;
  last_death_ = fmt::format("{}: {}", to_string(failure.status), failure.what());
  return fail(failure.status, failure.what());
}

template <class Answer>
Asked<Answer> RemoteQuery::exchange_ask(const Ask& request) {
  const auto sent = Clock::now();
  const std::string line = exchange(request, expires_after(program_.limits.query_s));
  const double round_trip_ns = nanoseconds_since(sent);
  try {
    Asked<Answer> asked = answer_of<Answer>(line);
    require_passed("ns", asked.ns.value_or(0.0), round_trip_ns);
    timed_inside_ = asked.ns.has_value();
    last_ns_ = asked.ns.value_or(round_trip_ns);
    return asked;
  } catch (const Malformed& e) {
    throw nonsense(e);
  }
}

template <class Answer>
Outcome<Answer> RemoteQuery::ask(const Pose& X_AB) {
  return ask<Answer>(Ask{std::string(k_query<Answer>), X_AB}, key_of<Answer>(X_AB));
}

template <class Answer>
Outcome<Answer> RemoteQuery::ask(const Ask& request, const std::string& key) {
  if (const auto known = deaths_.find(key); known != deaths_.end())
    return fail(known->second.status, known->second.words);
  if (gave_up()) return not_asked();
  try {
    if (!process_) start();
  } catch (const ChildFailure& failure) {
    return died({failure.status, fmt::format("while it prepared the pair again: {}", failure.what())});
  } catch (const Error& e) {
    return died({Status::failed, fmt::format("while it prepared the pair again: {}", e.what())});
  }
  try {
    Asked<Answer> asked = exchange_ask<Answer>(request);
    deaths_in_a_row_ = time_outs_in_a_row_ = 0;
    work_ = std::move(asked.work);
    if (!asked.outcome.ok()) return fail(asked.outcome.status, std::move(asked.words));
    return asked.outcome;
  } catch (const ChildFailure& failure) {
    const Status status = died(failure);
    deaths_[key] = {status, diagnosis()};
    return status;
  }
}

Outcome<bool> RemoteQuery::collide(const Pose& X_AB) {
  if (!greeting_.traits.answers.collide) return Status::unsupported;
  return ask<bool>(X_AB);
}
Outcome<Separation> RemoteQuery::distance(const Pose& X_AB) {
  if (!greeting_.traits.answers.distance) return Status::unsupported;
  return ask<Separation>(X_AB);
}
Outcome<Response> RemoteQuery::respond(const Pose& X_AB) {
  if (!greeting_.traits.answers.respond) return Status::unsupported;
  return ask<Response>(X_AB);
}
Outcome<Impact> RemoteQuery::cast(const Motion& motion) {
  if (!greeting_.traits.answers.cast) return Status::unsupported;
  std::string key = key_of<Impact>(motion.start);
  for (const Eigen::Vector3d& v : {motion.translation, motion.rotation, motion.reference}) {
    key.append(reinterpret_cast<const char*>(v.data()), sizeof(double) * 3);
  }
  return ask<Impact>(Ask{std::string(k_query<Impact>), motion.start, motion}, key);
}

Outcome<Contacts> RemoteQuery::contacts(const Pose& X_AB, std::size_t most) {
  if (!greeting_.traits.answers.contacts) return Status::unsupported;
  return ask<Contacts>(Ask{std::string(k_query<Contacts>), X_AB, {}, most}, key_of<Contacts>(X_AB));
}

template <class Answer>
Timed RemoteQuery::time(std::span<const Pose> poses, const Time& how) {
  if (!greeting_.times) return time_by_asking<Answer>(poses, how);
  Timed all;
  if (how.each) {
    all.once_ns.resize(poses.size());
    all.least_ns.resize(poses.size());
  }
  for (std::size_t first = 0; first < poses.size(); first += k_most_poses) {
    time_chunk<Answer>(poses.subspan(first, std::min(k_most_poses, poses.size() - first)), first, how, all);
  }
  return all;
}

/// Repeats the passes without the poses that end the process.
template <class Answer>
void RemoteQuery::time_chunk(std::span<const Pose> poses, std::size_t first, const Time& how, Timed& all) {
  std::vector<std::size_t> places(poses.size());  // in `poses`, of those that are asked
  std::iota(places.begin(), places.end(), std::size_t{0});
  Time request = how;
  request.query = k_query<Answer>;
  request.poses.assign(poses.begin(), poses.end());
  while (!places.empty()) {
    std::vector<Failed> failed;
    try {
      files_->counter.set(0);
      if (!process_) start();
      const double queries = static_cast<double>(places.size() * request.passes);
      const auto sent = Clock::now();
      const std::string line =
          exchange(request, greeting_.progress ? stalled() : expires_after(queries * program_.limits.query_s));
      const double passed_ns = nanoseconds_since(sent);
      const Timed timed = timed_of(line, places.size(), how.each);
      require_passed(timed, request.passes, passed_ns);
      for (std::size_t i = 0; how.each && i < places.size(); ++i) {
        all.once_ns[first + places[i]] = timed.once_ns[i];
        all.least_ns[first + places[i]] = timed.least_ns[i];
      }
      deaths_in_a_row_ = time_outs_in_a_row_ = 0;
      all.wall_ns += timed.wall_ns;
      all.cpu_ns += timed.cpu_ns;
      for (const Failed& each : timed.failed)
        all.failed.push_back({first + places[each.place], each.status, each.words});
      return;
    } catch (const ChildFailure& failure) {
      failed = find_culprits<Answer>(request, failure);
    } catch (const Malformed& e) {
      process_.reset();
      throw Error(fmt::format("{}: {}", name_, nonsense(e).what()));
    }
    for (const Failed& each : failed) all.failed.push_back({first + places[each.place], each.status, each.words});
    for (auto each = failed.rbegin(); each != failed.rend(); ++each) {
      places.erase(places.begin() + static_cast<std::ptrdiff_t>(each->place));
      request.poses.erase(request.poses.begin() + static_cast<std::ptrdiff_t>(each->place));
    }
  }
}

/// The poses of a Time request at which the process ended, in order; after too many deaths all of them.
/// @throws Error if there are none
template <class Answer>
std::vector<Failed> RemoteQuery::find_culprits(const Time& request, const ChildFailure& failure) {
  const std::uint64_t begun = greeting_.progress ? files_->counter.get() : 0;
  if (begun > 1) deaths_in_a_row_ = time_outs_in_a_row_ = 0;  // the pose before gave an answer
  const Status status = died(failure);
  std::vector<Failed> found;
  if (begun > 0) {
    const std::size_t place = (begun - 1) % request.poses.size();
    deaths_[key_of<Answer>(request.poses[place])] = {status, diagnosis()};
    found.push_back({place, status, diagnosis()});
  }
  if (begun == 0 || gave_up()) {
    found.clear();
    for (std::size_t i = 0; i < request.poses.size(); ++i) {
      const Outcome<Answer> outcome = ask<Answer>(request.poses[i]);
      if (!outcome.ok()) found.push_back({i, outcome.status, diagnosis()});
    }
  }
  if (found.empty())
    throw Error(fmt::format("{}: {} in a timed loop, but not when each pose is asked alone", name_, last_death_));
  return found;
}

template <class Answer>
Timed RemoteQuery::time_by_asking(std::span<const Pose> poses, const Time& how) {
  Timed all;
  std::vector<bool> has_failed(poses.size());
  all.once_ns.resize(poses.size());
  all.least_ns.resize(poses.size());
  for (std::size_t pass = 0; pass < how.passes; ++pass) {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      if (has_failed[i]) continue;
      const Outcome<Answer> outcome = ask<Answer>(poses[i]);
      if (!outcome.ok()) {
        has_failed[i] = true;
        all.failed.push_back({i, outcome.status, diagnosis()});
        continue;
      }
      if (pass == 0) all.once_ns[i] = last_ns_;
      all.least_ns[i] = pass == 0 ? last_ns_ : std::min(all.least_ns[i], last_ns_);
      all.wall_ns += last_ns_;
    }
  }
  all.cpu_ns = all.wall_ns;
  return all;
}

template Timed RemoteQuery::time<bool>(std::span<const Pose>, const Time&);
template Timed RemoteQuery::time<Separation>(std::span<const Pose>, const Time&);
template Timed RemoteQuery::time<Response>(std::span<const Pose>, const Time&);

}  // namespace sixdof
