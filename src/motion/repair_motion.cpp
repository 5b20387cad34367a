#include "motion/repair_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "motion/fit_shifts.h"

namespace varve {
namespace {

constexpr int kNeighborReach = 8;          // px
constexpr std::size_t kFewestPixels = 48;  // of a surface, suspicious, before it is looked at
constexpr std::size_t kNamedPixels = 64;   // of a surface without an id that is worth a row
constexpr double kLeastApart = 0.75;       // px: less is beyond what whole pixels of light can prove
constexpr double kLostShare = 0.5;         // of a surface's pixels that must be nowhere before its vectors are dropped
constexpr double kPlain = 0.15;            // of the contrast of a surface that a wrong vector's misfit reaches
constexpr double kTexture = 0.004;         // contrast that tells one place of a surface from another
constexpr std::size_t kSample = 16;        // cells
constexpr double kSampleGain = 0.8;        // of the misfit of the sample that may remain
constexpr double kNear = 8;                // px, change of a vector up to which it need not explain more
constexpr int kFitsAnything = 3;           // cells: they are as many numbers as an affine motion has unknowns
constexpr double kChance = 1.5;            // in cells to the power 1/2
constexpr double kCameraLead = 1.15;       // misfit of the camera's motion against that found that still wins
constexpr float kNowhere = std::numeric_limits<float>::quiet_NaN();

/// A surface, and what its cells add up to.
struct Surface {
  SurfaceVectors row;
  std::vector<std::size_t> cells;
  bool asked = false, by_camera = false, dropped = false;
  double stored_cost = 0, found_cost = 0, camera_cost = 0, contrast = 0;  // over its suspicious cells, by pixels
};

using Surfaces = std::map<std::uint32_t, Surface>;

Surfaces sum_surfaces(const VectorCells& cells, const Plane<glm::vec2>& motion, const Plane<std::uint8_t>& verdict,
                      const Plane<std::uint32_t>& labels) {
  Surfaces surfaces;
  const Window& w = motion.window();
  Surface* last = nullptr;
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x) {
      const std::uint32_t label = labels.at(x, y);
      if (!last || last->row.label != label) last = &surfaces[label], last->row.label = label;
      SurfaceVectors& row = last->row;
      const glm::vec2 v = motion.at(x, y);
      ++row.pixels;
      row.zero += v.x == 0 && v.y == 0;
      if (v.x == v.x)
        row.stored += glm::dvec2(v);
      else
        ++row.unusable;
      row.lost += v.x == v.x && VectorVerdict(verdict.at(x, y)) == VectorVerdict::wrong;
    }
  for (auto& [label, s] : surfaces)
    if (s.row.pixels > s.row.unusable) s.row.stored /= double(s.row.pixels - s.row.unusable);
  for (std::size_t i = 0; i < cells.cells.size(); ++i) {
    const VectorCell& cell = cells.cells[i];
    Surface& s = surfaces[cell.label];
    s.cells.push_back(i);
    if (2 * cell.tested >= cell.pixels) s.row.tested += std::size_t(cell.pixels);
    if (cell.suspicious) s.row.suspicious += std::size_t(cell.pixels);
  }
  return surfaces;
}

/// Mean misfit of a cell under a motion that may differ from pixel to pixel. Where it leads out of sight it explains
/// nothing, so the misfit of the stored vectors stays.
template <class At>
double cost_of(const SeenPair& pair, const VectorCells& cells, const VectorCell& cell,
               const Plane<std::uint32_t>& labels, At at) {
  const Window block = cells.block(cell.column, cell.row);
  double sum = 0;
  for (int y = block.y0; y < block.y1; ++y)
    for (int x = block.x0; x < block.x1; ++x) {
      if (labels.at(x, y) != cell.label) continue;
      const float m = misfit(pair, x, y, at(x, y));
      sum += m >= 0 ? double(m) : cell.cost;
    }
  return sum / cell.pixels;
}

/// Whether the misfit of a surface is more than noise, and is not that of wires without texture, which a sample meets
/// by chance.
bool is_plain(const Surface& s) {
  const bool solid = double(s.row.lost) >= kLostShare / 2 * double(s.row.pixels);
  return s.stored_cost >= kPlain * s.contrast && (solid || s.contrast >= kTexture * double(s.row.suspicious));
}

/// Whether another motion explains a surface, and which.
void judge(Surface& s, const SeenPair& pair, const VectorCells& cells, const std::vector<ShiftModel>& models,
           const Plane<std::uint32_t>& labels, const Plane<glm::vec2>& camera, const RepairParameters& parameters) {
  glm::dvec2 found(0);
  int suspicious = 0;
  double apart = 0, weight = 0, suspicious_apart = 0, suspicious_weight = 0;
  for (const std::size_t i : s.cells) {
    const VectorCell& cell = cells.cells[i];
    const ShiftModel& model = models[i];
    if (!model.known) continue;
    const Window block = cells.block(cell.column, cell.row);
    const glm::dvec2 shift = model.at((block.x0 + block.x1) / 2, (block.y0 + block.y1) / 2);
    const double n = cell.pixels;
    found += n * shift, weight += n;
    if (cell.usable > 0) {
      const glm::dvec2 off = shift - cell.stored;
      const double distance = n * std::sqrt(off.x * off.x + off.y * off.y);
      apart += distance;
      if (cell.suspicious) suspicious_apart += distance, suspicious_weight += n;
    }
    if (!cell.suspicious) continue;
    ++suspicious;
    s.stored_cost += n * cell.cost, s.contrast += n * cell.contrast;
    s.found_cost += n * cost_of(pair, cells, cell, labels, [&](int x, int y) { return model.at(x, y); });
    if (!camera.empty())
      s.camera_cost +=
          n * cost_of(pair, cells, cell, labels, [&](int x, int y) { return glm::dvec2(camera.at(x, y)); });
  }
  if (!(weight > 0 && s.stored_cost > 0 && suspicious_apart >= kLeastApart * suspicious_weight)) return;
  // The best of many shifts explains a few cells by chance, so the fewer they are the more it has to explain.
  // So does the best of many places: there are more of them the farther one looks, and what repeats is met again.
  const double off = suspicious_apart / suspicious_weight;
  const double gain = parameters.gain * (1 - kChance / std::sqrt(double(suspicious))) * std::min(1.0, kNear / off);
  s.by_camera = !camera.empty() && s.camera_cost <= std::max(kCameraLead * s.found_cost, 0.1 * s.stored_cost) &&
                s.camera_cost <= parameters.gain * s.stored_cost;
  s.row.wrong = s.by_camera || (suspicious > kFitsAnything && s.found_cost <= gain * s.stored_cost && is_plain(s));
  if (!s.row.wrong) return;
  s.row.found = found / weight;
  s.row.apart = apart / weight;
}

/// The model of a pixel: of its block, else of the nearest block around that has its surface.
const ShiftModel* model_for(const VectorCells& cells, const std::vector<ShiftModel>& models, int x, int y,
                            std::uint32_t label) {
  const int column = (x - cells.window.x0) / kVectorBlock, row = (y - cells.window.y0) / kVectorBlock;
  for (int ring = 0; ring <= 2; ++ring)
    for (int j = -ring; j <= ring; ++j)
      for (int i = -ring; i <= ring; ++i) {
        if (std::max(std::abs(i), std::abs(j)) != ring) continue;
        const VectorCell* cell = cells.find(column + i, row + j, label);
        if (cell && models[cells.index(*cell)].known) return &models[cells.index(*cell)];
      }
  return nullptr;
}

/// The nearest usable vector of the same surface, first in reading order among equally near ones; NaN if there is none.
glm::vec2 vector_of_neighbor(const Plane<glm::vec2>& motion, const Plane<std::uint32_t>& labels, int x, int y) {
  const Window& w = motion.window();
  int best = std::numeric_limits<int>::max();
  glm::vec2 found(kNowhere);
  for (int v = std::max(w.y0, y - kNeighborReach); v < std::min(w.y1, y + kNeighborReach + 1); ++v)
    for (int u = std::max(w.x0, x - kNeighborReach); u < std::min(w.x1, x + kNeighborReach + 1); ++u) {
      const int distance = (u - x) * (u - x) + (v - y) * (v - y);
      if (distance >= best || labels.at(u, v) != labels.at(x, y)) continue;
      if (const glm::vec2 m = motion.at(u, v); m.x == m.x) best = distance, found = m;
    }
  return found;
}

/// Cells of a suspicious surface that are searched before the rest is: a few, spread evenly.
std::vector<std::size_t> sample_of(const Surface& s, const VectorCells& cells) {
  std::vector<std::size_t> suspicious, sample;
  for (const std::size_t i : s.cells)
    if (cells.cells[i].suspicious) suspicious.push_back(i);
  const std::size_t count = std::min(suspicious.size(), kSample);
  for (std::size_t k = 0; k < count; ++k) sample.push_back(suspicious[(2 * k + 1) * suspicious.size() / (2 * count)]);
  return sample;
}

/// Turns away from surfaces of which no motion explains even a sample of cells: noise, wires, and veils that samples
/// meet by chance are suspicious, and searching all of them would take long.
void keep_explained(Surfaces& surfaces, const SeenPair& pair, const VectorCells& cells,
                    const Plane<std::uint32_t>& labels, const Plane<glm::vec2>& camera,
                    const RepairParameters& parameters, Workers& workers) {
  std::vector<char> asked(cells.cells.size(), 0);
  for (const auto& [label, s] : surfaces)
    if (s.asked)
      for (const std::size_t i : sample_of(s, cells)) asked[i] = 1;
  const std::vector<FoundShift> found = find_shifts(pair, cells, asked, labels, camera, parameters.reach, workers);
  for (auto& [label, s] : surfaces) {
    if (!s.asked) continue;
    double stored = 0, explained = 0;
    for (const std::size_t i : sample_of(s, cells))
      stored += cells.cells[i].cost, explained += std::min(found[i].cost, cells.cells[i].cost);
    s.asked = explained <= kSampleGain * stored;
  }
}

struct Replacement {
  glm::vec2 vector;
  RepairedBy how;
};

}  // namespace

MotionRepair repair_motion(Plane<glm::vec2>& motion, const SeenFrame& here, const SeenFrame& there,
                           const Plane<glm::vec2>& back, const Plane<glm::vec2>& camera,
                           const RepairParameters& parameters, Workers& workers) {
  const SeenPair pair(here, there, parameters.depth_tolerance, workers);
  const Window& w = motion.window();
  MotionRepair out;
  MotionValidity validity = validate_motion(pair, motion, back, kWorstMisfit / 2.0, workers);
  out.census = take_census(validity, pair, motion, back);
  out.residual = std::move(validity.residual);

  // Which surfaces are suspicious as a whole, and where their pixels really went.
  const Plane<std::uint32_t> labels = label_surfaces(pair, motion, workers);
  const VectorCells cells = measure_cells(pair, motion, labels, parameters.misfit_limit, workers);
  Surfaces surfaces = sum_surfaces(cells, motion, validity.verdict, labels);
  for (auto& [label, s] : surfaces)
    s.asked = s.row.suspicious >= kFewestPixels && double(s.row.suspicious) >= parameters.share * double(s.row.tested);
  keep_explained(surfaces, pair, cells, labels, camera, parameters, workers);
  std::vector<char> asked(cells.cells.size(), 0);
  for (const auto& [label, s] : surfaces)
    for (const std::size_t i : s.cells) asked[i] = s.asked;
  const std::vector<FoundShift> found = find_shifts(pair, cells, asked, labels, camera, parameters.reach, workers);
  const std::vector<ShiftModel> models = fit_shifts(cells, found, workers);
  std::vector<Surface*> doubted;
  for (auto& [label, s] : surfaces)
    if (s.asked) doubted.push_back(&s);
  workers.for_each(doubted.size(),
                   [&](std::size_t k, int) { judge(*doubted[k], pair, cells, models, labels, camera, parameters); });

  for (auto& [label, s] : surfaces)
    if (!s.row.wrong && s.row.lost >= kFewestPixels && double(s.row.lost) >= kLostShare * double(s.row.pixels))
      s.row.wrong = s.dropped = true;

  // Pixel by pixel; every pixel reads the vectors as they came.
  const auto replace = [&](int x, int y, const Surface& s) -> Replacement {
    const glm::vec2 v = motion.at(x, y);
    if (s.dropped) return {glm::vec2(kNowhere), RepairedBy::dropped};
    if (!s.row.wrong) {
      if (v.x == v.x) return {v, RepairedBy::kept};
      if (const glm::vec2 m = vector_of_neighbor(motion, labels, x, y); m.x == m.x) return {m, RepairedBy::neighbor};
    } else if (!s.by_camera) {
      const ShiftModel* model = model_for(cells, models, x, y, s.row.label);
      return model ? Replacement{glm::vec2(model->at(x, y)), RepairedBy::search}
                   : Replacement{glm::vec2(kNowhere), RepairedBy::dropped};
    }
    if (!camera.empty() && camera.at(x, y).x == camera.at(x, y).x) return {camera.at(x, y), RepairedBy::camera};
    return {glm::vec2(kNowhere), RepairedBy::dropped};
  };
  out.how = Plane<std::uint8_t>(w);
  Plane<glm::vec2> repaired(w);
  workers.for_rows(w.y0, w.y1, [&](int y) {
    const Surface* s = nullptr;
    for (int x = w.x0; x < w.x1; ++x) {
      const std::uint32_t label = labels.at(x, y);
      if (!s || s->row.label != label) s = &surfaces.find(label)->second;
      const Replacement r = replace(x, y, *s);
      repaired.at(x, y) = r.vector;
      out.how.at(x, y) = std::uint8_t(r.how);
    }
  });
  for (int y = w.y0; y < w.y1; ++y)
    for (int x = w.x0; x < w.x1; ++x) ++out.count[out.how.at(x, y)];
  for (const auto& [label, s] : surfaces)
    if (pair.has_ids() || s.row.pixels >= kNamedPixels) out.surfaces.push_back(s.row);
  if (parameters.mode == RepairMotion::on) motion = std::move(repaired);
  return out;
}

}  // namespace varve
