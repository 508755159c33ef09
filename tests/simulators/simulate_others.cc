// simulate-others: recordings of people of models other than pushid's, with their truth.
//
//   simulate-others --laboratory=4 --out=lab   laboratory.h: two links, steps, force platforms
//   simulate-others --clips=4 --out=clips      synthetic_clips.h: clips of a stick figure
//   simulate-others --turns=16 --out=turns     synthetic_clips.h: people who talk in turns
//
// Existing files in the folder are replaced.
#include <gflags/gflags.h>

#include <cstdio>

#include "tests/simulators/laboratory.h"
#include "tests/simulators/synthetic_clips.h"

DEFINE_int32(laboratory, 0, "people of a laboratory");
DEFINE_int32(clips, 0, "clips of each of four actions; one more of each is kept apart below test/");
DEFINE_int32(turns, 0, "recordings of three people who talk in turns");
DEFINE_int32(frames, 0, "frames of each clip or recording; 0: 600 of clips, 300 of turns");
DEFINE_uint64(seed, 1, "seed of people, motion and noise");
DEFINE_string(out, "", "folder to write");

namespace {

using namespace pushid;

MaybeError Write() {
  if (FLAGS_laboratory > 0) {
    LaboratoryOptions options;
    options.people = FLAGS_laboratory;
    options.seed = FLAGS_seed;
    return WriteLaboratoryStudy(FLAGS_out, options);
  }
  if (FLAGS_clips > 0) {
    SyntheticClipOptions options;
    options.clips = FLAGS_clips;
    if (FLAGS_frames > 0) options.frames = FLAGS_frames;
    options.seed = FLAGS_seed;
    return WriteSyntheticClips(FLAGS_out, options);
  }
  SyntheticTurnsOptions options;
  options.recordings = FLAGS_turns;
  if (FLAGS_frames > 0) options.frames = FLAGS_frames;
  options.seed = FLAGS_seed;
  return WriteSyntheticTurns(FLAGS_out, options);
}

}  // namespace

int main(int argc, char** argv) {
  gflags::ParseCommandLineFlags(&argc, &argv, true);
  if (FLAGS_out.empty() || FLAGS_laboratory + FLAGS_clips + FLAGS_turns <= 0) {
    std::fprintf(stderr, "simulate-others --laboratory|clips|turns=COUNT --out=FOLDER\n");
    return 1;
  }
  const MaybeError failed = Write();
  if (failed) std::fprintf(stderr, "simulate-others: %s\n", failed->ToString().c_str());
  return failed ? 1 : 0;
}
