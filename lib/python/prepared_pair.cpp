#include "lib/python/prepared_pair.h"

#include <algorithm>
#include <chrono>
#include <thread>

#include <sixdof/base/parallel.h>
#include <sixdof/query/ask.h>

namespace sixdof::python {
namespace {

/// Poses that a thread takes at a time: enough that taking them costs nothing, few enough that threads end together.
constexpr std::size_t k_chunk = 16;

/// Time between two looks at whether the work is to end.
constexpr std::chrono::milliseconds k_patience{50};

/// Asks `stop` now and then, from the thread that made it only.
class Patience {
 public:
  explicit Patience(const std::function<bool()>& stop) : stop_(stop) {}

  /// Whether the work is to end.
  bool is_over() {
    if (!over_ && std::this_thread::get_id() == thread_ && std::chrono::steady_clock::now() >= next_) {
      if (stop_()) over_ = true;
      next_ = std::chrono::steady_clock::now() + k_patience;
    }
    return over_;
  }

 private:
  const std::function<bool()>& stop_;
  std::thread::id thread_ = std::this_thread::get_id();
  std::chrono::steady_clock::time_point next_ = std::chrono::steady_clock::now() + k_patience;
  std::atomic<bool> over_ = false;
};

}  // namespace

PreparedPair::PreparedPair(std::shared_ptr<const Algorithm> algorithm, Settings settings, std::shared_ptr<const Mesh> a,
                           std::shared_ptr<const Mesh> b)
    : algorithm_(std::move(algorithm)), settings_(std::move(settings)), a_(std::move(a)), b_(std::move(b)) {
  give_back(take());
}

std::size_t PreparedPair::prepared() const {
  const std::scoped_lock lock(pool_mutex_);
  return made_;
}

Footprint PreparedPair::footprint() const {
  const std::scoped_lock lock(pool_mutex_);
  return idle_.empty() ? Footprint{} : idle_.front()->footprint();
}

std::unique_ptr<Query> PreparedPair::take() {
  {
    const std::scoped_lock lock(pool_mutex_);
    if (!idle_.empty()) {
      std::unique_ptr<Query> query = std::move(idle_.front());
      idle_.erase(idle_.begin());
      return query;
    }
    ++made_;
  }
  return algorithm_->prepare(*a_, *b_, settings_);
}

void PreparedPair::give_back(std::unique_ptr<Query> query) {
  const std::scoped_lock lock(pool_mutex_);
  idle_.push_back(std::move(query));
}

template <class Answer>
Endings PreparedPair::ask_all(std::size_t count, unsigned threads,
                              const std::function<Outcome<Answer>(Query&, std::size_t)>& ask,
                              const std::function<void(std::size_t, const Answer&)>& store,
                              const std::function<bool()>& stop) {
  const std::scoped_lock lock(one_call_);
  Endings endings;
  endings.status.assign(count, static_cast<std::uint8_t>(Status::failed));
  std::mutex words_mutex;
  Patience patience(stop);
  const auto ask_one = [&](Query& query, std::size_t place) {
    bool has_thrown = false;
    std::string words;
    Outcome<Answer> answer = ask_guarded([&] { return ask(query, place); },
                                         [&](const std::string& why) {
                                           has_thrown = true;
                                           words = why;
                                         });
    if (!has_thrown) examine(query, answer, [&](const std::string& why) { words = why; });
    endings.status[place] = static_cast<std::uint8_t>(answer.status);
    if (answer.ok()) {
      store(place, answer.value);
      return;
    }
    const std::scoped_lock words_lock(words_mutex);
    endings.words[place] = std::move(words);
  };
  const auto ask_range = [&](std::size_t begin, std::size_t end) {
    std::unique_ptr<Query> query = take();
    for (std::size_t place = begin; place < end && !patience.is_over(); ++place) ask_one(*query, place);
    give_back(std::move(query));
  };
  if (threads == 1 || count <= k_chunk) {
    ask_range(0, count);
    return endings;
  }
  const std::size_t chunks = (count + k_chunk - 1) / k_chunk;
  parallel::with_threads(threads, [&] {
    parallel::for_each(chunks,
                       [&](std::size_t chunk) { ask_range(chunk * k_chunk, std::min(count, (chunk + 1) * k_chunk)); });
  });
  return endings;
}

template Endings PreparedPair::ask_all<bool>(std::size_t, unsigned,
                                             const std::function<Outcome<bool>(Query&, std::size_t)>&,
                                             const std::function<void(std::size_t, const bool&)>&,
                                             const std::function<bool()>&);
template Endings PreparedPair::ask_all<Separation>(std::size_t, unsigned,
                                                   const std::function<Outcome<Separation>(Query&, std::size_t)>&,
                                                   const std::function<void(std::size_t, const Separation&)>&,
                                                   const std::function<bool()>&);
template Endings PreparedPair::ask_all<Response>(std::size_t, unsigned,
                                                 const std::function<Outcome<Response>(Query&, std::size_t)>&,
                                                 const std::function<void(std::size_t, const Response&)>&,
                                                 const std::function<bool()>&);
template Endings PreparedPair::ask_all<Impact>(std::size_t, unsigned,
                                               const std::function<Outcome<Impact>(Query&, std::size_t)>&,
                                               const std::function<void(std::size_t, const Impact&)>&,
                                               const std::function<bool()>&);

}  // namespace sixdof::python
