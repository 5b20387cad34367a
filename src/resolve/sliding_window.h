// Windows of any width at the same cost: van Herk 1992, Gil and Werman 1993, for any associative merge.
#pragma once

#include <algorithm>
#include <cstddef>

namespace varve {

inline constexpr int kMostLanes = 16;

/// In place: nodes[i] becomes the merge of nodes[i] to nodes[i + width - 1], for 0 <= i <= length - width. The line is
/// cut into blocks of `width`; each window is the end of one block and the beginning of the next, both built up by
/// merging alone: three merges a node whatever the width. `lanes` neighboring lines go together (at most kMostLanes),
/// `stride` leads from one node to the next of a line.
template <class Node>
void slide(Node* nodes, std::ptrdiff_t stride, int length, int width, int lanes) {
  if (width <= 1) return;
  for (int block = 0; block + width <= length; block += width) {
    for (int i = block + width - 2; i >= block; --i)
      for (int l = 0; l < lanes; ++l) {
        Node& node = nodes[i * stride + l];
        node = merge(node, nodes[(i + 1) * stride + l]);
      }
    Node begin[kMostLanes];
    const int end = std::min(block + width, length - width + 1);
    for (int i = block + 1; i < end; ++i)
      for (int l = 0; l < lanes; ++l) {
        const Node& next = nodes[(i + width - 1) * stride + l];
        begin[l] = i == block + 1 ? next : merge(begin[l], next);
        Node& node = nodes[i * stride + l];
        node = merge(node, begin[l]);
      }
  }
}

}  // namespace varve
