// apps: pushid-simulate by flag.
#include "apps/flags/simulate_flags.h"

#include <gflags/gflags.h>

#include "apps/flags/command_line.h"
#include "apps/flags/formation_flags.h"
#include "apps/flags/overwrite_flag.h"
#include "datasets/manifest/recording.h"
#include "ident/parameters/option_names.h"

DEFINE_string(out, "", "folder to write: manifest.json, bvh/ and push/");
DEFINE_int32(people, pushid::SyntheticOptions{}.subjects,
             "number of people: of random mass and size, or in the formation");
DEFINE_int32(recordings_per_person, pushid::SyntheticOptions{}.recordings_per_subject,
             "pushes per person: weak, medium and strong in turn");
DEFINE_int32(frames, pushid::SyntheticOptions{}.frames, "frames of each recording");
DEFINE_double(fps, pushid::SyntheticOptions{}.fps, "frames per second");
// The library's recordings are exact; a user's trial should be as noisy as real ones.
DEFINE_double(noise, 0.002, "standard deviation of the joints' positions, m");
DEFINE_string(push_kind, pushid::Name(pushid::SyntheticOptions{}.push_kind),
              "net (only the push's first part, the tail follows) or external");
DEFINE_string(truth_stance, pushid::NameOf(pushid::SyntheticOptions{}.model.stance),
              "without --model: behaviour of the synthetic people's feet: slide, or threshold "
              "(hold, then step)");
DEFINE_string(
    truth_noise, pushid::NameOf(pushid::SyntheticOptions{}.model.process_noise),
    "without --model: process noise of the synthetic people: none, diagonal or full; with speed "
    "and push, comma-separated, as --process_noise of pushid-fit (--set=sigma_x=...)");
DEFINE_double(recording_spread, pushid::SyntheticOptions{}.recording_spread,
              "variation of all parameters between recordings (standard deviation of the "
              "logarithm; 0.1 is about 10 %)");
DEFINE_double(subject_spread, pushid::SyntheticOptions{}.subject_spread,
              "variation of all parameters between people, as in --recording_spread");
DEFINE_uint64(seed, pushid::SyntheticOptions{}.seed, "seed of people, pushes and noise");

namespace pushid {
namespace {

// The library checks them too, but knows no flags.
MaybeError CheckRecordingNumbers() {
  for (MaybeError error :
       {CheckRange("people", FLAGS_people, 1, 10000),
        CheckRange("recordings_per_person", FLAGS_recordings_per_person, 1, 10000),
        CheckRange("frames", FLAGS_frames, 3, 100000), CheckRange("fps", FLAGS_fps, 10, 10000),
        CheckRange("noise", FLAGS_noise, 0, 0.1),
        CheckRange("recording_spread", FLAGS_recording_spread, 0, 2),
        CheckRange("subject_spread", FLAGS_subject_spread, 0, 2)}) {
    if (error) return error;
  }
  return std::nullopt;
}

}  // namespace

Result<SimulateFlags> SimulateFlagsFromCommandLine() {
  if (const char* flag = GivenFormationFlag()) {
    return Error{std::string("--") + flag + " needs --formation: line, diamond or grid"};
  }
  for (const char* flag : {"samples", "samples_seed", "samples_out"}) {
    if (Given(flag)) return Error{std::string("--") + flag + " needs --formation"};
  }
  for (MaybeError error : {Require("out", FLAGS_out, "name the folder to write"),
                           CheckOutputFolder("out", FLAGS_out), CheckRecordingNumbers()}) {
    if (error) return *error;
  }
  const std::optional<PushKind> kind = PushKindFromName(FLAGS_push_kind);
  if (!kind || *kind == PushKind::kNetWithoutFriction) {
    return Error{"--push_kind is '" + FLAGS_push_kind + "'; it must be net or external"};
  }
  SimulateFlags flags;
  Stance& stance = flags.recordings.model.stance;
  if (MaybeError error = ParseName("--truth_stance", FLAGS_truth_stance, &stance)) return *error;
  ProcessNoiseTerms& noise = flags.recordings.model.process_noise;
  if (MaybeError error = ParseName("--truth_noise", FLAGS_truth_noise, &noise)) return *error;
  flags.out = FLAGS_out;
  flags.recordings.subjects = FLAGS_people;
  flags.recordings.recordings_per_subject = FLAGS_recordings_per_person;
  flags.recordings.frames = FLAGS_frames;
  flags.recordings.fps = FLAGS_fps;
  flags.recordings.joint_noise_m = FLAGS_noise;
  flags.recordings.push_kind = *kind;
  flags.recordings.recording_spread = FLAGS_recording_spread;
  flags.recordings.subject_spread = FLAGS_subject_spread;
  flags.recordings.seed = FLAGS_seed;
  return flags;
}

}  // namespace pushid
