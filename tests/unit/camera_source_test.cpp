// Where cameras are told: attributes, Note, sidecars; and everything there that is no camera.
#include "exr/camera_source.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>

#include "base/error.h"
#include "base/json.h"
#include "support/refusal.h"
#include "synth/camera.h"

namespace varve {
namespace {

/// What a refused call says.
std::string message_of(ExitCode code, const std::function<void()>& call) { return test::message_of(call, code); }
namespace fs = std::filesystem;

synth::Camera seen_from(double time) {
  synth::Camera c;
  c.pose = {{3 * time, -1, 2 * time},
            synth::turned_y(0.02 * time) * synth::turned_x(0.3) * synth::turned_z(0.01 * time)};
  c.focal = 300 + 5 * time;
  c.shift = {2 * time, -3};
  return c;
}

std::vector<double> numbers_of(const synth::Matrix& m) { return {std::begin(m.values), std::end(m.values)}; }

constexpr int kWidth = 320, kHeight = 200;

Part bare_part() {
  Part part;
  part.data_window = part.display_window = {10, -20, 10 + kWidth, -20 + kHeight};
  return part;
}

Part part_of(const synth::Camera& camera, bool to_camera = true, bool to_ndc = true) {
  Part part = bare_part();
  if (to_camera) part.attributes.push_back({"worldToCamera", "m44f", "", numbers_of(world_to_camera(camera))});
  if (to_ndc) part.attributes.push_back({"worldToNDC", "m44f", "", numbers_of(world_to_ndc(camera, kWidth, kHeight))});
  return part;
}

std::string list(const std::vector<double>& numbers) {
  std::string text;
  for (const double n : numbers) text += (text.empty() ? "" : ",") + json_number(n);
  return text;
}

std::string view_of(const synth::Camera& c) { return list(numbers_of(opengl_view(c))); }
std::string projection_of(const synth::Camera& c) { return list(numbers_of(opengl_projection(c, kWidth, kHeight))); }

Part noted(const synth::Camera& camera) {
  Part part = bare_part();
  const std::string note = "{\"view\":[" + view_of(camera) + "],\"proj\":[" + projection_of(camera) + "]}";
  part.attributes.push_back({"Note", "string", note, {}});
  return part;
}

/// What a camera does is where it shows things: two frames, a few points.
void expect_same_motion(const FoundCamera& a, const FoundCamera& b, double time_a = 1, double time_b = 2) {
  ASSERT_TRUE(a.camera && b.camera) << a.problem << b.problem;
  const synth::Camera here = seen_from(time_a), there = seen_from(time_b);
  const glm::dmat3 ray = glm::inverse(lens_of(here, kWidth, kHeight));
  for (const double x : {3.0, 150.0, 310.0})
    for (const double depth : {90.0, 700.0}) {
      const glm::dvec3 in_world = here.pose.rotation * (ray * glm::dvec3(x, 77, 1) * depth) + here.pose.position;
      const synth::Pose back = inverse(there.pose);
      const glm::dvec3 q = lens_of(there, kWidth, kHeight) * (back.rotation * in_world + back.position);
      const SeenPoint seen = reproject({10 + x, -20 + 77}, depth, *a.camera, *b.camera);
      EXPECT_NEAR(seen.pixel.x, 10 + q.x / q.z, 1e-6);
      EXPECT_NEAR(seen.pixel.y, -20 + q.y / q.z, 1e-6);
      EXPECT_NEAR(seen.depth, q.z, 1e-6);
    }
}

FoundCamera found(const Part& part) { return find_camera({}, part, 7); }

TEST(CameraSource, AttributesAndNoteShowTheSame) {
  for (const bool with_camera : {true, false})
    expect_same_motion(found(part_of(seen_from(1), with_camera)), found(part_of(seen_from(2), with_camera)));
  expect_same_motion(found(noted(seen_from(1))), found(noted(seen_from(2))));
  EXPECT_EQ(found(part_of(seen_from(1))).source, "worldToCamera and worldToNDC");
  EXPECT_EQ(found(part_of(seen_from(1), false)).source, "worldToNDC");
  EXPECT_EQ(found(noted(seen_from(1))).source, "view and proj in the attribute Note");
  EXPECT_EQ(found(bare_part()).source, "");
}

TEST(CameraSource, MinusOneToOneIsToldByItsMiddle) {
  const auto twice = [](Part part) {
    std::vector<double>& n = part.attributes.back().numbers;
    for (std::size_t r = 0; r < 4; ++r) {  // columns x, y, z, w of row vectors
      n[4 * r] = 2 * n[4 * r] - n[4 * r + 3];
      n[4 * r + 1] = n[4 * r + 3] - 2 * n[4 * r + 1];
    }
    return part;
  };
  for (const bool with_camera : {true, false}) {
    const FoundCamera a = found(twice(part_of(seen_from(1), with_camera)));
    expect_same_motion(a, found(twice(part_of(seen_from(2), with_camera))));
    EXPECT_NE(a.problem.find("-1 to 1"), std::string::npos);
  }
}

TEST(CameraSource, ScaleIsTakenOut) {
  const auto scaled = [](Part part) {
    for (std::size_t i = 0; i < 16; ++i)
      if (i % 4 != 3) part.attributes[0].numbers[i] *= 100;  // centimeters
    return part;
  };
  const FoundCamera a = found(scaled(part_of(seen_from(1))));
  expect_same_motion(a, found(scaled(part_of(seen_from(2)))));
  EXPECT_NE(a.problem.find("scale"), std::string::npos);
}

TEST(CameraSource, OrthographicInBothForms) {
  // 4 units fill the width; seen from 10 in front of the origin.
  Part part = bare_part();
  const std::vector<double> view = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -10, 0, 0, 0, 1};
  const std::vector<double> proj = {0.5, 0, 0, 0, 0, 0.8, 0, 0, 0, 0, -0.01, 0, 0, 0, 0, 1};
  part.attributes.push_back({"Note", "string", "{\"view\":[" + list(view) + "],\"proj\":[" + list(proj) + "]}", {}});
  const FoundCamera note = found(part);
  ASSERT_TRUE(note.camera) << note.problem;
  EXPECT_EQ(note.camera->projection, Projection::orthographic);
  EXPECT_DOUBLE_EQ(note.camera->focal.x, 80);
  EXPECT_EQ(note.camera->center, glm::dvec2(170, 80));
  part.attributes = {{"worldToCamera", "m44f", "", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 10, 1}},
                     {"worldToNDC", "m44f", "", {0.25, 0, 0, 0, 0, -0.4, 0, 0, 0, 0, -0.01, 0, 0.5, 0.5, 0.1, 1}}};
  const FoundCamera attributes = found(part);
  ASSERT_TRUE(attributes.camera) << attributes.problem;
  EXPECT_EQ(attributes.camera->projection, Projection::orthographic);
  const SeenPoint a = reproject({100, 30}, 12, *attributes.camera, *note.camera);
  EXPECT_NEAR(a.pixel.x, 100, 1e-9);
  EXPECT_NEAR(a.pixel.y, 30, 1e-9);
  EXPECT_NEAR(a.depth, 12, 1e-9);
  part.attributes.erase(part.attributes.begin());
  EXPECT_NE(found(part).problem.find("orthographic"), std::string::npos);
}

TEST(CameraSource, WhatIsNoCameraIsToldAndLeftOut) {
  const auto problem = [](std::size_t attribute, auto change) {
    Part part = part_of(seen_from(1));
    change(part.attributes[attribute].numbers);
    const FoundCamera f = found(part);
    EXPECT_FALSE(f.camera);
    EXPECT_FALSE(f.source.empty());
    return f.problem;
  };
  using Numbers = std::vector<double>;
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_NE(problem(0, [](Numbers& n) { n[2] = std::nan(""); }).find("not finite"), std::string::npos);
  EXPECT_NE(problem(1, [&](Numbers& n) { n[5] = inf; }).find("not finite"), std::string::npos);
  EXPECT_NE(problem(0, [](Numbers& n) { n = Numbers(16, 0.0); }).find("affine"), std::string::npos);
  EXPECT_NE(problem(0, [](Numbers& n) { n[0] = n[1] = n[2] = 0; }).find("singular"), std::string::npos);
  EXPECT_NE(problem(0, [](Numbers& n) { n[0] *= 3; }).find("sheared"), std::string::npos);
  EXPECT_NE(problem(1, [](Numbers& n) { n = Numbers(16, 0.0); }).find("projection"), std::string::npos);
  EXPECT_NE(problem(0,
                    [](Numbers& n) {
                      for (std::size_t i = 0; i < 4; ++i)
                        for (std::size_t k = 0; k < i; ++k) std::swap(n[4 * i + k], n[4 * k + i]);
                    })
                .find("transposed"),
            std::string::npos);
  EXPECT_NE(problem(1, [](Numbers& n) { n = numbers_of(world_to_ndc(seen_from(30), kWidth, kHeight)); })
                .find("does not belong"),
            std::string::npos);
  EXPECT_NE(problem(0,
                    [](Numbers& n) {
                      for (std::size_t r = 0; r < 4; ++r) n[4 * r] = -n[4 * r];
                    })
                .find("mirrors"),
            std::string::npos);
  EXPECT_NE(found(part_of(seen_from(1), true, false)).problem.find("worldToNDC is missing"), std::string::npos);
  for (const double huge : {1e300, -1e300, 1e38})
    for (std::size_t i = 0; i < 16; ++i)
      for (const bool with_camera : {true, false}) {
        Part part = part_of(seen_from(1), with_camera);
        part.attributes.back().numbers[i] = huge;
        const FoundCamera f = found(part);
        if (f.camera) {
          EXPECT_TRUE(std::isfinite(f.camera->focal.x) && std::isfinite(f.camera->center.y));
        }
      }
}

struct Sidecar {
  std::string path = (fs::temp_directory_path() / ("varve_camera_" + std::to_string(getpid()) + ".txt")).string();
  ~Sidecar() { fs::remove(path); }
  CameraSource read(const std::string& text) const {
    std::ofstream(path) << text;
    return parse_camera_source(path);
  }
  std::string refusal(const std::string& text) const {
    return message_of(ExitCode::input, [&] { read(text); });
  }
};

std::string names(char letter) {
  std::string text;
  for (int i = 0; i < 16; ++i) text += std::string(",") + letter + std::to_string(i);
  return text;
}

TEST(CameraSource, SidecarsAsCsvAndJson) {
  const Sidecar file;
  std::string csv = "\xEF\xBB\xBF# of a shot\nframe" + names('v') + names('p') + "\r\n", json = "{\"frames\":[";
  for (const int frame : {-1, 2}) {
    const synth::Camera c = seen_from(frame);
    csv += std::to_string(frame) + "," + view_of(c) + "," + projection_of(c) + "\r\n\n";
    json += std::string(frame > 0 ? "," : "") + "{\"frame\":" + std::to_string(frame) + ",\"view\":[" + view_of(c) +
            "],\"proj\":[" + projection_of(c) + "]}";
  }
  for (const std::string& text : {csv, json + "]}"}) {
    const CameraSource source = file.read(text);
    expect_same_motion(find_camera(source, bare_part(), -1), find_camera(source, bare_part(), 2), -1, 2);
    EXPECT_FALSE(find_camera(source, bare_part(), 1).camera);
    EXPECT_FALSE(find_camera(source, part_of(seen_from(1)), 1).camera) << "a sidecar is all there is";
  }
}

TEST(CameraSource, FocalLengthAndFilm) {
  const Sidecar file;
  synth::Camera c = seen_from(0);
  const std::string csv = "frame" + names('v') + ",focal,aperture\n1," + view_of(c) + ",30,36\n";
  Part part = bare_part();
  const FoundCamera f = find_camera(file.read(csv), part, 1);
  ASSERT_TRUE(f.camera);
  EXPECT_NEAR(f.camera->focal.x, 30.0 / 36 * kWidth, 1e-9);
  EXPECT_NEAR(f.camera->focal.y, 30.0 / 36 * kWidth, 1e-9);
  EXPECT_EQ(f.camera->center, glm::dvec2(170, 80));
  part.attributes.push_back({"pixelAspectRatio", "float", "", {2}});
  EXPECT_NEAR(find_camera(file.read(csv), part, 1).camera->focal.y, 2 * 30.0 / 36 * kWidth, 1e-9);
  const std::string bad = "frame" + names('v') + ",focal,aperture\n1," + view_of(c) + ",30,0\n";
  const CameraSource source = file.read(bad);
  EXPECT_NE(message_of(ExitCode::inconsistent, [&] { find_camera(source, part, 1); }).find("frame 1"),
            std::string::npos);
}

TEST(CameraSource, BadSidecarsAreRefusedWithTheirLine) {
  const Sidecar file;
  const std::string header = "frame" + names('v') + names('p') + "\n";
  const std::string row = view_of(seen_from(1)) + "," + projection_of(seen_from(1)) + "\n";
  EXPECT_NE(file.refusal("frame,jx,jy\n1,0,0\n").find(":1:"), std::string::npos);
  EXPECT_NE(file.refusal(header + "1,2,3\n").find("3 fields"), std::string::npos);
  EXPECT_NE(file.refusal(header + "1," + row + "1," + row).find("frame 1 is listed twice"), std::string::npos);
  EXPECT_NE(file.refusal(header + "1.5," + row).find("whole number"), std::string::npos);
  EXPECT_NE(file.refusal(header + "nan," + row).find(":2:"), std::string::npos);
  EXPECT_NE(file.refusal(header).find("holds no camera"), std::string::npos);
  EXPECT_NE(file.refusal("").find("holds no camera"), std::string::npos);
  EXPECT_NE(file.refusal("{\"a\":1}").find("no list"), std::string::npos);
  EXPECT_NE(file.refusal("[{\"frame\":1,\"view\":[1,2]}]").find("16 numbers"), std::string::npos);
  EXPECT_NE(file.refusal("[1]").find("entry 1"), std::string::npos);
  EXPECT_NE(message_of(ExitCode::usage, [] { parse_camera_source("sometimes"); }).find("auto, off"), std::string::npos);
  EXPECT_NE(message_of(ExitCode::input, [] { parse_camera_source("no/such.csv"); }).find("no/such.csv"),
            std::string::npos);
  std::vector<double> flat(16, 0.0);
  flat[15] = 1;
  const CameraSource singular = file.read(header + "4," + list(flat) + "," + projection_of(seen_from(1)) + "\n");
  const std::string said = message_of(ExitCode::inconsistent, [&] { find_camera(singular, bare_part(), 4); });
  EXPECT_NE(said.find("frame 4"), std::string::npos);
  EXPECT_NE(said.find("--camera off"), std::string::npos);
}

}  // namespace
}  // namespace varve
