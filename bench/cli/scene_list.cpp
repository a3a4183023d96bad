#include <memory>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/error.h>
#include "bench/cli/scene_play.h"
#include "bench/cli/shared.h"
#include "bench/common/interrupt.h"
#include "bench/common/json_text.h"
#include "bench/common/run_guarded.h"

namespace sixdof::cli {
namespace {

using scene::BodyWrench;
using scene::NearPair;
using scene::SceneAnswer;

/// Whose answer, and when.
struct Place {
  std::string question, algorithm;
  std::size_t frame;
};

/// Numbers have as many digits as identify the double.
void print_rows(const Place& place, const SceneAnswer& answer) {
  const std::string start = fmt::format("{},{},{}", place.question, place.algorithm, place.frame);
  for (const NearPair& near : answer.pairs) {
    fmt::print("{},{},{},{},,,,,,\n", start, near.pair.a, near.pair.b, near.distance);
  }
  for (const BodyWrench& wrench : answer.wrenches) {
    fmt::print("{},{},,,{},{}\n", start, wrench.body, fmt::join(coordinates(wrench.force), ","),
               fmt::join(coordinates(wrench.torque), ","));
  }
}

void print_object(const Place& place, const SceneAnswer& answer, bool is_first) {
  nlohmann::ordered_json json{{"question", place.question}, {"algorithm", place.algorithm}, {"frame", place.frame}};
  json["pairs"] = nlohmann::ordered_json::array();
  for (const NearPair& near : answer.pairs) {
    const char* const value = place.question == to_string(scene::Question::impacts) ? "t" : "distance";
    json["pairs"].push_back({{"bodies", {near.pair.a, near.pair.b}}, {value, near.distance}});
  }
  for (const BodyWrench& wrench : answer.wrenches) {
    json["wrenches"].push_back(
        {{"body", wrench.body}, {"force", coordinates(wrench.force)}, {"torque", coordinates(wrench.torque)}});
  }
  fmt::print("{}{}", is_first ? "\n" : ",\n", json_text(json, -1));
}

}  // namespace

void list_answers(const Part& part, const std::vector<Asked>& asked, bool json) {
  bool is_first = true;
  std::string reason;
  fmt::print("{}", json ? "[" : "question,algorithm,frame,body,other,distance,fx,fy,fz,tx,ty,tz\n");
  const auto leave_out = [&](scene::Question question, const LeftOut& left) {
    reason = fmt::format("{}: {} is left out: {}", to_string(question), left.algorithm, left.reason);
    print_message("sixdof", "warning: " + reason);
  };
  bool has_answers = false;
  for (const auto& [question, algorithms, left_out] : asked) {
    for (const LeftOut& left : left_out) leave_out(question, left);
    for (const scene::SceneAlgorithm* algorithm : algorithms) {
      std::unique_ptr<scene::SceneQuery> query;
      try {
        query = algorithm->prepare(part.scene, question);
      } catch (const BadMesh& e) {
        leave_out(question, {algorithm->traits().name, e.what()});
        continue;
      }
      has_answers = true;
      Place place{std::string(to_string(question)), algorithm->traits().name, part.first};
      for (std::size_t f = 0; f < part.scene.frames.size(); ++f) {
        InterruptGuard::check();
        query->deform(scene::shapes_of(part.scene, f));
        query->update(scene::moves_of(part.scene.frames[f]));
        json ? print_object(place, query->answer(), std::exchange(is_first, false))
             : print_rows(place, query->answer());
        ++place.frame;
      }
    }
  }
  if (json) fmt::print("\n]\n");
  if (!has_answers) throw BadArgument(reason);
}

}  // namespace sixdof::cli
