#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <sixdof/scene/scene_algorithm.h>

/// What `sixdof scene play` is asked, and its two answers: a table of times and faults, or the pairs themselves.
namespace sixdof::cli {

struct PlayOptions {
  std::string file;
  std::vector<std::string> algorithms, questions{"touching"};
  std::vector<std::uint32_t> bodies;
  std::string frames;
  unsigned threads = 0;
  bool list = false, json = false;
};

/// What is played of the file.
struct Part {
  scene::Scene scene;
  std::size_t first = 0;  ///< Its first frame's number in the file.
};

/// An algorithm that cannot answer a question, and why.
struct LeftOut {
  std::string algorithm, reason;
};

/// The algorithms that are asked a question.
struct Asked {
  scene::Question question;
  std::vector<const scene::SceneAlgorithm*> algorithms;
  std::vector<LeftOut> left_out;
};

/// Prints the pairs, distances and wrenches of each frame as they are found: rows of CSV, or one JSON array with an
/// object for each question, algorithm and frame.
/// @throws BadArgument or BadMesh if no question has an answer
void list_answers(const Part& part, const std::vector<Asked>& asked, bool json);

}  // namespace sixdof::cli
