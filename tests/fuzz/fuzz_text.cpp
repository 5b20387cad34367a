// Texts that come from files and command lines.
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "base/json.h"
#include "exr/camera_matrices.h"
#include "exr/camera_source.h"
#include "exr/camera_table.h"
#include "exr/header_bytes.h"
#include "exr/jitter.h"
#include "exr/jitter_list.h"
#include "exr/sample_names.h"
#include "exr/sequence.h"
#include "fuzz/scratch.h"
#include "fuzz/targets.h"
#include "option.h"
#include "plan/preset.h"
#include "plan/setting.h"

namespace varve::fuzz {
namespace {

[[noreturn]] void broken(const char* law) {
  std::fprintf(stderr, "broken law: %s\n", law);
  std::abort();
}

void demand(bool holds, const char* law) {
  if (!holds) broken(law);
}

std::string text_of(const JsonValue& value) {
  switch (value.kind) {
    case JsonValue::Kind::null:
      return "null";
    case JsonValue::Kind::boolean:
      return value.boolean ? "true" : "false";
    case JsonValue::Kind::number:
      return json_number(value.number);
    case JsonValue::Kind::string:
      return json_quote(value.text);
    case JsonValue::Kind::array: {
      std::string text;
      for (const JsonValue& item : value.items) text += (text.empty() ? "" : ",") + text_of(item);
      return "[" + text + "]";
    }
    default: {
      std::string text;
      for (const JsonMember& member : value.members)
        text += (text.empty() ? "" : ",") + json_quote(member.name) + ":" + text_of(member.value);
      return "{" + text + "}";
    }
  }
}

std::string file_of(const std::uint8_t* data, std::size_t size) {
  const std::string path = (scratch() / "input").string();
  std::ofstream(path, std::ios::binary | std::ios::trunc)
      .write(reinterpret_cast<const char*>(data), std::streamsize(size));
  return path;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    lines.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return lines;
}

/// The little languages, on one piece of text each.
void read_as_everything(const std::string& text) {
  taken_or_refused([&] {
    const SequencePattern pattern = SequencePattern::parse(text);
    for (const int frame : {0, 1, -7, 2147483647, -2147483647 - 1}) pattern.path(frame);
  });
  taken_or_refused([&] {
    const std::vector<int> frames = parse_frame_list(text);
    if (frames.size() < 100000) demand(parse_frame_list(format_frame_list(frames)) == frames, "frame list, back");
  });
  taken_or_refused([&] {
    Parameters parameters;
    set_parameters(parameters, text);
    Parameters again;
    set_parameters(again, parameters_text(parameters));
    demand(parameters_text(again) == parameters_text(parameters), "parameters, back");
  });
  taken_or_refused([&] {
    if (const std::optional<NamedPattern> named = parse_pattern(text))
      demand(named->length >= 0, "length of a pattern");
  });
  taken_or_refused([&] {
    const std::string one[] = {text}, preset[] = {"salvi"};
    make_settings(preset, one, {});
  });
  taken_or_refused([&] {
    const std::string one[] = {text}, preset[] = {"salvi"};
    make_settings(preset, {}, one);
  });
  parse_sample_name(text);
}

std::string attribute(const std::string& name, const std::string& type, const std::string& value) {
  std::string record = name + '\0' + type + '\0';
  append(record, std::uint16_t(value.size()));
  return record + value;
}

template <class T>
std::string packed(const std::vector<T>& values) {
  std::string bytes;
  for (const T& value : values) append(bytes, value);
  return bytes;
}

}  // namespace

int fuzz_attributes(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  Part part;
  part.display_window = part.data_window = {0, 0, 64, 36};
  for (std::size_t at = 0; part.attributes.size() < 1000;) {
    const std::size_t name = bytes.find('\0', at);
    const std::size_t type = name == std::string::npos ? name : bytes.find('\0', name + 1);
    if (type == std::string::npos || type + 3 > bytes.size()) break;
    const std::size_t length =
        std::min<std::size_t>(load<std::uint16_t>(bytes.data() + type + 1), bytes.size() - type - 3);
    part.attributes.push_back(decode_attribute(
        {bytes.substr(at, name - at), bytes.substr(name + 1, type - name - 1), bytes.substr(type + 3, length)}));
    at = type + 3 + length;
  }
  taken_or_refused([&] { find_camera({}, part, 1); });
  taken_or_refused([&] { jitter_of({}, part, 1); });
  return 0;
}

int fuzz_json(const std::uint8_t* data, std::size_t size) {
  const std::optional<JsonValue> value = parse_json({reinterpret_cast<const char*>(data), size});
  if (!value) return ++tally().refused, 0;
  ++tally().taken;
  const std::string text = text_of(*value);
  const std::optional<JsonValue> again = parse_json(text);
  demand(again.has_value(), "JSON, back");
  // What is not UTF-8 is replaced once; from then on nothing changes.
  const std::string settled = text_of(*again);
  const std::optional<JsonValue> once_more = parse_json(settled);
  demand(once_more && text_of(*once_more) == settled, "JSON, settled");
  return 0;
}

int fuzz_jitter(const std::uint8_t* data, std::size_t size) {
  const std::string path = file_of(data, size);
  taken_or_refused([&] {
    const JitterSource source = parse_jitter_source(path);
    for (const int sample : {0, 1, 3}) jitter_of_sample(source, {}, 1, sample, 4);
  });
  return 0;
}

int fuzz_camera(const std::uint8_t* data, std::size_t size) {
  const std::string path = file_of(data, size);
  taken_or_refused([&] {
    const CameraSource source = parse_camera_source(path);
    Part part;
    part.display_window = part.data_window = {0, 0, 64, 36};
    for (const auto& row : source.table) taken_or_refused([&] { find_camera(source, part, row.first); });
  });
  return 0;
}

int fuzz_options(const std::uint8_t* data, std::size_t size) {
  static const std::vector<cli::Command> commands = cli::command_table();
  const std::vector<std::string> lines = lines_of({reinterpret_cast<const char*>(data), size});
  if (const cli::Command* command = cli::find_command(commands, lines[0]))
    taken_or_refused([&] { cli::parse(*command, cli::options_of(command->bit), std::span(lines).subspan(1)); });
  for (const std::string& line : lines)
    if (line.size() < 300) read_as_everything(line.substr(line.starts_with("--") ? line.find('=') + 1 : 0));
  return 0;
}

std::vector<std::string> attribute_seeds() {
  std::vector<float> camera(16, 0), ndc(16, 0);
  for (std::size_t i = 0; i < 16; i += 5) camera[i] = ndc[i] = 1;
  ndc[11] = 1;
  ndc[14] = -0.1f;
  return {attribute("worldToCamera", "m44f", packed(camera)) + attribute("worldToNDC", "m44f", packed(ndc)),
          attribute("worldToCamera", "m44d", packed(std::vector<double>(camera.begin(), camera.end()))) +
              attribute("pixelAspectRatio", "float", packed<float>({1})),
          attribute("jitter", "v2f", packed<float>({0.25f, -0.5f})) + attribute("a", "rational", packed<int>({1, 2})) +
              attribute("v", "stringvector", packed<int>({4}) + "left"),
          attribute("Note", "string",
                    R"({"jitter":[0.25,-0.125],"view":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1],)"
                    R"("proj":[1,0,0,0,0,1,0,0,0,0,-1,-1,0,0,-1,0]})")};
}

std::vector<std::string> json_seeds() {
  return {R"({"frame":1,"jitter":[0.25,-0.125],"spp":1})",
          R"({"a":[1,2.5e-3,-0,true,false,null,"\u00e9\ud83d\ude00\n\"\\"],"b":{"c":{"d":[[],{}]}}})",
          std::string(31, '[') + "1" + std::string(31, ']'), "\"text\"", " 12.5 "};
}

std::vector<std::string> jitter_seeds() {
  return {"frame,jx,jy\n1,0.25,-0.125\n2,0,0.5\n# a remark\n\n-3,-0.5,1e-3\n",
          "\xEF\xBB\xBF"
          "frame,sample,jx,jy\r\n1,0,0.25,-0.125\r\n1,1,0,0.5\r\n1,2,0,0\r\n1,3,.1,.1\r\n"};
}

std::vector<std::string> camera_seeds() {
  std::string projection = "frame", film = "frame", identity;
  for (int i = 0; i < 16; ++i) {
    projection += ",v" + std::to_string(i), film += ",v" + std::to_string(i);
    identity += i % 5 == 0 ? ",1" : ",0";
  }
  for (int i = 0; i < 16; ++i) projection += ",p" + std::to_string(i);
  const std::string frustum = ",1,0,0,0,0,1.5,0,0,0,0,-1.002,-0.2,0,0,-1,0";
  const std::string matrix = "[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]";
  return {projection + "\n1" + identity + frustum + "\n2" + identity + frustum + "\n",
          film + ",focal,aperture\n1" + identity + ",35,36\n7" + identity + ",50,24\n",
          R"({"frames":[{"frame":1,"view":)" + matrix + R"(,"proj":[1,0,0,0,0,1,0,0,0,0,-1,-1,0,0,-1,0]}]})",
          R"([{"frame":1,"view":)" + matrix + R"(,"focal":35,"aperture":36}])"};
}

std::vector<std::string> option_seeds() {
  return {
      "resolve\nshot.####.exr\n-o\nout/shot.####.exr\n-f\n1-10,20,30-50x2\n--preset=standard\n--gamma\n1.5",
      "resolve\nshot.%04d.exr\n--output=o.$F4.exr\n--layer=fg,bg\n--layers=each\n--samples=grid:2,each\n--map=R=a.R",
      "resolve\na.@@@.exr\n-o\nb.exr\n--aov=all\n--jitter=halton23:16\n--camera=c.csv\n--cuts=5,-9--3",
      "compare\na.####.exr\nb.####.exr\n--fail=psnr=30\n--fail=flip=0.1\n--metrics=fast\n--json=-",
      "measure\na.####.exr\n--sweep=gamma=0.5,1,2\n--setting=box=none gamma=2\n--presets=salvi,inside",
      "synth\nfence\n-o\nd\n--size=64x36\n--frames=1-3\n--yardsticks=2,4",
      "jitter\nhalton23:16\n--count=8\n--seed=3",
      "probe\na.####.exr\n--pixels=3\n--json",
      "accumulator=gather gamma=1.5 box=none alpha=0.1 rectify=clip\n-10--5x2,-3-4\nshot.#.exr"};
}

}  // namespace varve::fuzz
