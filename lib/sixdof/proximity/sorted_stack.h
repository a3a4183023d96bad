#pragma once

#include <cstddef>
#include <vector>

#include <hwy/base.h>

namespace sixdof::detail {

/// Inserts a pair or volume into stack[first], stack[first + 1], ..., which is sorted: the smallest `lower` is on top.
template <class T>
HWY_INLINE void push_sorted(std::vector<T>& stack, std::size_t first, const T& x) {
  std::size_t at = stack.size();
  stack.push_back(x);
  for (; at > first && stack[at - 1].lower < x.lower; --at) stack[at] = stack[at - 1];
  stack[at] = x;
}

}  // namespace sixdof::detail
