// What `varve probe` and `--dry-run` say: the sequence and the plan, for people and for machines.
#pragma once

#include <string>
#include <vector>

#include "plan/plan.h"
#include "plan/probe.h"

namespace varve {

/// For people, at most 100 columns wide where names allow. Ends with a line break.
std::string describe_text(const SequenceInfo& info, const Plan& plan, const std::vector<ChannelStatistics>& statistics);

/// One JSON object, the same facts. Members, always present, in this order; later versions only add some:
///   frames        {list: text, count, first, last, gaps: text}
///   files         [{path, bytes, parts: [{name, view, storage, compression, data_window: [x0, y0, x1, y1] half open,
///                 display_window, channels: [{name, type, class, role: text or null, read: bool}]}]}]   of the first
///                 frame
///   windows       {data_moves: bool, display_differs: bool}
///   layers        [{layer, view, default_view, convention: text or null, depth: text or null,
///                 motion: [x, y] or null, forward: [x, y] or null}]
///   jitter        {source: text, frames}
///   camera        {source: text, frames}
///   plan          {passes: [{name, runs, reason}], bytes, seconds_per_frame}
///   statistics    [{frame, part, channel, role, least, greatest, mean, pixels, not_finite, zero}]
///   findings      [text]   what the statistics say of the vectors
///   notes         [text]
///   motion        what the pixels say of the vectors (motion_json), or null
/// `motion` is a JSON object, or empty.
std::string describe_json(const SequenceInfo& info, const Plan& plan, const std::vector<ChannelStatistics>& statistics,
                          const std::string& motion = "");

/// What the numbers say of the vectors and of bad pixels, a sentence each.
std::vector<std::string> findings(const SequenceInfo& info, const std::vector<ChannelStatistics>& statistics);

/// Roles of a channel in the subjects ("beauty R, depth"); "" if it has none.
std::string roles_of(const SequenceInfo& info, ChannelRef ref);

}  // namespace varve
