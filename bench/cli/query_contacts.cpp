#include "bench/cli/query_contacts.h"

#include <optional>

#include <sixdof/oracle/contact_truth.h>
#include "bench/cli/shared.h"

namespace sixdof::cli {

nlohmann::ordered_json describe_contacts(const Contacts& contacts, const Mesh& a, const Mesh& b, const Pose& X_AB) {
  std::optional<ContactTruth> truth;
  if (a.solid() && b.solid() && !contacts.list.empty()) {
    truth.emplace(a, b);
    truth->move_to(X_AB);
  }
  auto list = nlohmann::ordered_json::array();
  for (const Contact& each : contacts.list) {
    nlohmann::ordered_json object{
        {"point", coordinates(each.point)}, {"normal", coordinates(each.normal)}, {"depth", each.depth}};
    if (truth) {
      const JudgedContact judged = truth->judge(each);
      object.update({{"off", judged.off()}, {"normal_degrees", judged.normal_angle}, {"thickness", judged.thickness}});
    }
    list.push_back(std::move(object));
  }
  return list;
}

}  // namespace sixdof::cli
