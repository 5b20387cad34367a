// The list of renders as JSON and as CSV.
#include "base/json.h"
#include "rerender/rerender_list.h"

namespace varve {
namespace {

std::string number(double value) { return json_number(value); }

/// The window as renderers want it, from the corner of the display window.
struct CropWindow {
  int x0, y0, x1, y1;                              // pixels, y down, half open
  double min_x, max_x, min_y, max_y;               // fractions of the display window, y up
  int region_x0, region_y0, region_x1, region_y1;  // pixels, y down, both ends included

  CropWindow(const Window& w, const Window& display)
      : x0(w.x0 - display.x0),
        y0(w.y0 - display.y0),
        x1(w.x1 - display.x0),
        y1(w.y1 - display.y0),
        min_x(double(x0) / display.width()),
        max_x(double(x1) / display.width()),
        min_y(1 - double(y1) / display.height()),
        max_y(1 - double(y0) / display.height()),
        region_x0(x0),
        region_y0(y0),
        region_x1(x1 - 1),
        region_y1(y1 - 1) {}
};

const char* reason_of(const RenderRectangle& r) {
  if (r.failed == 0) return "noise";
  return r.noisy == 0 ? "rejected" : "both";
}

std::string member(const char* name, const std::string& value, bool last = false) {
  return json_quote(name) + ": " + value + (last ? "" : ", ");
}

std::string entry_json(const RerenderEntry& e, const Window& display) {
  const CropWindow c(e.what.window, display);
  std::string positions, files;
  for (std::size_t s = 0; s < e.files.size(); ++s) {
    const char* comma = s > 0 ? ", " : "";
    positions += comma + ("[" + number(e.positions[s].x) + ", " + number(e.positions[s].y) + "]");
    files += comma + json_quote(e.files[s]);
  }
  return "    {" + member("frame", std::to_string(e.frame)) + member("rectangle", std::to_string(e.rectangle)) +
         member("samples", std::to_string(e.what.samples)) + member("reason", json_quote(reason_of(e.what))) +
         "\n     " +
         member("window", "[" + std::to_string(c.x0) + ", " + std::to_string(c.y0) + ", " + std::to_string(c.x1) +
                              ", " + std::to_string(c.y1) + "]") +
         member("border", "{" + member("min_x", number(c.min_x)) + member("max_x", number(c.max_x)) +
                              member("min_y", number(c.min_y)) + member("max_y", number(c.max_y), true) + "}") +
         "\n     " +
         member("region", "{" + member("min_x", std::to_string(c.region_x0)) +
                              member("max_x", std::to_string(c.region_x1)) +
                              member("min_y", std::to_string(c.region_y0)) +
                              member("max_y", std::to_string(c.region_y1), true) + "}") +
         "\n     " + member("jitter", "[" + positions + "]") + "\n     " + member("files", "[" + files + "]") +
         "\n     " + member("failed_pixels", std::to_string(e.what.failed)) +
         member("noisy_pixels", std::to_string(e.what.noisy)) + member("lacking", number(e.what.lacking)) +
         member("variance", number(e.what.variance)) + member("gain", number(e.what.gain), true) + "}";
}

}  // namespace

std::string rerender_json(const RerenderList& list, const std::string& version) {
  const RerenderRequest& r = list.request;
  std::string text = "{\n  " + member("format", "\"varve rerender list\"") + member("schema", "1") +
                     member("version", json_quote(version)) + "\n  ";
  text += member("width", std::to_string(list.display.width())) +
          member("height", std::to_string(list.display.height())) + member("extra", "\"extra.*.####.exr\"") + "\n  ";
  text += member("want_samples", number(r.want_samples)) + member("want_noise", number(r.want_noise)) +
          member("tile", std::to_string(r.tile)) + member("budget", number(r.budget)) + "\n  ";
  text += member("frames", std::to_string(list.frames)) + member("pixels", std::to_string(list.pixels)) +
          member("samples", number(list.samples)) +
          member("samples_per_pixel", number(list.pixels > 0 ? list.samples / double(list.pixels) : 0)) +
          member("variance", number(list.variance)) + member("gain", number(list.gain)) + "\n  " + "\"renders\": [";
  for (std::size_t i = 0; i < list.entries.size(); ++i)
    text += (i > 0 ? ",\n" : "\n") + entry_json(list.entries[i], list.display);
  return text + "\n  ]\n}\n";
}

std::string rerender_csv(const RerenderList& list) {
  std::string text =
      "frame,rectangle,sample,x0,y0,x1,y1,border_min_x,border_max_x,border_min_y,border_max_y,region_min_x,"
      "region_max_x,region_min_y,region_max_y,jx,jy,file,reason,lacking,variance,gain\n";
  for (const RerenderEntry& e : list.entries) {
    const CropWindow c(e.what.window, list.display);
    for (std::size_t s = 0; s < e.files.size(); ++s) {
      const auto add = [&](const std::string& field) { text += "," + field; };
      text += std::to_string(e.frame);
      add(std::to_string(e.rectangle)), add(std::to_string(s));
      for (const int v : {c.x0, c.y0, c.x1, c.y1}) add(std::to_string(v));
      for (const double v : {c.min_x, c.max_x, c.min_y, c.max_y}) add(number(v));
      for (const int v : {c.region_x0, c.region_x1, c.region_y0, c.region_y1}) add(std::to_string(v));
      add(number(e.positions[s].x)), add(number(e.positions[s].y));
      add(e.files[s]), add(reason_of(e.what));
      for (const double v : {e.what.lacking, e.what.variance, e.what.gain}) add(number(v));
      text += "\n";
    }
  }
  return text;
}

}  // namespace varve
