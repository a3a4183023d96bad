#include "bench/cli/info_check.h"

#include <fmt/format.h>

#include "bench/cli/shared.h"

namespace sixdof::cli {
namespace {

const char* name_of(ContactKind kind) {
  switch (kind) {
    case ContactKind::crossing:
      return "crossing";
    case ContactKind::coplanar:
      return "coplanar";
    case ContactKind::coincident:
      return "coincident";
  }
  return "";
}

const char* name_of(ShellDefect defect) {
  switch (defect) {
    case ShellDefect::doubled:
      return "doubled";
    case ShellDefect::nested:
      return "nested";
    case ShellDefect::inverted:
      return "inverted";
  }
  return "";
}

std::string place(const Eigen::Vector3d& p) { return fmt::format("({:.9g}, {:.9g}, {:.9g})", p.x(), p.y(), p.z()); }

std::string text_of(const DefectiveShell& shell) {
  const std::string of_shell =
      fmt::format("shell of {} triangles, at triangle {}, {}", shell.triangles, shell.triangle, place(shell.point));
  if (shell.defect == ShellDefect::doubled) return "doubled: " + of_shell;
  return fmt::format("{}: {}: counts {} times", name_of(shell.defect), of_shell, shell.layers);
}

}  // namespace

nlohmann::ordered_json check_as_json(const MeshCheck& check) {
  auto contacts = nlohmann::ordered_json::array();
  for (const SelfContact& contact : check.contacts.first) {
    contacts.push_back({{"kind", name_of(contact.kind)},
                        {"triangles", {contact.a, contact.b}},
                        {"point", coordinates(contact.point)}});
  }
  auto shells = nlohmann::ordered_json::array();
  for (const DefectiveShell& shell : check.first) {
    shells.push_back({{"defect", name_of(shell.defect)},
                      {"triangles", shell.triangles},
                      {"triangle", shell.triangle},
                      {"point", coordinates(shell.point)}});
    if (shell.defect != ShellDefect::doubled) shells.back()["layers"] = shell.layers;
  }
  return {{"clean", check.clean()},
          {"self_contacts",
           {{"pairs", check.contacts.pairs()},
            {"crossing", check.contacts.crossing},
            {"coplanar", check.contacts.coplanar},
            {"coincident", check.contacts.coincident},
            {"first", std::move(contacts)}}},
          {"shells",
           {{"count", check.shells},
            {"open", check.open_shells},
            {"undecided", check.undecided},
            {"meeting", check.meeting},
            {"doubled", check.doubled},
            {"nested", check.nested},
            {"inverted", check.inverted},
            {"first", std::move(shells)}}}};
}

void print_check(const MeshCheck& check) {
  const auto row = [](const char* label, const std::string& value) { fmt::print("{:<12} {}\n", label, value); };
  const SelfContacts& contacts = check.contacts;
  row("contacts", fmt::format("{} pairs of triangles meet beyond what they share: {} crossing, {} coplanar, {} "
                              "coincident",
                              contacts.pairs(), contacts.crossing, contacts.coplanar, contacts.coincident));
  for (const SelfContact& contact : contacts.first) {
    row("", fmt::format("{}: triangles {} and {} at {}", name_of(contact.kind), contact.a, contact.b,
                        place(contact.point)));
  }
  if (contacts.pairs() > contacts.first.size()) {
    row("", fmt::format("and {} more", contacts.pairs() - contacts.first.size()));
  }
  row("shells",
      fmt::format("{}: {} meet others, {} doubled, {} nested, {} inverted; {} open, {} undecided", check.shells,
                  check.meeting, check.doubled, check.nested, check.inverted, check.open_shells, check.undecided));
  for (const DefectiveShell& shell : check.first) row("", text_of(shell));
  const std::size_t defective = check.doubled + check.nested + check.inverted;
  if (defective > check.first.size()) row("", fmt::format("and {} more", defective - check.first.size()));
}

}  // namespace sixdof::cli
