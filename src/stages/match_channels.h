// What of one frame's two files belongs together, from headers only: shape comes before numbers.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "plan/compare_job.h"
#include "plan/probe.h"

namespace varve {

/// Two colors to be compared; indices of FrameHeaders::subjects.
struct SubjectPair {
  std::size_t a = 0, b = 0;
  std::string name;  ///< layer and view as A calls them; "main" for the bare layer
  Window window;     ///< pixels compared
};

/// Two channels whose values are compared, those of the colors among them.
struct ChannelPair {
  std::string name;
  ChannelRef a, b;
  Window window;
  bool color = false;  ///< belongs to a SubjectPair
};

/// How much it matters that something is not the same on both sides.
enum class FindingKind {
  note,    ///< only told
  format,  ///< the files are not equal, though their values may be
  shape,   ///< something lacks a counterpart: beyond every limit
};
struct Finding {
  std::string text;  ///< a sentence without frame
  FindingKind kind = FindingKind::shape;
  bool operator==(const Finding&) const = default;
};

struct FrameMatch {
  std::vector<SubjectPair> subjects;
  std::vector<ChannelPair> channels;
  std::vector<Finding> findings;
  std::string incomparable;  ///< why nothing can be compared; empty: it can
};

FrameMatch match_channels(const FrameHeaders& a, const FrameHeaders& b, const CompareJob& job);

/// Attributes that one side lacks or that hold other values, part by part. Left out are those that differ with every
/// run, and those that the windows, channels and compression stand in.
std::vector<Finding> compare_attributes(const FileHeader& a, const FileHeader& b);

}  // namespace varve
