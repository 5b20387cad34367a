#include "exr/channel_names.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <set>

#include "base/error.h"
#include "paths.h"
#include "support/refusal.h"

namespace varve {
namespace {

const std::string kData = VARVE_DATA;

using test::message_of;

Part part_of(const std::vector<std::string>& channels, const std::string& name = "", const std::string& view = "") {
  Part part;
  part.name = name;
  part.view = view;
  for (const std::string& channel : channels) part.channels.push_back({channel, PixelType::float16, 1, 1, false});
  return part;
}

FileHeader file_of(std::vector<Part> parts, std::vector<std::string> views = {}) {
  return {"x.exr", std::move(parts), std::move(views), 0};
}

std::vector<Subject> find(const std::vector<FileHeader>& files, const RoleRequest& request = {}) {
  return find_subjects(files, request);
}

std::string name_of_ref(const std::vector<FileHeader>& files, const std::optional<ChannelRef>& ref) {
  if (!ref) return "-";
  const Part& part = files[std::size_t(ref->file)].parts[std::size_t(ref->part)];
  return (part.name.empty() || files[std::size_t(ref->file)].parts.size() < 2 ? "" : part.name + ":") +
         part.channels[std::size_t(ref->channel)].name;
}

// "R G B A | depth | backward | forward", for comparison at a glance.
std::string roles(const std::vector<FileHeader>& files, const Subject& s) {
  std::string text;
  for (const auto& c : s.color) text += name_of_ref(files, c) + " ";
  text += "| " + name_of_ref(files, s.depth) + " |";
  for (const auto& v : {s.backward, s.forward})
    text += v ? " " + name_of_ref(files, (*v)[0]) + " " + name_of_ref(files, (*v)[1]) : " -";
  return text;
}

bool notes_mention(const Subject& s, const std::string& word) {
  for (const std::string& note : s.notes)
    if (note.find(word) != std::string::npos) return true;
  return false;
}

TEST(Subjects, PlainNames) {
  const std::vector<FileHeader> files = {file_of({part_of({"A", "B", "G", "R", "Z", "forward.u", "forward.v"})})};
  const std::vector<Subject> found = find(files);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(roles(files, found[0]), "R G B A | Z | - forward.u forward.v");
  EXPECT_EQ(found[0].convention, "nuke");
  EXPECT_EQ(found[0].layer, "");
  EXPECT_EQ(found[0].forward_encoding.sign_y, -1);
}

TEST(Subjects, IdAndNormalAreToldByTheirNames) {
  struct Case {
    std::vector<std::string> channels;
    std::string id, normal;
  };
  const std::vector<std::string> rgba = {"R", "G", "B", "A"};
  for (const Case& c :
       std::vector<Case>{{{"objectId"}, "objectId", "-"},
                         {{"id"}, "id", "-"},
                         {{"IndexMA.X", "IndexOB.X"}, "IndexOB.X", "-"},  // an object before a material
                         {{"CryptoMaterial00.r", "CryptoObject00.r", "CryptoObject00.g", "CryptoObject01.r"},
                          "CryptoObject00.r",
                          "-"},
                         {{"CryptoObject01.r"}, "-", "-"},  // not the first rank
                         {{"Normal.X", "Normal.Y", "Normal.Z"}, "-", "Normal.X"},
                         {{"N.R", "N.G", "N.B"}, "-", "N.R"},
                         {{"nx", "ny", "nz"}, "-", "nx"},
                         {{"Normal.X", "Normal.Y"}, "-", "-"},  // not whole
                         {{"P.X", "P.Y", "P.Z", "mist.Z"}, "-", "-"}}) {
    std::vector<std::string> channels = rgba;
    channels.insert(channels.end(), c.channels.begin(), c.channels.end());
    std::vector<FileHeader> files = {file_of({part_of(channels)})};
    for (Channel& channel : files[0].parts[0].channels)
      if (channel.name == "objectId") channel.type = PixelType::uint32;
    const Subject s = find(files).front();
    EXPECT_EQ(name_of_ref(files, s.id), c.id);
    EXPECT_EQ(s.normal ? name_of_ref(files, (*s.normal)[0]) : "-", c.normal);
  }
}

TEST(Subjects, MarksAndMasksMayBeMapped) {
  std::vector<FileHeader> files = {file_of({part_of({"R", "G", "B", "who", "m1", "m2", "a.u", "a.v", "a.w"})})};
  files[0].parts[0].channels[3].type = PixelType::uint32;
  RoleRequest request;
  request.map = {{"id", "who"},       {"reactive", "m1"},  {"responsive", "m2"},
                 {"normal.x", "a.u"}, {"normal.y", "a.v"}, {"normal.z", "a.w"}};
  const Subject s = find(files, request).front();
  EXPECT_EQ(name_of_ref(files, s.id), "who");
  EXPECT_EQ(name_of_ref(files, s.reactive), "m1");
  EXPECT_EQ(name_of_ref(files, s.responsive), "m2");
  ASSERT_TRUE(s.normal);
  EXPECT_EQ(name_of_ref(files, (*s.normal)[2]), "a.w");
  request.map = {{"normal.x", "a.u"}};
  EXPECT_NE(message_of([&] { find(files, request); }).find("normal.y"), std::string::npos);
  request.map = {{"reactive", "who"}};  // a mask is a number, an id is not
  EXPECT_NE(message_of([&] { find(files, request); }).find("integers"), std::string::npos);
}

TEST(Subjects, DepthIsNotWhatOnlyEndsInZ) {
  const std::vector<FileHeader> files = {file_of({part_of({"V L.Combined.R",
                                                           "V L.Combined.G",
                                                           "V L.Combined.B",
                                                           "V L.Combined.A",
                                                           "V L.Denoising Depth.Z",
                                                           "V L.Mist.Z",
                                                           "V L.Normal.X",
                                                           "V L.Normal.Y",
                                                           "V L.Normal.Z",
                                                           "V L.Position.X",
                                                           "V L.Position.Y",
                                                           "V L.Position.Z",
                                                           "V L.Vector.X",
                                                           "V L.Vector.Y",
                                                           "V L.Vector.Z",
                                                           "V L.Vector.W",
                                                           "P.z",
                                                           "thing.Z",
                                                           "V L.Odd.X",
                                                           "V L.Odd.Y",
                                                           "V L.Odd.Z"})})};
  EXPECT_EQ(roles(files, find(files)[0]),
            "V L.Combined.R V L.Combined.G V L.Combined.B V L.Combined.A | - | V L.Vector.X V L.Vector.Y V L.Vector.Z "
            "V L.Vector.W");
  EXPECT_TRUE(notes_mention(find(files)[0], "--map depth="));
  std::vector<FileHeader> with = files;
  with[0].parts[0].channels.push_back({"V L.Depth.Z", PixelType::float32, 1, 1, false});
  EXPECT_EQ(name_of_ref(with, find(with)[0].depth), "V L.Depth.Z");
}

TEST(Subjects, DepthUnderItsAliases) {
  for (const char* name :
       {"Z", "z", "depth.Z", "depth.V", "Depth.Z", "DEPTH.z", "zdepth", "zDepth.R", "depth", "Z.R"}) {
    const std::vector<FileHeader> files = {file_of({part_of({"R", "G", "B", name})})};
    EXPECT_EQ(name_of_ref(files, find(files)[0].depth), name);
  }
  std::vector<FileHeader> ids = {file_of({part_of({"R", "G", "B", "Z"})})};
  ids[0].parts[0].channels[3].type = PixelType::uint32;
  EXPECT_FALSE(find(ids)[0].depth);
}

TEST(Subjects, LayersKeepTheirOwnDepthAndMotion) {
  std::vector<std::string> names;
  for (const std::string& layer : {std::string("fg"), std::string("bg")})
    for (const char* c :
         {"Combined.R", "Combined.G", "Combined.B", "Combined.A", "Vector.X", "Vector.Y", "Vector.Z", "Vector.W"})
      names.push_back(layer + "." + c);
  names.push_back("bg.Depth.Z");
  const std::vector<FileHeader> files = {file_of({part_of(names)})};
  RoleRequest all;
  all.layers = {"all"};
  const std::vector<Subject> found = find(files, all);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].layer, "fg");
  EXPECT_FALSE(found[0].depth);  // the depth of bg is another layer's
  EXPECT_EQ(name_of_ref(files, (*found[0].backward)[0]), "fg.Vector.X");
  EXPECT_EQ(name_of_ref(files, found[1].depth), "bg.Depth.Z");
  EXPECT_EQ(name_of_ref(files, (*found[1].forward)[1]), "bg.Vector.W");
  const std::vector<Subject> main = find(files);
  ASSERT_EQ(main.size(), 1u);
  EXPECT_EQ(main[0].layer, "fg");
  EXPECT_TRUE(notes_mention(main[0], "--layer"));
}

TEST(Subjects, MainLayerAndLayersByName) {
  const std::vector<FileHeader> files = {file_of({part_of(
      {"R", "G", "B", "A", "diffuse.R", "diffuse.G", "diffuse.B", "N.R", "N.G", "N.B", "crypto00.R", "crypto00.G",
       "crypto00.B", "crypto00.A", "motionvector.R", "motionvector.G", "motionvector.B", "Z"})})};
  RoleRequest request;
  request.convention = "none";
  ASSERT_EQ(find(files, request).size(), 1u);
  EXPECT_EQ(find(files, request)[0].layer, "");
  EXPECT_FALSE(notes_mention(find(files, request)[0], "--layer"));
  request.layers = {"all"};
  EXPECT_EQ(find(files, request).size(), 2u);
  request.layers = {"Diffuse"};
  ASSERT_EQ(find(files, request).size(), 1u);
  EXPECT_EQ(roles(files, find(files, request)[0]), "diffuse.R diffuse.G diffuse.B - | Z | - -");
  request.layers = {"N"};
  EXPECT_NE(message_of([&] { find(files, request); }).find("diffuse"), std::string::npos);
}

TEST(Subjects, UnknownVelocityStopsWithTheRemedy) {
  const std::vector<FileHeader> files = {file_of({part_of({"R", "G", "B", "velocity.x", "velocity.y"})})};
  const std::string message = message_of([&] { find(files); });
  for (const char* word :
       {"velocity.x", "velocity.y", "--convention NAME", "varve help conventions", "--convention none"})
    EXPECT_NE(message.find(word), std::string::npos) << message;
  RoleRequest request;
  request.convention = "varve";
  EXPECT_EQ(roles(files, find(files, request)[0]), "R G B - | - | velocity.x velocity.y -");
  EXPECT_EQ(find(files, request)[0].backward_encoding.sign_y, 1);
  request.convention = "none";
  EXPECT_FALSE(find(files, request)[0].backward);
  EXPECT_EQ(find(files, request)[0].convention, "");
  request.convention = "arnold";  // does not have these channels
  EXPECT_NE(message_of([&] { find(files, request); }).find("velocity.x"), std::string::npos);
  request.convention = "banana";
  message_of([&] { find(files, request); }, ExitCode::usage);
}

TEST(Subjects, BlenderVectorWithoutWIsNotGuessed) {
  const std::vector<FileHeader> files = {
      file_of({part_of({"rgba.R", "rgba.G", "rgba.B", "Vector.X", "Vector.Y", "Vector.Z"})})};
  message_of([&] { find(files); });
  RoleRequest request;
  request.convention = "cycles-fileout";
  EXPECT_EQ(roles(files, find(files, request)[0]), "rgba.R rgba.G rgba.B - | - | Vector.X Vector.Y -");
}

TEST(Subjects, NothingThatMovesIsANote) {
  const std::vector<FileHeader> files = {file_of({part_of({"R", "G", "B"})})};
  EXPECT_TRUE(notes_mention(find(files)[0], "no vectors"));
}

TEST(Subjects, ViewsInOnePart) {
  const std::vector<FileHeader> files = {
      file_of({part_of({"ViewLayer.Combined.left.R", "ViewLayer.Combined.left.G", "ViewLayer.Combined.left.B",
                        "ViewLayer.Combined.right.R", "ViewLayer.Combined.right.G", "ViewLayer.Combined.right.B",
                        "ViewLayer.Depth.right.Z", "ViewLayer.Vector.left.X", "ViewLayer.Vector.left.Y",
                        "ViewLayer.Vector.left.Z", "ViewLayer.Vector.left.W"})},
              {"left", "right"})};
  const std::vector<Subject> found = find(files);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].view, "left");
  EXPECT_TRUE(found[0].default_view);
  EXPECT_FALSE(found[0].depth);  // the depth is the other eye's
  EXPECT_TRUE(found[0].forward);
  EXPECT_EQ(found[1].view, "right");
  EXPECT_FALSE(found[1].default_view);
  EXPECT_TRUE(found[1].depth);
  EXPECT_FALSE(found[1].backward);
  EXPECT_EQ(found[1].layer, "ViewLayer");
}

TEST(Subjects, ViewsInPartsOfTheirOwn) {
  const std::vector<FileHeader> files = {
      file_of({part_of({"R", "G", "B", "A"}, "rgba.left", "left"), part_of({"Z"}, "depth.left", "left"),
               part_of({"R", "G", "B", "A"}, "rgba.right", "right"), part_of({"Z"}, "depth.right", "right"),
               part_of({"u", "v"}, "forward.right", "right")})};
  const std::vector<Subject> found = find(files);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(roles(files, found[0]), "rgba.left:R rgba.left:G rgba.left:B rgba.left:A | depth.left:Z | - -");
  EXPECT_EQ(roles(files, found[1]),
            "rgba.right:R rgba.right:G rgba.right:B rgba.right:A | depth.right:Z | - forward.right:u forward.right:v");
}

TEST(Subjects, PartsAsLayers) {
  const std::vector<FileHeader> files = {file_of(
      {part_of({"R", "G", "B", "A"}, "rgba"), part_of({"depth.Z"}, "depth"),
       part_of({"diffuse.R", "diffuse.G", "diffuse.B"}, "diffuse"),
       part_of({"forward.u", "forward.v", "backward.u", "backward.v"}, "motion"), part_of({"X", "Y", "Z"}, "N")})};
  const std::vector<Subject> found = find(files);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].layer, "rgba");
  EXPECT_EQ(name_of_ref(files, found[0].depth), "depth:depth.Z");
  EXPECT_TRUE(found[0].backward && found[0].forward);
  RoleRequest request;
  request.layers = {"diffuse"};
  EXPECT_EQ(find(files, request)[0].layer, "diffuse");
}

TEST(Subjects, RoleFilesComeLast) {
  const FileHeader color = file_of({part_of({"R", "G", "B"})}), depth = file_of({part_of({"ViewLayer.Depth.Z"})}),
                   motion = file_of({part_of({"forward.u", "forward.v"})});
  const std::vector<FileHeader> files = {color, depth, motion};
  const Subject found = find(files)[0];
  ASSERT_TRUE(found.depth && found.forward);
  EXPECT_EQ(found.depth->file, 1);
  EXPECT_EQ((*found.forward)[0].file, 2);
  const std::vector<FileHeader> own = {file_of({part_of({"R", "G", "B", "Z"})}), depth};
  EXPECT_EQ(find(own)[0].depth->file, 0);
}

TEST(Subjects, MapOverridesNames) {
  const std::vector<FileHeader> files = {
      file_of({part_of({"R", "G", "B", "A", "Z", "odd.r1", "odd.r2", "odd.r3", "m.one", "m.two", "other depth"})})};
  RoleRequest request;
  request.map = {{"depth", "other depth"}, {"motion.x", "m.one"}, {"motion.y", "m.two"}};
  EXPECT_NE(message_of([&] { find(files, request); }).find("--convention"), std::string::npos);
  request.convention = "cycles";
  EXPECT_EQ(roles(files, find(files, request)[0]), "R G B A | other depth | m.one m.two -");
  EXPECT_EQ(find(files, request)[0].backward_encoding.sign_y, -1);
  request.map = {{"R", "odd.r1"}, {"G", "odd.r2"}, {"B", "odd.r3"}};
  EXPECT_EQ(roles(files, find(files, request)[0]), "odd.r1 odd.r2 odd.r3 - | Z | - -");
  request.map = {{"depth", "none such"}};
  message_of([&] { find(files, request); });
  request.map = {{"motion.x", "m.one"}};
  message_of([&] { find(files, request); });
  request.map = {{"dept", "Z"}};
  message_of([&] { find(files, request); }, ExitCode::usage);
}

TEST(Subjects, EncodingIsOverriddenPieceByPiece) {
  const std::vector<FileHeader> files = {file_of({part_of({"R", "G", "B", "forward.u", "forward.v"})})};
  RoleRequest request;
  request.encoding.shutter = 0.4;
  request.encoding.sign_y = 1;
  request.override_shutter = true;
  Subject found = find(files, request)[0];
  EXPECT_EQ(found.forward_encoding.shutter, 0.4);
  EXPECT_EQ(found.forward_encoding.sign_y, -1);
  request.override_direction = true;
  request.encoding.direction = MotionDirection::previous;
  found = find(files, request)[0];
  ASSERT_TRUE(found.backward);
  EXPECT_FALSE(found.forward);
  EXPECT_EQ(found.backward_encoding.direction, MotionDirection::previous);
  EXPECT_EQ(found.backward_encoding.shutter, 0.4);
  EXPECT_EQ(name_of_ref(files, (*found.backward)[0]), "forward.u");
}

TEST(Subjects, OneChannelAndNone) {
  const std::vector<FileHeader> green = {file_of({part_of({"G"})})}, gray = {file_of({part_of({"Y", "A"})})};
  EXPECT_EQ(roles(green, find(green)[0]), "- G - - | - | - -");
  EXPECT_EQ(roles(gray, find(gray)[0]), "- Y - A | - | - -");
  EXPECT_TRUE(notes_mention(find(gray)[0], "only Y"));
  EXPECT_NE(message_of([] {
              find({file_of({part_of({"Z", "N.X", "N.Y", "N.Z"})})});
            }).find("--map R="),
            std::string::npos);
  message_of([] { find({file_of({part_of({})})}); });
  Part deep = part_of({"R", "G", "B", "A", "Z"});
  deep.storage = Storage::deep_scanline;
  const std::vector<FileHeader> only_deep = {file_of({deep})};
  EXPECT_EQ(roles(only_deep, find(only_deep)[0]), "R G B A | Z | - -");
  EXPECT_TRUE(notes_mention(find(only_deep)[0], "is deep"));
}

TEST(Subjects, SubsampledColorIsRefusedAndSubsampledDataIsTold) {
  const auto with_half = [](std::vector<std::string> names, const std::set<std::string>& halved) {
    Part part = part_of(names);
    for (Channel& channel : part.channels)
      if (halved.contains(channel.name)) channel.x_sampling = channel.y_sampling = 2;
    return std::vector<FileHeader>{file_of({part})};
  };
  // Luminance and chroma; one color of three; all of them. What is whole is never resolved alone.
  for (const auto& tried : {std::pair{with_half({"Y", "RY", "BY", "A"}, {"RY", "BY"}), "RY"},
                            std::pair{with_half({"R", "G", "B"}, {"B"}), "channel B"},
                            std::pair{with_half({"R", "G", "B"}, {"R", "G", "B"}), "channel R"}}) {
    const std::string message = message_of([&] { find(tried.first); });
    EXPECT_NE(message.find("subsampled"), std::string::npos) << message;
    EXPECT_NE(message.find(tried.second), std::string::npos) << message;
  }
  // Other layers, and what is only passed through, may be as they like.
  EXPECT_EQ(find(with_half({"R", "G", "B", "fog.R", "fog.G", "fog.B"}, {"fog.R", "fog.G", "fog.B"})).size(), 1u);
  const std::vector<FileHeader> depth = with_half({"R", "G", "B", "Z"}, {"Z"});
  EXPECT_FALSE(find(depth)[0].depth);
  EXPECT_TRUE(notes_mention(find(depth)[0], "Z is subsampled"));
}

TEST(Subjects, OddNamesDoNotBreakAnything) {
  for (const char* odd :
       {"", ".", "..", "R.", ".R", "R..G", "....", "left", "left.", "Vector", "Vector.", "forward.u", "\xFF\xFE.Z"}) {
    const std::vector<FileHeader> files = {
        file_of({part_of({odd, "R", "G", "B"}, odd, odd), part_of({odd}, odd)}, {odd, "left"})};
    try {
      find(files);
    } catch (const Failure&) {
    }
  }
}

TEST(Classes, ByName) {
  const struct {
    const char* name;
    ChannelClass expected;
  } cases[] = {{"R", ChannelClass::color},
               {"left.G", ChannelClass::color},
               {"ViewLayer.DiffCol.B", ChannelClass::color},
               {"Y", ChannelClass::color},
               {"A", ChannelClass::alpha},
               {"ViewLayer.Combined.A", ChannelClass::alpha},
               {"Z", ChannelClass::depth},
               {"depth.V", ChannelClass::depth},
               {"ViewLayer.Depth.left.Z", ChannelClass::depth},
               {"ViewLayer.Denoising Depth.Z", ChannelClass::other},
               {"ViewLayer.Mist.Z", ChannelClass::other},
               {"ViewLayer.Vector.Z", ChannelClass::motion},
               {"forward.left.u", ChannelClass::motion},
               {"velX", ChannelClass::motion},
               {"N.Z", ChannelClass::normal},
               {"ViewLayer.Normal.X", ChannelClass::normal},
               {"P.R", ChannelClass::position},
               {"ViewLayer.UV.A", ChannelClass::uv},
               {"ViewLayer.IndexOB.X", ChannelClass::id},
               {"objectID", ChannelClass::id},
               {"id", ChannelClass::id},
               {"ViewLayer.CryptoObject00.r", ChannelClass::cryptomatte},
               {"crypto_material01.R", ChannelClass::cryptomatte},
               {"disparityL.x", ChannelClass::other},
               {"Debug Sample Count.X", ChannelClass::other}};
  for (const auto& c : cases)
    EXPECT_STREQ(name_of(classify({c.name, PixelType::float32, 1, 1, false})), name_of(c.expected)) << c.name;
  EXPECT_EQ(classify({"R", PixelType::uint32, 1, 1, false}), ChannelClass::id);
}

std::vector<FileHeader> real(const std::string& file) {
  return std::filesystem::exists(kData + file) ? std::vector<FileHeader>{read_header(kData + file)}
                                               : std::vector<FileHeader>{};
}
#define NEED(files) \
  if (files.empty()) GTEST_SKIP() << "no development data"

TEST(RealFiles, Courtyard) {
  const std::vector<FileHeader> files = real("/courtyard/jit/frame.0009.exr");
  NEED(files);
  const std::vector<Subject> found = find(files);
  ASSERT_EQ(found.size(), 1u);
  const std::string v = "ViewLayer.";
  EXPECT_EQ(roles(files, found[0]), v + "Combined.R " + v + "Combined.G " + v + "Combined.B " + v + "Combined.A | " +
                                        v + "Depth.Z | " + v + "Vector.X " + v + "Vector.Y " + v + "Vector.Z " + v +
                                        "Vector.W");
  EXPECT_EQ(found[0].convention, "cycles");
  EXPECT_EQ(found[0].layer, "ViewLayer");
  EXPECT_EQ(found[0].background_depth, 1e10);
  EXPECT_FALSE(notes_mention(found[0], "--layer"));
}

TEST(RealFiles, Layers) {
  const std::vector<FileHeader> files = real("/layers/jit/frame.0001.exr");
  NEED(files);
  ASSERT_EQ(find(files).size(), 1u);
  EXPECT_EQ(find(files)[0].layer, "beauty");
  EXPECT_TRUE(notes_mention(find(files)[0], "fg"));
  RoleRequest request;
  request.layers = {"all"};
  const std::vector<Subject> all = find(files, request);
  ASSERT_EQ(all.size(), 4u);
  for (const Subject& subject : all) {
    EXPECT_EQ(name_of_ref(files, subject.color[0]), subject.layer + ".Combined.R");
    EXPECT_EQ(name_of_ref(files, subject.depth), subject.layer + ".Depth.Z");
    EXPECT_EQ(name_of_ref(files, (*subject.backward)[1]), subject.layer + ".Vector.Y");
    EXPECT_EQ(name_of_ref(files, (*subject.forward)[1]), subject.layer + ".Vector.W");
  }
  request.layers = {"mid", "bg"};
  EXPECT_EQ(find(files, request)[1].layer, "bg");
}

TEST(RealFiles, Samples) {
  const std::vector<FileHeader> files = real("/samples4/jit/frame.0005.exr");
  NEED(files);
  EXPECT_NE(message_of([&] { find(files); }).find("velocity.x"), std::string::npos);
  RoleRequest request;
  request.convention = "varve";
  const Subject first = find(files, request)[0];
  EXPECT_EQ(roles(files, first),
            "sample.0:R sample.0:G sample.0:B sample.0:A | sample.0:Z | sample.0:velocity.x sample.0:velocity.y -");
  EXPECT_TRUE(notes_mention(first, "first part"));
  request.layers = {"sample.2"};
  EXPECT_EQ(name_of_ref(files, find(files, request)[0].depth), "sample.2:Z");
  EXPECT_EQ((*find(files, request)[0].backward)[0].part, 2);
}

TEST(RealFiles, Beachball) {
  const std::vector<FileHeader> files = real("/beachball/singlepart.0001.exr");
  NEED(files);
  const std::vector<Subject> found = find(files);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(roles(files, found[0]), "R G B A | Z | - forward.right.u forward.right.v");
  EXPECT_EQ(roles(files, found[1]), "left.R left.G left.B left.A | left.Z | - forward.left.u forward.left.v");
  EXPECT_EQ(found[0].view, "right");
  EXPECT_EQ(found[1].view, "left");
  EXPECT_EQ(found[1].layer, "");
  EXPECT_TRUE(found[0].default_view && !found[1].default_view);
  for (const Subject& subject : found) EXPECT_EQ(subject.convention, "nuke");
}

TEST(RealFiles, Extremes) {
  const std::vector<FileHeader> rings = real("/extremes/BrightRingsNanInf.exr"),
                                green = real("/extremes/WideFloatRange.exr");
  NEED(rings);
  EXPECT_EQ(roles(rings, find(rings)[0]), "R G B - | - | - -");
  EXPECT_EQ(roles(green, find(green)[0]), "- G - - | - | - -");
}

TEST(RealFiles, Deep) {
  const std::vector<FileHeader> files = real("/deep/Balls.exr");
  NEED(files);
  EXPECT_EQ(roles(files, find(files)[0]), "R G B A | Z | - -");
}

}  // namespace
}  // namespace varve
