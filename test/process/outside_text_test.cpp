// What algorithms say, in this process and out of it, is visible once it has entered.

#include <algorithm>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <sixdof/base/visible_text.h>
#include <sixdof/models/model_catalogue.h>
#include <sixdof/process/protocol.h>
#include <sixdof/process/remote_algorithm.h>
#include <sixdof/query/ask.h>
#include <sixdof/query/registrar.h>
#include <sixdof/query/registry.h>

#include "hostile_text.h"

namespace sixdof {
namespace {

using namespace protocol;
using test::as_json_string;
using test::hostile_text;

constexpr std::uint64_t k_texts = 2000;
constexpr std::uint64_t k_asked_texts = 400;  // each by two processes

/// One line that any terminal shows as it is, and JSON takes.
void expect_visible(const std::string& text, std::uint64_t seed) {
  const auto is_control = [](char c) { return (c >= 0 && c < ' ') || c == '\x7F'; };
  EXPECT_TRUE(std::ranges::none_of(text, is_control)) << seed << ": " << text;
  EXPECT_NO_THROW(static_cast<void>(nlohmann::json(text).dump())) << seed << ": no UTF-8";
  for (const char* const unseen : {"\xC2\x9B", "\xE2\x80\xAE", "\xE2\x80\xA8", "\xEF\xBB\xBF"}) {
    EXPECT_EQ(text.find(unseen), std::string::npos) << seed;
  }
  EXPECT_LE(text.size(), k_longest_words) << seed;
}

TEST(OutsideText, OfRepliesIsVisible) {
  for (std::uint64_t seed = 0; seed < k_texts; ++seed) {
    const std::string text = as_json_string(hostile_text(seed), seed);
    expect_visible(asked_of<bool>(R"({"status": "failed", "words": )" + text + "}").words, seed);
    expect_visible(asked_of<bool>(R"({"collide": true, "work": [[)" + text + ", 1, 2]]}").work.at(0).unit, seed);
    expect_visible(std::get<Refusal>(prepared_of(R"({"error": )" + text + "}")).words, seed);
    const auto prepared = std::get<Prepared>(prepared_of(R"({"prepared": true, "counts": {)" + text + ": 1}}"));
    expect_visible(prepared.footprint.counts.at(0).first, seed);
    expect_visible(timed_of(R"({"wall_ns": 1, "cpu_ns": 1, "failed": [[0, "failed", )" + text + "]]}", 1, false)
                       .failed.at(0)
                       .words,
                   seed);
    const Greeting greeting =
        greeting_of(R"({"protocol": 1, "name": "x", "answers": ["collide"], "version": )" + text + R"(, "summary": )" +
                    text + R"(, "parameters": [{"name": "p", "default": "1", "low": 0, "high": 1, "unit": )" + text +
                    R"(, "meaning": )" + text + "}]}");
    expect_visible(greeting.traits.version, seed);
    expect_visible(greeting.traits.summary, seed);
    expect_visible(greeting.traits.parameters.at(0).meaning, seed);
    expect_visible(greeting.traits.parameters.at(0).unit, seed);
    try {
      static_cast<void>(asked_of<bool>(R"({"status": )" + text + "}"));
    } catch (const Malformed& e) {
      expect_visible(e.what(), seed);
    }
  }
}

/// Says a text by each of the ways that a query has.
class Talkative final : public Query {
 public:
  Talkative(const Mesh&, const Mesh&, const Settings& settings) {
    const auto seed = static_cast<std::uint64_t>(settings.number("seed"));
    if (seed > 0) throw std::runtime_error(hostile_text(seed));
  }
  Outcome<bool> collide(const Pose& X_AB) override { throw std::runtime_error(text_of(X_AB)); }
  Outcome<Separation> distance(const Pose& X_AB) override { return fail(Status::failed, text_of(X_AB)); }

 private:
  static std::string text_of(const Pose& X_AB) { return hostile_text(static_cast<std::uint64_t>(X_AB.t.x())); }
};

std::unique_ptr<Algorithm> make_talkative(std::uint64_t seed) {
  Parameter parameter = Parameter::count("seed", hostile_text(seed), "0", 0, 1e9);
  parameter.unit = hostile_text(seed);
  return make_algorithm<Talkative>({.name = "talkative",
                                    .version = hostile_text(seed),
                                    .summary = hostile_text(seed),
                                    .answers = {.collide = true, .distance = true},
                                    .parameters = {parameter}});
}

TEST(OutsideText, OfAnAlgorithmInThisProcessIsVisible) {
  const Mesh mesh = load_model("box-1k");
  for (std::uint64_t seed = 1; seed < k_texts; ++seed) {
    const auto algorithm = with_visible_words(make_talkative(seed));
    expect_visible(algorithm->traits().version, seed);
    expect_visible(algorithm->traits().summary, seed);
    expect_visible(algorithm->traits().parameters.at(0).meaning, seed);
    expect_visible(algorithm->traits().parameters.at(0).unit, seed);
    Settings settings = algorithm->settings();
    const auto query = algorithm->prepare(mesh, mesh, settings);
    std::string words;
    const auto failed = [&](const std::string& why) { words = why; };
    const Pose X_AB{.t = {static_cast<double>(seed), 0, 0}};
    EXPECT_EQ(ask_guarded([&] { return query->collide(X_AB); }, failed).status, Status::failed);
    expect_visible(words, seed);
    Outcome<Separation> distance = query->distance(X_AB);
    examine(*query, distance, failed);
    expect_visible(words, seed);
    expect_visible(query->diagnosis(), seed);
    settings.set("seed", std::to_string(seed));
    try {
      algorithm->prepare(mesh, mesh, settings);
      ADD_FAILURE() << "refused";
    } catch (const std::exception& e) {
      expect_visible(e.what(), seed);
    }
  }
}

TEST(OutsideText, OfAnAlgorithmInAnotherProcessIsVisible) {
  const Mesh mesh = load_model("box-1k");
  for (const char* const name : {"talkative", "talks-json"}) {
    const auto algorithm = RemoteAlgorithm::external("x", std::string(SERVING_PROGRAM) + " " + name, ProcessLimits());
    const auto query = algorithm->prepare(mesh, mesh, algorithm->settings());
    for (std::uint64_t seed = 0; seed < k_asked_texts; ++seed) {
      EXPECT_EQ(query->collide(Pose{.t = {static_cast<double>(seed), 0, 0}}).status, Status::failed);
      expect_visible(query->diagnosis(), seed);
    }
    EXPECT_FALSE(query->diagnosis().starts_with("not asked")) << "no text ends a process";
  }
}

TEST(OutsideText, OfParametersThatAreTypedIsRefused) {
  const auto words = [](const Parameter& parameter) -> std::string {
    Registry registry;
    try {
      registry.add(make_algorithm<Talkative>({.name = "x", .version = "1", .parameters = {parameter}}));
    } catch (const BadArgument& e) {
      return e.what();
    }
    return "added";
  };
  EXPECT_EQ(words(Parameter::count("n_2", "", "1", 1, 2)), "added");
  EXPECT_EQ(words(Parameter::choice("mode", "", "layers+local", {"layers+local", "T\xC3\xBCr"})), "added");
  EXPECT_EQ(words(Parameter::count("p\x1B", "", "1", 1, 2)), "algorithm x: parameter 'p\\x1B': only a-z, 0-9 and '_'");
  EXPECT_NE(words(Parameter::count("", "", "1", 1, 2)), "added");
  for (const char* const value : {"", "a\x1B", "a\nb", "a,b", "a b", "a\"", "a\\", "a\xFF", "a\xE2\x80\xAE"}) {
    const std::string said = words(Parameter::choice("mode", "", value, {value, "b"}));
    EXPECT_NE(said, "added") << value;
    expect_visible(said, 0);
  }
}

}  // namespace
}  // namespace sixdof
