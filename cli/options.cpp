// THE table of options. Names, ranges and texts of the parameters come from knobs().
#include "compare_options.h"
#include "farm_options.h"
#include "jitter_options.h"
#include "layer_options.h"
#include "measure_options.h"
#include "option_values.h"
#include "rerender_options.h"
#include "synth_options.h"

namespace varve::cli {
namespace {

constexpr unsigned kInput = kResolve | kProbe | kMeasure | kFloor, kEach = kInput | kCompare;

constexpr Word<ChannelWeights> kChannelWeights[] = {
    {"beauty", ChannelWeights::beauty, "those of the color: lights that add up to it still do"},
    {"own", ChannelWeights::own, "its own neighborhood decides, as if it were the color; motion and depth are shared"},
};
constexpr Word<bool> kKeeps[] = {
    {"all", true, "other channels and parts pass through, bit for bit"},
    {"none", false, "only what was resolved is written"},
};
constexpr Word<bool> kFindCuts[] = {
    {"on", true, "history starts anew where a frame does not follow from the one before"},
    {"off", false, "only --cuts and gaps in the frame numbers count"},
};
constexpr Word<bool> kChecksMotion[] = {
    {"on", true, "vectors that lead astray more often than no motion stop the run, with the reading that fits"},
    {"off", false, "vectors are believed"},
};
constexpr Word<std::optional<Compression>> kCompressions[] = {
    {"keep", std::nullopt, "as the input; ZIP where that is lossy"},
    {"none", Compression::none, "largest and fastest"},
    {"rle", Compression::rle, "lossless, run lengths"},
    {"zips", Compression::zips, "lossless, deflate by single lines"},
    {"zip", Compression::zip, "lossless, deflate by 16 lines"},
    {"piz", Compression::piz, "lossless wavelet, good with noise"},
    {"pxr24", Compression::pxr24, "lossy for 32-bit floats, which keep 24 bits"},
    {"b44", Compression::b44, "lossy, fixed rate"},
    {"b44a", Compression::b44a, "lossy, smaller in flat areas"},
    {"dwaa", Compression::dwaa, "lossy, by 32 lines"},
    {"dwab", Compression::dwab, "lossy, by 256 lines"},
};
constexpr Word<ProgressStyle> kProgressStyles[] = {
    {"auto", ProgressStyle::automatic, "bar on a terminal, plain otherwise"},
    {"bar", ProgressStyle::bar, "one line that is drawn again, with the time left"},
    {"plain", ProgressStyle::plain, "one line for each frame, with PROGRESS: nn%"},
    {"openjd", ProgressStyle::openjd, "openjd_progress and openjd_status lines"},
    {"json", ProgressStyle::json, "one JSON object on a line for each event"},
    {"none", ProgressStyle::none, "warnings only"},
};
constexpr Word<MotionUnit> kUnits[] = {
    {"pixel", MotionUnit::pixel, "pixels"},
    {"unit", MotionUnit::unit, "fractions of the display window"},
    {"ndc", MotionUnit::ndc, "-1 to 1 across the display window"},
};
constexpr Word<MotionDirection> kDirections[] = {
    {"previous", MotionDirection::previous, "vectors lead to the previous frame"},
    {"next", MotionDirection::next, "vectors lead to the next frame"},
};
constexpr Word<double> kSigns[] = {
    {"1", 1.0, "as stored"},
    {"-1", -1.0, "turned round"},
};
constexpr Word<std::string_view> kShells[] = {{"bash", "bash", "source it, or install it as completions/varve"}};

constexpr auto kBasic = Tier::basic, kAdvanced = Tier::advanced, kExpert = Tier::expert;

void add_file_options(std::vector<Option>& rows) {
  const std::string group = "Input and output";
  const auto add = [&rows](Option option) -> Option& { return rows.emplace_back(std::move(option)); };
  add({"output", 'o', "PATTERN", kResolve | kFloor, kBasic, group, "Files to write, never the input itself. Required.",
       pattern([](auto& s) -> auto& { return s.job.output; })})
      .completes = Completes::files;
  add({"frames", 'f', "LIST", kEach, kBasic, group,
       "Frames to work on; without it all files that match. Negative frames are written as in -10--5.",
       frames([](auto& s) -> auto& { return s.job.frames; })});
  add({"cuts", 0, "LIST", kEach & ~kProbe, kBasic, group, "First frames of new shots; history does not cross them.",
       frames([](auto& s) -> auto& { return s.job.cuts; })});
  add({"find-cuts", 0, "WORD", kResolve, kAdvanced, group,
       "Whether cuts are looked for in the pixels of the main layer, too, and told with the evidence: every frame is "
       "read once more, before the work begins. Moves of the camera, changes of light, and flashes of one or two "
       "frames "
       "are none.",
       word(
           [](auto& s) -> auto& { return s.job.find_cuts; }, kFindCuts)});
  add({"keep", 0, "WHICH", kResolve, kAdvanced, group, "What happens to channels that are not resolved.",
       word(
           [](auto& s) -> auto& { return s.job.request.keep_channels; }, kKeeps)});
  add({"compression", 0, "METHOD", kResolve, kAdvanced, group, "Compression of the files written.",
       word(
           [](auto& s) -> auto& { return s.job.compression; }, kCompressions)});
  add({"zip-level", 0, "LEVEL", kResolve, kExpert, group,
       "Effort of ZIP and ZIPS. 1 is fastest, 9 makes the smallest files.",
       number([](auto& s) -> auto& { return s.job.zip_level; }, {1, 9})});
}

void add_channel_options(std::vector<Option>& rows) {
  const std::string group = "Channels";
  const auto add = [&rows](Option option) -> Option& { return rows.emplace_back(std::move(option)); };
  add({"layer", 'l', "LIST", kEach, kBasic, group,
       "Layers to work on; without it the main layer of each view. Deep parts are resolved where this names one, or "
       "where "
       "no color is flat; else they are copied.",
       list(
           [](Settings& s, const std::string& layer) {
             s.job.roles.layers.push_back(layer);
             return true;
           },
           "all, or names of layers with commas between")})
      .repeats = true;
  add({"channels", 0, "LIST", kResolve | kProbe, kAdvanced, group,
       "Further layers and channels to resolve, such as lights, reflections, occlusion and shadows. Names by their end "
       "will do; * stands for any characters and ? for one. Vectors, depths, normals and ids are never averaged.",
       list(
           [](Settings& s, const std::string& name) {
             s.job.roles.channels.push_back(name);
             return true;
           },
           "names of layers or channels with commas between")})
      .repeats = true;
  add({"channel-weights", 0, "WHICH", kResolve | kProbe, kAdvanced, group, "By which weights --channels are resolved.",
       word(
           [](auto& s) -> auto& { return s.job.roles.channel_weights; }, kChannelWeights)});
  add({"samples", 0, "HOW", kResolve | kProbe, kBasic, group,
       "What is done with several samples in each pixel: numbered parts or layers such as sample.0 and sample.1, or s0 "
       "and s1, or a picture of N x N times the pixels. They become one color.",
       samples_value()});
  add({"map", 0, "ROLE=CHANNEL", kInput, kAdvanced, group,
       "Name the channel of a role, where its name does not tell. motion leads to the previous frame, forward to the "
       "next.",
       map_value()})
      .repeats = true;
  add({"depth-file", 0, "PATTERN", kInput, kAdvanced, group, "Files with the depth, where it is not in IN.",
       pattern([](auto& s) -> auto& { return s.depth_files; })})
      .completes = Completes::files;
  add({"motion-file", 0, "PATTERN", kEach, kAdvanced, group,
       "Files with the motion vectors, where they are not beside the color.",
       pattern([](auto& s) -> auto& { return s.motion_files; })})
      .completes = Completes::files;
  add({"jitter", 0, "SOURCE", kInput, kAdvanced, group,
       "Where in its pixel each frame was sampled. auto reads the header; pixels measures it, between all frames on "
       "disk, at rest or along the vectors, and stops where they do not tell; a CSV file has the columns frame,jx,jy, "
       "sample position minus pixel center in pixels, y down, as `varve jitter` writes it; patterns are those of "
       "`varve "
       "help patterns`, with a seed of 0 and a direction of 0. With --samples the columns are frame,sample,jx,jy.",
       text(
           [](auto& s) -> auto& { return s.job.jitter; },
           "auto, none, pixels, a CSV file or a pattern such as halton23:16")})
      .completes = Completes::files;
  add({"assume-jitter", 0, "PATTERN", kInput, kExpert, group,
       "The pattern that the renderer is taken to have used where --jitter auto finds nothing; see `varve help "
       "patterns`.",
       assumed_jitter()});
  add({"camera", 0, "SOURCE", kInput, kAdvanced, group,
       "Where the camera of each frame is told. auto reads worldToCamera and worldToNDC, or view and proj in the JSON "
       "of Cycles' Note. A CSV file has the columns frame, v0 to v15 (world to camera, row major, looking along -z, y "
       "up) and either p0 to p15 (camera to clip space, as OpenGL has it) or focal and aperture (width of the film, "
       "same unit); JSON is a list of objects with frame, view and proj or focal and aperture.",
       text(
           [](auto& s) -> auto& { return s.job.camera; }, "auto, off, or a CSV or JSON file")})
      .completes = Completes::files;
}

void add_motion_options(std::vector<Option>& rows) {
  const std::string group = "Motion and depth";
  const auto add = [&rows, group](const char* name, const char* metavar, const char* help, Value<Settings> value) {
    rows.push_back({name, 0, metavar, kEach, kExpert, group, help, std::move(value)});
  };
  add("convention", "NAME", "How the renderer wrote its motion vectors; see `varve help conventions`.",
      convention_value());
  rows.back().tier = kBasic;
  rows.back().topic = "conventions";
  add("motion-bias", "VALUE",
      "Subtracted from the stored vector before anything else. Without it as the convention says.",
      overriding(
          number([](auto& s) -> auto& { return s.job.roles.encoding.bias; }, {-1e9, 1e9}),
          [](auto& s) -> auto& { return s.job.roles.override_bias; }));
  add("motion-scale", "FACTOR", "Multiplies the stored vector. Without it as the convention says.",
      overriding(
          number([](auto& s) -> auto& { return s.job.roles.encoding.scale; }, {0, 1e9, true}),
          [](auto& s) -> auto& { return s.job.roles.override_scale; }));
  add("motion-sign-x", "SIGN", "Whether the stored x axis points right. Without it as the convention says.",
      overriding(
          word(
              [](auto& s) -> auto& { return s.job.roles.encoding.sign_x; }, kSigns),
          [](auto& s) -> auto& { return s.job.roles.override_sign_x; }));
  add("motion-sign-y", "SIGN", "Whether the stored y axis points down. Without it as the convention says.",
      overriding(
          word(
              [](auto& s) -> auto& { return s.job.roles.encoding.sign_y; }, kSigns),
          [](auto& s) -> auto& { return s.job.roles.override_sign_y; }));
  add("motion-unit", "UNIT", "Unit of the stored vector. Without it as the convention says.",
      overriding(
          word(
              [](auto& s) -> auto& { return s.job.roles.encoding.unit; }, kUnits),
          [](auto& s) -> auto& { return s.job.roles.override_unit; }));
  add("motion-direction", "WHICH", "Where the vectors lead. Without it as the convention says.",
      overriding(
          word(
              [](auto& s) -> auto& { return s.job.roles.encoding.direction; }, kDirections),
          [](auto& s) -> auto& { return s.job.roles.override_direction; }));
  add("shutter", "FRAMES",
      "Part of a frame that the stored vectors span; they are divided by it. 1 spans the whole frame. Without it as "
      "the "
      "convention says.",
      overriding(
          number([](auto& s) -> auto& { return s.job.roles.encoding.shutter; }, {0, 1000, true}),
          [](auto& s) -> auto& { return s.job.roles.override_shutter; }));
  rows.push_back({"check-motion", 0, "WORD", kResolve, kAdvanced, group,
                  "Whether the vectors of a few frames are held against the pixels before the work starts.",
                  word(
                      [](auto& s) -> auto& { return s.job.check_motion; }, kChecksMotion)});
}

void add_parameter_options(std::vector<Option>& rows) {
  rows.push_back({"preset", 'p', "NAME", kResolve, kBasic, "History",
                  "Set of parameters to start from; options given by name override it. See `varve help presets`.",
                  preset_value()});
  rows.back().first = true;
  rows.back().topic = "presets";
  for (const Knob& knob : knobs()) {
    // What says how to read the input matters to probe as well.
    const unsigned commands = knob.name == "depth-kind"      ? kInput
                              : knob.name == "camera-motion" ? kResolve | kProbe
                                                             : unsigned(kResolve);
    rows.push_back({std::string(knob.name), 0, std::string(knob.metavar), commands, knob.tier, std::string(knob.group),
                    std::string(knob.meaning), knob_value(knob)});
  }
}

void add_diagnostic_options(std::vector<Option>& rows) {
  const std::string group = "Diagnostics";
  const auto add = [&rows](Option option) -> Option& { return rows.emplace_back(std::move(option)); };
  add({"aov", 0, "LIST", kResolve, kBasic, group, "Diagnostic planes to write into the output; see `varve help aovs`.",
       aovs_value()})
      .repeats = true;
  rows.back().topic = "aovs";
  add({"diagnostics", 0, "PATTERN", kResolve, kBasic, group,
       "Write the diagnostic planes to these files instead of into the output; all of them without --aov.",
       pattern([](auto& s) -> auto& { return s.job.diagnostics; })})
      .completes = Completes::files;
  add({"preview", 0, "FOLDER", kResolve, kAdvanced, group,
       "Write PNG pictures of the color and of the diagnostic planes.",
       text(
           [](auto& s) -> auto& { return s.job.preview_folder; }, "a folder")})
      .completes = Completes::folders;
  add({"spill", 0, "FOLDER", kResolve, kAdvanced, group,
       "With --accumulator two-sided: keep what the future says of a block in a file in this folder instead of in "
       "memory. The file has no name and is gone when the program ends, however it ends.",
       text(
           [](auto& s) -> auto& { return s.job.request.spill_folder; }, "a folder")})
      .completes = Completes::folders;
  add({"report", 0, "FILE", kResolve, kAdvanced, group,
       "Write a JSON file when the run ends, however it ends: the plan, warnings, and one row for each frame with "
       "times in "
       "seconds and counts of pixels; see `varve help report`.",
       text(
           [](auto& s) -> auto& { return s.job.report; }, "a file name")})
      .completes = Completes::files;
}

void add_color_options(std::vector<Option>& rows) {
  const std::string group = "Color";
  const auto add = [&rows, group](const char* name, const char* metavar, Tier tier, const char* help,
                                  Value<Settings> value) {
    rows.push_back({name, 0, metavar, kResolve, tier, group, help, std::move(value)});
  };
  add("ocio", "CONFIG", kAdvanced, "OpenColorIO config. Without it the one that $OCIO names.",
      text(
          [](auto& s) -> auto& { return s.job.ocio_config; }, "the path of an OpenColorIO config"));
  rows.back().completes = Completes::files;
  add("from-space", "SPACE", kAdvanced,
      "Color space of the input; the resolve works in the scene_linear role of the config.",
      text(
          [](auto& s) -> auto& { return s.job.from_space; }, "a color space of the config"));
  add("to-space", "SPACE", kAdvanced, "Color space of the output.",
      text(
          [](auto& s) -> auto& { return s.job.to_space; }, "a color space of the config"));
  add("display", "NAME", kExpert, "Display of the pictures of --preview. Without it the config's default.",
      text(
          [](auto& s) -> auto& { return s.job.display; }, "a display of the config"));
  add("view", "NAME", kExpert, "View of that display. Without it the display's default.",
      text(
          [](auto& s) -> auto& { return s.job.view; }, "a view of the config"));
}

void add_run_options(std::vector<Option>& rows) {
  const std::string group = "Running";
  const auto add = [&rows](Option option) -> Option& { return rows.emplace_back(std::move(option)); };
  add({"pixels", 0, "FRAMES", kProbe, kBasic, group,
       "Read the pixels of this many frames, spread over the sequence, and print the range of each channel. 0 reads "
       "headers only.",
       number([](auto& s) -> auto& { return s.pixels; }, {0, 1000000})});
  add({"check-jitter", 0, "FRAMES", kProbe, kBasic, group,
       "Measure where in its pixel each of this many frames was sampled, from their pixels, and hold it against the "
       "jitter that is stated: scale, signs, axes, one frame early or late, no jitter at all, a seed that stays. 0 "
       "looks at none.",
       number([](auto& s) -> auto& { return s.jitter_frames; }, {0, 1000000})});
  add({"facts", 0, "", kProbe, kBasic, group,
       "Read the pixels of all frames and tell what happens besides motion, with the evidence: cuts, flashes, frames "
       "that are held or doubled, steps of the exposure, missing frames.",
       flag([](auto& s) -> auto& { return s.facts; })});
  add({"motion", 0, "", kProbe, kBasic, group,
       "Hold the motion vectors against the pixels of frames spread over the sequence: which reading of them agrees "
       "(direction, axes, unit, bias, scale, jitter), what speaks for it, and what is wrong with them.",
       flag([](auto& s) -> auto& { return s.motion; })});
  add({"vectors", 0, "PAIRS", kProbe, kBasic, group,
       "Test the vectors of this many pairs of neighboring frames against the pixels, object by object: which have "
       "none, "
       "or wrong ones, and how far off they are. Objects are told by ids, with names where a Cryptomatte manifest has "
       "them. `varve resolve --repair-motion on` repairs what is wrong.",
       number([](auto& s) -> auto& { return s.vectors; }, {0, 1000000})});
  add({"json", 0, "", kProbe, kBasic, group, "Print JSON.", flag([](auto& s) -> auto& { return s.json; })});
  add({"dry-run", 'n', "", kResolve, kBasic, group, "Check the input, print the plan and write nothing.",
       flag([](auto& s) -> auto& { return s.dry_run; })});
  add({"threads", 'j', "COUNT", kEach | kSynth, kAdvanced, group,
       "Threads to use; 0 takes every processor. The output is the same for any count.",
       number([](auto& s) -> auto& { return s.job.threads; }, {0, 1024})});
  add({"progress", 0, "STYLE", kResolve, kBasic, group, "How progress is told, on standard error.",
       word(
           [](auto& s) -> auto& { return s.progress; }, kProgressStyles)});
  add({"quiet", 'q', "", kResolve | kSynth | kMeasure, kBasic, group, "No progress, no warnings, no summary.",
       flag([](auto& s) -> auto& { return s.quiet; })});
  add({"verbose", 'v', "", kResolve, kBasic, group, "Print the plan before the work starts.",
       flag([](auto& s) -> auto& { return s.verbose; })});
}

void add_help_options(std::vector<Option>& rows) {
  const std::string group = "Help";
  rows.push_back({"all", 0, "", kHelp, kBasic, group, "Show all options of a command, the rare ones too.",
                  flag([](auto& s) -> auto& { return s.all; })});
  rows.push_back({"man", 0, "", kHelp, kBasic, group,
                  "Print the manual page as roff; without a topic the one of varve.",
                  flag([](auto& s) -> auto& { return s.man; })});
  rows.push_back({"completion", 0, "SHELL", kHelp, kBasic, group, "Print a completion script.",
                  word(
                      [](auto& s) -> auto& { return s.completion; }, kShells)});
}

}  // namespace

std::vector<Option> option_table() {
  std::vector<Option> rows;
  add_file_options(rows);
  add_farm_options(rows);
  add_synth_options(rows);
  add_jitter_options(rows);
  add_channel_options(rows);
  add_layer_options(rows);
  add_parameter_options(rows);
  add_motion_options(rows);
  add_diagnostic_options(rows);
  add_rerender_options(rows);
  add_color_options(rows);
  add_compare_options(rows);
  add_measure_options(rows);
  add_run_options(rows);
  add_help_options(rows);
  return rows;
}

}  // namespace varve::cli
