#include <sixdof/scene/scene_algorithm.h>

#include <algorithm>

#include <fmt/format.h>

#include <sixdof/base/error.h>
#include <sixdof/base/hash.h>
#include <sixdof/scene/all_pairs.h>
#include <sixdof/scene/exact_scene.h>

namespace sixdof::scene {

std::string_view to_string(Question question) {
  constexpr std::string_view k_words[] = {"touching", "near", "closest", "wrenches", "impacts"};
  return k_words[static_cast<std::size_t>(question)];
}

Question parse_question(std::string_view word) {
  for (const Question question : k_questions) {
    if (to_string(question) == word) return question;
  }
  throw BadArgument(fmt::format("no question {}; there are touching, near, closest, wrenches, impacts", word));
}

std::string SceneAnswer::hash() const {
  ContentHash hash;
  const auto add = [&hash](const auto& value) { hash.add_values(std::span(&value, 1)); };
  add(static_cast<std::uint64_t>(pairs.size()));
  for (const NearPair& near : pairs) {
    add(near.pair.a);
    add(near.pair.b);
    add(near.distance);
  }
  for (const BodyWrench& wrench : wrenches) {
    add(wrench.body);
    hash.add_values(std::span<const double>(wrench.force.data(), 3));
    hash.add_values(std::span<const double>(wrench.torque.data(), 3));
  }
  return hash.hex();
}

bool SceneTraits::answers_to(Question question) const { return std::ranges::find(answers, question) != answers.end(); }

void SceneQuery::deform(std::span<const Deformed> deformed) {
  if (!deformed.empty()) throw BadArgument("the algorithm does not take meshes that deform");
}

void check_answers(const SceneTraits& traits, const Scene& scene, Question question) {
  if (!traits.answers_to(question)) {
    throw BadArgument(fmt::format("{} does not answer the question {}", traits.name, to_string(question)));
  }
  if (scene.deforms() && !traits.deforms) {
    throw BadArgument(fmt::format("{} does not take scenes in which a mesh deforms", traits.name));
  }
  if (scene.deforms() && question == Question::impacts) {
    throw BadArgument("first contacts are of rigid bodies: a mesh of the scene deforms");
  }
}

const SceneAlgorithm& find_algorithm(const SceneAlgorithms& algorithms, std::string_view name) {
  std::string names;
  for (const auto& each : algorithms) {
    if (each->traits().name == name) return *each;
    names += (names.empty() ? "" : ", ") + each->traits().name;
  }
  throw BadArgument(fmt::format("no algorithm for scenes {}; there are {}", name, names));
}

void add_own_algorithms(SceneAlgorithms& algorithms) {
  algorithms.push_back(make_exact_scene());
  algorithms.push_back(make_exact_scene(MeshUpdate::refit));
  algorithms.push_back(make_exact_scene(MeshUpdate::rebuild));
  algorithms.push_back(make_all_pairs());
}

}  // namespace sixdof::scene
