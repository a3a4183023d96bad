#include <sixdof/base/visible_text.h>

#include <fmt/format.h>

namespace sixdof {

std::string visible_text(std::string_view text, std::size_t longest) {
  std::string result;
  for (const char c : text.substr(0, longest)) {
    if (c >= ' ' && c <= '~') {
      result += c;
    } else {
      result += fmt::format("\\x{:02X}", static_cast<unsigned char>(c));
    }
  }
  if (text.size() > longest) result += "...";
  return result;
}

}  // namespace sixdof
