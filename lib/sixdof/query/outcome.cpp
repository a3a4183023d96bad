#include <sixdof/query/outcome.h>

namespace sixdof {

std::string_view to_string(Status status) {
  switch (status) {
    case Status::ok:
      return "ok";
    case Status::unsupported:
      return "unsupported";
    case Status::failed:
      return "failed";
    case Status::non_finite:
      return "non_finite";
  }
  return "unknown";
}

}  // namespace sixdof
