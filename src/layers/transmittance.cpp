#include "layers/transmittance.h"

#include <algorithm>
#include <atomic>

namespace varve {

void hold_opacity(Present& present, Workers& workers) {
  const Window& w = present.color.window();
  const bool apart = !present.transmittance.empty();
  std::atomic<std::size_t> changed = 0;
  workers.for_rows(w.y0, w.y1, [&](int y) {
    std::size_t row = 0;
    for (int x = w.x0; x < w.x1; ++x) {
      float& alpha = present.color.at(x, y).w;
      const float before = alpha;
      alpha = std::clamp(alpha, 0.0f, 1.0f);
      bool differs = !(alpha == before);
      for (int k = 0; apart && k < 3; ++k) {
        float& t = present.transmittance.at(x, y)[k];
        const float stored = t;
        t = t == t ? float(held(double(t))) : 1 - alpha;
        differs = differs || !(t == stored);
      }
      row += differs;
    }
    changed += row;
  });
  present.opacity_held += changed;
}

void separate_transmittance(std::span<Present> layers, const std::vector<bool>& cumulative, Workers& workers) {
  Window all;
  for (const Present& layer : layers) all = unite(all, layer.color.window());
  workers.for_rows(all.y0, all.y1, [&](int y) {
    for (int x = all.x0; x < all.x1; ++x) {
      glm::dvec3 arrives(1.0);
      for (std::size_t i = 0; i < layers.size(); ++i) {
        Present& layer = layers[i];
        if (!layer.color.window().contains(x, y)) continue;
        if (cumulative[i]) {
          glm::vec3& stored = layer.transmittance.at(x, y);
          for (int k = 0; k < 3; ++k)
            stored[k] = arrives[k] > 0           ? float(double(stored[k]) / arrives[k])
                        : stored[k] == stored[k] ? 1.0f
                                                 : stored[k];
        }
        const double opacity = double(layer.color.at(x, y).w);
        for (int k = 0; k < 3; ++k) {
          const double t = layer.transmittance.empty() ? 1 - opacity : double(layer.transmittance.at(x, y)[k]);
          arrives[k] *= held(t == t ? t : 1 - opacity);
        }
      }
    }
  });
}

namespace {

bool shines(const Plane<glm::vec4>& color, int x, int y) {
  const Window& w = color.window();
  for (int j = std::max(y - 1, w.y0); j <= std::min(y + 1, w.y1 - 1); ++j)
    for (int i = std::max(x - 1, w.x0); i <= std::min(x + 1, w.x1 - 1); ++i) {
      const glm::vec4& c = color.at(i, j);
      if (!(c.w > 0) && (c.x != 0 || c.y != 0 || c.z != 0)) return true;
    }
  return false;
}

}  // namespace

void hold_resolved(Plane<glm::vec4>& color, const Present& present, Workers& workers) {
  const Window& w = color.window();
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = w.x0; x < w.x1; ++x) {
      glm::vec4& c = color.at(x, y);
      c.w = std::clamp(c.w, 0.0f, 1.0f);
      const bool lit = c.x != 0 || c.y != 0 || c.z != 0;
      if (!(c.w > 0) && lit && !shines(present.color, x, y)) c = glm::vec4(0.0f);
    }
  });
}

void fold_into_alpha(Present& present, Workers& workers) {
  if (present.transmittance.empty()) return;
  const Window& w = present.color.window();
  workers.for_rows(w.y0, w.y1, [&](int y) {
    for (int x = w.x0; x < w.x1; ++x) present.color.at(x, y).w = 1 - present.transmittance.at(x, y).x;
  });
  present.transmittance = {};
}

}  // namespace varve
