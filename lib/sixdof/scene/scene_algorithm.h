#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <sixdof/scene/scene.h>

/// The interface of an algorithm that finds pairs in a scene of many bodies: prepared once from the bodies, then told
/// of each frame what has moved, and asked one question in each frame.
namespace sixdof::scene {

/// What a query is asked in each frame.
enum class Question {
  touching,  ///< All pairs of bodies that have a point in common: their surfaces meet, or one lies inside the other.
  near,      ///< All pairs whose surfaces are no further apart than the margin, with their distances.
  closest,   ///< The closest pair of the scene; of equally close ones the first.
  wrenches,  ///< The sum of the wrenches of the volume law on each body that touches another.
  /// All pairs that are apart at the frame before and touch until this one, with the time t (0 to 1) of their first
  /// contact. Between frames the centre of a body's box moves straight, and the body turns about it the shorter way.
  impacts
};
/// Whether a body inside another counts. Distances are of surfaces, as those of all libraries.
constexpr bool is_of_bodies(Question question) {
  return question == Question::touching || question == Question::wrenches;
}
/// All questions.
inline constexpr Question k_questions[] = {Question::touching, Question::near, Question::closest, Question::wrenches,
                                           Question::impacts};

/// "touching", "near", "closest", "wrenches" or "impacts".
std::string_view to_string(Question question);
/// The question of a word. @throws BadArgument listing the words
Question parse_question(std::string_view word);

/// Of two bodies by their identifiers, a < b.
struct NearPair {
  BodyPair pair;  ///< Which two.
  /// Of the surfaces (length); 0 where they meet. touching, wrenches: 0. impacts: t of the contact.
  double distance = 0.0;
  /// By pair, then by distance.
  auto operator<=>(const NearPair&) const = default;
};

/// In the world's frame. By the volume law (oracle/overlap.h): force in area, torque in area times length.
struct BodyWrench {
  std::uint32_t body = 0;                            ///< Identifier.
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< On the body.
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< About the centre of the body's box.
};

/// The answer to one question in one frame.
struct SceneAnswer {
  std::vector<NearPair> pairs;       ///< Sorted by pair. touching: distances are 0. closest: one, or none.
  std::vector<BodyWrench> wrenches;  ///< Question::wrenches only: sorted by body.

  /// Of all bits, for comparing answers: 32 hexadecimal digits.
  std::string hash() const;
};

/// Work since a query was made. "Looked at": the broad phase names the pair as a candidate of the frame.
struct SceneWork {
  std::uint64_t candidates = 0;  ///< Pairs looked at, of all frames.
  std::uint64_t put_off = 0;     ///< Of these: not asked of the narrow phase, as motion so far cannot matter.
  std::uint64_t narrow = 0;      ///< Of these: asked of the narrow phase.
  std::uint64_t triangles = 0;   ///< Pairs of triangles tested exactly; 0 if the algorithm does not count them.
  std::uint64_t built = 0;       ///< Triangles of trees, or parts of trees, that were built anew as meshes deformed.
  std::uint64_t undecided = 0;   ///< Pairs of impacts that pass each other too closely to decide; not reported.
};

/// How an algorithm of this project updates the tree of a mesh that deforms (oracle/deforming_mesh.h).
enum class MeshUpdate {
  rule,    ///< Refits it, and builds the parts anew that pay.
  refit,   ///< Refits it.
  rebuild  ///< Builds it anew.
};

/// An algorithm prepared for one scene and one question. One thread at a time uses it.
class SceneQuery {
 public:
  virtual ~SceneQuery() = default;  ///< Frees the prepared structures.

  /// The meshes that have deformed in the next frame, each once, by index; called before update() of that frame, in the
  /// first frame as well. The vertices outlive the query. @throws BadArgument if some have, and the algorithm is not
  /// one that SceneTraits::deforms names
  virtual void deform(std::span<const Deformed> deformed);

  /// The next frame: the bodies that have moved, each once, with their poses. The first frame is known already.
  virtual void update(std::span<const Moved> moved) = 0;

  /// Of the frame at hand. Valid until the next call of either.
  virtual const SceneAnswer& answer() = 0;

  /// Of all frames so far; zeros where nothing is counted.
  virtual SceneWork work() const { return {}; }
  virtual std::size_t bytes() const { return 0; }  ///< Of everything prepared; 0 if unknown.
};

/// What is known of an algorithm before it is prepared.
struct SceneTraits {
  std::string name;               ///< Unique; a-z, 0-9 and '-'.
  std::string version;            ///< Of the library behind it.
  std::string summary;            ///< One line.
  std::vector<Question> answers;  ///< The questions that it answers.
  bool own = false;               ///< Of this project: its answers must have the bits of the truth.
  /// It does not find that a body lies inside another whose surface it does not meet.
  bool surfaces_only = false;
  /// Whether it is compared where all are: not the quadratic reference.
  bool by_default = true;
  /// Whether it takes scenes in which a mesh deforms.
  bool deforms = false;
  /// Whether it is compared in scenes of rigid bodies, too: not those that differ from others in updates of meshes
  /// alone.
  bool rigid = true;

  /// Whether it is compared in a scene unless algorithms are named.
  bool is_default_for(const Scene& scene) const { return by_default && (scene.deforms() ? deforms : rigid); }

  /// Whether `answers` has it.
  bool answers_to(Question question) const;
};

/// Refuses other questions and scenes. @throws BadArgument if the question is none of those that are answered, or a
/// mesh of the scene deforms and SceneTraits::deforms is false
void check_answers(const SceneTraits& traits, const Scene& scene, Question question);

/// What is under test: prepared once per scene and question. Immutable.
class SceneAlgorithm {
 public:
  virtual ~SceneAlgorithm() = default;  ///< Of whatever derives from it.
  /// The same object at every call.
  virtual const SceneTraits& traits() const = 0;
  /// Builds all structures for the start of the scene. @param scene outlives the query; has passed Scene::check()
  /// @throws BadArgument if it does not answer the question; BadMesh if a mesh cannot be used
  virtual std::unique_ptr<SceneQuery> prepare(const Scene& scene, Question question) const = 0;
};

/// In the order in which tables list them; none is null.
using SceneAlgorithms = std::vector<std::unique_ptr<SceneAlgorithm>>;

/// The one of a name. @throws BadArgument listing the names if there is none of this name
const SceneAlgorithm& find_algorithm(const SceneAlgorithms& algorithms, std::string_view name);

/// An algorithm whose prepare() returns a QueryType(scene, question, extra...).
template <class QueryType, class... Extra>
std::unique_ptr<SceneAlgorithm> make_scene_algorithm(SceneTraits traits, Extra... extra) {
  class Made final : public SceneAlgorithm {
   public:
    Made(SceneTraits given, Extra... more) : traits_(std::move(given)), extra_(std::move(more)...) {}
    const SceneTraits& traits() const override { return traits_; }
    std::unique_ptr<SceneQuery> prepare(const Scene& scene, Question question) const override {
      check_answers(traits_, scene, question);
      return std::apply([&](const auto&... more) { return std::make_unique<QueryType>(scene, question, more...); },
                        extra_);
    }

   private:
    SceneTraits traits_;
    std::tuple<Extra...> extra_;
  };
  return std::make_unique<Made>(std::move(traits), std::move(extra)...);
}

/// Adds `exact`, `exact-refit` and `exact-rebuild`, which differ in how they update meshes that deform, and
/// `all-pairs`.
void add_own_algorithms(SceneAlgorithms& algorithms);

}  // namespace sixdof::scene
