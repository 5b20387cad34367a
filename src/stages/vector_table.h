// Which objects have vectors that their pixels refute: `varve probe --vectors`.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "motion/repair_motion.h"
#include "plan/plan.h"
#include "plan/resolve_job.h"

namespace varve {

/// Vectors of one object over the pairs of frames that were looked at. Sums are over frames.
struct ObjectVectors {
  std::string layer, view;  ///< as of Subject
  std::string id;           ///< as a number, or a hash of eight digits; "" for everything in a layer without ids
  std::string name;         ///< of a Cryptomatte manifest; "" if there is none
  int frames = 0, wrong_frames = 0;  ///< in which it is seen; in which its vectors are wrong
  std::size_t pixels = 0, tested = 0, suspicious = 0, zero = 0, unusable = 0, lost = 0;
  std::size_t wrong = 0;           ///< pixels of it in the frames in which it is wrong
  glm::dvec2 stored{0}, found{0};  ///< mean vectors in those frames, pixels
  double apart = 0;                ///< mean distance between them, pixels; 0 where no other motion was found
};

struct VectorTable {
  std::vector<std::pair<int, int>> pairs;  ///< earlier and later frame
  std::vector<ObjectVectors> objects;      ///< wrong ones first, then by id
};

/// Tests the vectors of up to `pairs` pairs of neighboring frames, spread evenly. Throws what reading throws.
VectorTable inspect_vectors(const ResolveJob& job, const SequenceInfo& info, const Plan& plan,
                            const JitterSource& jitter, int pairs, Workers& workers);

/// What is to be said of an object, a sentence; empty where its vectors are fine.
std::string sentence_of(const ObjectVectors& object);

/// For people: a table of all objects, then the sentences.
std::string vector_table_text(const VectorTable& table);
/// {pairs: [[earlier, later]], objects: [{layer, view, id, name, frames, wrong_frames, pixels, tested, suspicious,
/// zero, unusable, lost, stored: [x, y], found: [x, y], apart, sentence}]}
std::string vector_table_json(const VectorTable& table);

}  // namespace varve
