// The table of commands, and the way from a command line to one of them.
#include "commands.h"

#include <cstdio>

#include "base/error.h"
#include "help.h"
#include "option.h"
#include "synth/scenes.h"

namespace varve::cli {
namespace {

Value<Settings> input_pattern() {
  return {[](Settings& s, std::string_view text) {
            s.job.input.color = SequencePattern::parse(text);
            return true;
          },
          nullptr,
          "the files to read, such as shot.####.exr",
          {}};
}

template <class At>
Value<Settings> side_pattern(At at, const char* allowed) {
  return {[at](Settings& s, std::string_view text) {
            at(s) = SequencePattern::parse(text);
            return true;
          },
          nullptr,
          allowed,
          {}};
}

Value<Settings> scene_name() {
  Value<Settings> value{[](Settings& s, std::string_view text) {
                          s.synth.scene = text;
                          return !text.empty();
                        },
                        nullptr,
                        "a scene; `varve help scenes` lists them",
                        {}};
  for (const synth::SceneRow& row : synth::scene_table())
    value.choices.push_back({std::string(row.name), std::string(row.provokes)});
  return value;
}

Value<Settings> pattern_name() {
  Value<Settings> value{[](Settings& s, std::string_view text) {
                          s.jitter.pattern = text;
                          return !text.empty();
                        },
                        nullptr,
                        "a pattern such as helix4 or halton23:16; `varve help patterns` lists them",
                        {}};
  for (const JitterPattern& row : jitter_patterns())
    value.choices.push_back({std::string(row.name), std::string(row.meaning)});
  return value;
}

Value<Settings> help_topic() {
  return {[](Settings& s, std::string_view text) {
            s.topic = text;
            return !text.empty();
          },
          nullptr,
          "a command or a topic",
          {}};
}

}  // namespace

std::vector<Command> command_table() {
  return {
      {"resolve",
       kResolve,
       "IN",
       "resolve a rendered sequence over time",
       "Reads the frames of IN one after the other, brings the result of the frames before along the motion vectors, "
       "holds it to what the present frame allows, and blends both. Every requested frame is written.\n"
       "Channels are found by their names; `varve probe` shows which are found and what is assumed. Channels that are "
       "not resolved, attributes, views, and data windows are kept. Files appear under their names only when they are "
       "complete.",
       input_pattern(),
       run_resolve,
       true,
       {{"varve resolve shot.####.exr -o out/shot.####.exr", "All frames on disk with the default preset."},
        {"varve resolve shot.####.exr -o out/shot.####.exr -f 101-150 --preroll 20 --resume",
         "One chunk of a farm job: 20 frames warm the history up, finished frames are skipped."},
        {"varve resolve shot.####.exr -o out/shot.####.exr -f 101-150 --state-in 100.state --state-out 150.state",
         "A chunk that goes on exactly from the one before, and leaves what the next one needs."},
        {"varve resolve shot.####.exr -o out/shot.####.exr --convention nuke --gamma 1.5 --aov count,clip",
         "Vectors as Nuke writes them, a wider box, two diagnostic planes beside the color."},
        {"varve resolve shot.####.exr -o out/shot.####.exr --rerender list.json --rerender-budget 0.5",
         "And a list of what to render again: half a sample for each pixel, where it gains most."},
        {"varve resolve shot.####.exr -o out/shot.####.exr --extra 'extra/extra.*.####.exr'",
         "With what was rendered."}}},
      {"probe",
       kProbe,
       "IN",
       "show what a sequence holds and how it would be resolved",
       "Reads the headers of IN and prints frames, gaps, parts, windows, the channels with their roles, the motion "
       "convention, jitter and cameras, and the plan: each pass with the reason why it runs or not, memory and time.",
       input_pattern(),
       run_probe,
       true,
       {{"varve probe shot.####.exr", "Headers only; quick."},
        {"varve probe shot.####.exr --pixels 3 --json", "With the ranges of three frames, for a script."}}},
      {"compare",
       kCompare,
       "A B",
       "measure how one sequence differs from another",
       "Compares what both sequences have, A being the reference: first frames, windows and channels, then what is not "
       "finite, then figures for each frame and over time. Colors are found by their names, which need not be the "
       "same; "
       "a NaN against a number is a difference.\n"
       "Without limits any difference gives exit code 1. With --fail it takes a figure beyond its limit, a frame or "
       "channel that one side lacks, or a value that is not finite. Figures are explained by `varve help metrics`.",
       side_pattern(
           [](auto& s) -> auto& { return s.compare.a; }, "the reference, such as ref.####.exr"),
       run_compare,
       true,
       {{"varve compare old.####.exr new.####.exr", "Are they the same, value by value?"},
        {"varve compare ref.####.exr out.####.exr --fail psnr=30 --fail flip=0.1 --html report.html",
         "Good enough? With a page that shows where not."},
        {"varve compare ref.####.exr out.####.exr --metrics fast --json -", "Figures for a script, quickly."}},
       side_pattern(
           [](auto& s) -> auto& { return s.compare.b; }, "the sequence to judge, such as out.####.exr")},
      {"measure",
       kMeasure,
       "IN",
       "show what accuracy costs on a sequence",
       "Runs `varve resolve` on IN with presets and swept parameters, several times in turns, and prints what each "
       "setting costs (whole runs of the program: time per frame, peak memory, and the ratio to reading and writing "
       "alone) and how right it is. Settings that no other one beats in both are marked; the last lines are the "
       "cheapest setting close to the best, as a command line to copy.\n"
       "With --reference the scores are those of `varve compare`. Without it each resolved frame is brought along "
       "the motion and held against the samples of the next one, which had no part in it. The noise of the samples is "
       "in that score, so it ranks settings and does not "
       "tell how wrong they are.\n"
       "The time to read and write alone is that of `varve floor`, which copies IN, decoded and encoded again, without "
       "resolving anything.",
       input_pattern(),
       run_measure,
       true,
       {{"varve measure shot.####.exr --sweep gamma=0.75,1,1.5 --sweep alpha=0.05,0.1",
         "Which of six settings is worth its time on this shot?"},
        {"varve measure shot.####.exr --reference ref.####.exr --setting 'box=none' --csv trade.csv --plot trade.svg",
         "Against a reference, with a table and a plot."}}},
      {"floor", kFloor, "IN", "copy a sequence as a resolve reads and writes it, for measure",
       "Reads the frames of IN and writes them with the same channels and compression, decoded and encoded again, and "
       "resolves nothing: the least time that any resolve can take.",
       input_pattern(), run_floor},
      {"synth",
       kSynth,
       "SCENE",
       "write a sequence whose truth is known",
       "Renders an analytic scene as a jittered sequence DIR/SCENE.####.exr with color, alpha, depth Z, motion "
       "(velocity "
       "to the previous frame and forward to the next, pixels, y down, without the jitter), ids, jitter, and camera "
       "matrices, and DIR/jitter.csv. Depth, motion, and ids are exact where a scene does not say otherwise. `varve "
       "resolve` and `varve probe` read the result as it is: the attribute varve:motion names the convention.\n"
       "On demand the truth of the same frames goes to DIR/truth, and renders with n x n stratified samples, as "
       "yardsticks, to DIR/ssN.\n"
       "The same command writes the same bytes, with any number of threads.",
       scene_name(),
       run_synth,
       true,
       {{"varve synth quality-all -o all --truth box --yardsticks 2,4", "48 frames, their truth, and two yardsticks."},
        {"varve synth panes -o panes --layers", "Each layer beside the composite."},
        {"varve synth fence -o fence --samples 4 --size 640x360",
         "Four parts with jitters of their own in each file."}}},
      {"jitter",
       kJitter,
       "PATTERN",
       "list where in its pixel each frame is to be sampled",
       "Prints the sample positions of a pattern, one for each frame, for a renderer to use and for `varve resolve "
       "--jitter FILE` to read back. PATTERN may have a length behind a colon, after which it repeats.\n"
       "The numbers are sample position minus pixel center, in pixels, x right, y down. Renderers want other signs, "
       "axes "
       "and units: --convention lists those. The motion vectors of the renderer must not contain the jitter.\n"
       "The mean of a pattern, its centroid, shifts the resolved picture; the comment lines tell it and --centered "
       "takes "
       "it out.",
       pattern_name(),
       run_jitter,
       true,
       {{"varve jitter halton23:16 --count 100 -o jitter.csv", "Positions of frames 1-100; read back as they are."},
        {"varve jitter halton23 --count 16 --convention cycles --size 1920x1080 --format json",
         "The camera shifts that make Blender sample there."}}},
      {"help", kHelp, "[TOPIC]", "explain a command or a topic",
       "TOPIC is a command, or one of " + topic_names() + ". Without it the program itself is explained.", help_topic(),
       run_help},
      {"version",
       kVersion,
       "",
       "print the version",
       "Prints the name and the version of the program.",
       {},
       run_version},
  };
}

int run(std::span<const std::string> arguments) {
  const std::vector<Command> commands = command_table();
  if (arguments.empty()) {
    std::fputs(usage_text().c_str(), stderr);
    return int(ExitCode::usage);
  }
  Settings none;
  const std::string& first = arguments[0];
  if (first == "-h" || first == "--help" || first == "--help=all") return run_help(none);
  if (first == "--version") return run_version(none);
  const Command* command = find_command(commands, first);
  if (!command) {
    std::vector<std::string> names;
    for (const Command& known : commands) names.emplace_back(known.name);
    const std::string nearest = nearest_word(first, names);
    throw Failure(ExitCode::usage,
                  (first.starts_with('-') ? "a command comes first, and " + first + " is none"
                                          : "there is no command \"" + first + "\"") +
                      (nearest.empty() ? "; `varve help` lists what there is" : "; did you mean " + nearest + "?"));
  }
  const std::vector<Option> options = options_of(command->bit);
  Parsed parsed = parse(*command, options, arguments.subspan(1));
  if (parsed.help) {
    std::fputs(command_text(*command, options, parsed.help_all).c_str(), stdout);
    return int(ExitCode::done);
  }
  return command->run(parsed.settings);
}

int run_version(Settings&) {
  std::printf("varve %s\n", version());
  return int(ExitCode::done);
}

void finish_job(Settings& settings) {
  for (const auto& files : {settings.depth_files, settings.motion_files})
    if (files) settings.job.input.roles.push_back(*files);
  OutputRequest& request = settings.job.request;
  request.diagnostics_apart = settings.job.diagnostics.has_value();
  if (request.diagnostics_apart && request.aovs.empty()) request.aovs = {"all"};
}

}  // namespace varve::cli
