// What an accumulator carries from frame to frame, member by member: the one list that state files are written and read
// by. A member that is added to one of these structs needs its line here; a test counts them.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <string>
#include <type_traits>

#include "stages/accumulate_frame.h"

namespace varve {

template <class A, class B>
concept SameStruct = std::same_as<std::remove_const_t<A>, B>;

/// A member that state files do without, and why.
struct LeftOut {
  const char* why;
};

// visit(name, member) for every member: planes, vectors of planes, vectors of bytes, pairs of doubles, ints, one of the
// structs below or an array of them; visit(name, LeftOut) for what is not kept.

template <class Visit>
void visit_members(SameStruct<SeenPlanes> auto& seen, Visit&& visit) {
  visit("light", seen.light);
  visit("depth", seen.depth);
  visit("id", seen.id);
  visit("jitter", seen.jitter);
  visit("cameras", LeftOut{"made again from the cameras of the frame, which the head of the file keeps"});
}

template <class Visit>
void visit_members(SameStruct<ForwardMemory> auto& memory, Visit&& visit) {
  visit("motion", memory.motion);
  visit("depth", memory.depth);
  visit("seen", memory.seen);
}

template <class Visit>
void visit_members(SameStruct<History> auto& history, Visit&& visit) {
  visit("color", history.color);
  visit("companions", history.companions);
  visit("total", history.total);
  visit("spread", history.spread);
  visit("remainder", history.remainder);
  visit("blur", history.blur);
  visit("depth", history.depth);
  visit("motion", history.motion);
  visit("id", history.id);
  visit("normal", history.normal);
  visit("rows_valid", history.rows_valid);
}

template <class Visit>
void visit_members(SameStruct<SubpixelBuffer> auto& buffer, Visit&& visit) {
  visit("color", buffer.color);
  visit("companions", buffer.companions);
  visit("total", buffer.total);
  visit("spread", buffer.spread);
  visit("moments", buffer.moments);
  visit("depth", buffer.depth);
  visit("id", buffer.id);
  visit("normal", buffer.normal);
  visit("way", buffer.way);
  visit("lag", buffer.lag);
}

template <class Visit>
void visit_members(SameStruct<SubpixelHistory> auto& history, Visit&& visit) {
  visit("quadrants", history.quadrants);
}

template <class Visit>
void visit_members(SameStruct<SubjectState> auto& state, Visit&& visit) {
  visit("forward", state.forward);
  visit("history", state.history);
  visit("subpixel", state.subpixel);
  visit("gathered", LeftOut{"the gather reads the frames around each frame again"});
}

template <class T>
concept HasMembers = SameStruct<T, SeenPlanes> || SameStruct<T, ForwardMemory> || SameStruct<T, History> ||
    SameStruct<T, SubpixelBuffer> || SameStruct<T, SubpixelHistory> || SameStruct<T, SubjectState>;

template <class T>
struct IsArray : std::false_type {};
template <HasMembers T, std::size_t N>
struct IsArray<std::array<T, N>> : std::true_type {};

/// visit(name, leaf) for everything that is kept below `state`, with names such as "history/color".
template <HasMembers State, class Visit>
void visit_leaves(State& state, const std::string& prefix, const Visit& visit) {
  visit_members(state, [&](const char* name, auto&& member) {
    using Member = std::remove_cvref_t<decltype(member)>;
    if constexpr (HasMembers<Member>)
      visit_leaves(member, prefix + name + "/", visit);
    else if constexpr (IsArray<Member>::value)
      for (std::size_t i = 0; i < member.size(); ++i)
        visit_leaves(member[i], prefix + name + "/" + std::to_string(i) + "/", visit);
    else if constexpr (!std::same_as<Member, LeftOut>)
      visit(prefix + name, member);
  });
}

}  // namespace varve
