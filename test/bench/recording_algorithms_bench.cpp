// sixdof-bench with algorithms that write what they are asked to the file named by SIXDOF_ASKED: a line "ALGORITHM
// QUESTION MESH_A MESH_B POSE" for every pose. One is slow, one fails at one pose in 20 (faulty_pose.h).

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <set>
#include <string>
#include <thread>

#include <fmt/format.h>

#include <sixdof/query/registrar.h>

#include "faulty_pose.h"

namespace {

using namespace sixdof;

/// Some hundred times what a query takes that answers at once.
constexpr std::chrono::microseconds k_slow{200};

struct Behaviour {
  const char* name;
  bool slow = false;
  bool fails = false;
};

class RecordingQuery final : public Query {
 public:
  RecordingQuery(const Behaviour& behaviour, std::string meshes) : behaviour_(behaviour), meshes_(std::move(meshes)) {}
  ~RecordingQuery() override {
    const char* const file = std::getenv("SIXDOF_ASKED");
    if (file == nullptr) return;
    std::ofstream out(file, std::ios::app);
    for (const std::string& line : asked_) out << line << "\n";
  }
  RecordingQuery(const RecordingQuery&) = delete;
  RecordingQuery& operator=(const RecordingQuery&) = delete;

  Outcome<bool> collide(const Pose& X_AB) override { return answer("collide", X_AB, true); }
  Outcome<Separation> distance(const Pose& X_AB) override { return answer("distance", X_AB, Separation()); }
  Outcome<Response> respond(const Pose& X_AB) override { return answer("respond", X_AB, Response()); }

 private:
  template <class Answer>
  Outcome<Answer> answer(const char* question, const Pose& X_AB, Answer value) {
    asked_.insert(fmt::format("{} {} {} {:a},{:a},{:a},{:a},{:a}", behaviour_.name, question, meshes_, X_AB.t.x(),
                              X_AB.t.y(), X_AB.t.z(), X_AB.R(0, 1), X_AB.R(1, 2)));
    if (behaviour_.slow) std::this_thread::sleep_for(k_slow);
    if (behaviour_.fails && test::is_faulty(X_AB)) return Status::failed;
    return value;
  }

  const Behaviour& behaviour_;
  const std::string meshes_;
  std::set<std::string> asked_;
};

class RecordingAlgorithm final : public Algorithm {
 public:
  explicit RecordingAlgorithm(const Behaviour& behaviour) : behaviour_(behaviour) {
    traits_ = {.name = behaviour.name,
               .version = "1",
               .summary = "notes what it is asked",
               .answers = {.collide = true, .distance = true, .respond = true},
               .law = ResponseLaw::volume};
  }
  const Traits& traits() const override { return traits_; }
  std::unique_ptr<Query> prepare(const Mesh& a, const Mesh& b, const Settings&) const override {
    return std::make_unique<RecordingQuery>(behaviour_, a.name() + " " + b.name());
  }

 private:
  Behaviour behaviour_;
  Traits traits_;
};

Registrar add(const Behaviour& behaviour) {
  return Registrar([behaviour] { return std::make_unique<RecordingAlgorithm>(behaviour); });
}

const Registrar k_recording[] = {add({.name = "records"}), add({.name = "records-slowly", .slow = true}),
                                 add({.name = "records-and-fails", .fails = true})};

}  // namespace
