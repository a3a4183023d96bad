#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace sixdof {

/// Text of unknown origin for a message: printable ASCII stays, every other byte becomes \xHH, so that a byte order
/// mark, a zero byte or a no-break space can be seen. Text of more than `longest` bytes is cut and ends in "...".
std::string visible_text(std::string_view text, std::size_t longest = 40);

}  // namespace sixdof
