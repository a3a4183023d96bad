#pragma once

#include <memory>
#include <string>

#include <sixdof/models/model_catalogue.h>
#include <sixdof/process/remote_algorithm.h>

namespace sixdof::test {

inline const Mesh& torus() {
  static const Mesh mesh = load_model("torus-1k");
  return mesh;
}
inline const Mesh& cone() {
  static const Mesh mesh = load_model("cone-1k");
  return mesh;
}

/// A program in a shell that answers hello and prepare, then goes on with `rest`.
inline std::unique_ptr<RemoteAlgorithm> script(const std::string& rest, ProcessLimits limits = {},
                                               const std::string& prepared = R"({"prepared":true})",
                                               const std::string& can = "") {
  const std::string greeting =
      R"({"protocol":1,"name":"s","version":"1","answers":["collide","distance"],"can":[)" + can + "]}";
  const std::string text = "while read line; do case $line in *hello*) echo '" + greeting + "';; *prepare*) echo '" +
                           prepared + "';; *) " + rest + ";; esac; done";
  return RemoteAlgorithm::external("s", "sh -c \"$(cat <<'END'\n" + text + "\nEND\n)\"", limits);
}

}  // namespace sixdof::test
