// apps: pushid-path: most probable paths under a model's process noise.
#include "apps/flags/command_line.h"
#include "apps/flags/model_flags.h"
#include "datasets/files/json_file.h"
#include "ident/figures/text_table.h"
#include "ident/forecasts/most_probable_path.h"

DEFINE_string(from, "",
              "initial state of the path: x, y (m), theta, phi (rad), xd, yd (m/s), thetad, phid "
              "(rad/s), comma-separated, as in theta=0.05,xd=0.3; components not named are 0");
DEFINE_string(to, "",
              "final state, in the same form; if no velocity is named all are free, otherwise all "
              "are fixed. With several ends, separated by semicolons, the most probable one is "
              "reported. Not for models whose noise grows with speed");
DEFINE_int32(frames, 60, "frames of the path, both ends included");
DEFINE_double(fps, 60.0, "frames per second");
DEFINE_double(mass, pushid::kReferenceMass, "the person's mass, kg");
DEFINE_double(rod, pushid::kReferenceRod, "the person's rod (ankles to hip), m");
DEFINE_string(out, "", "write states, and the forces that drove them, here (CSV)");
DEFINE_string(json_out, "", "write the actions here (JSON)");

namespace {

using namespace pushid;

// The ends of --to, among which the most probable one is found, by their texts.
std::vector<std::pair<std::string, PathEnd>> ReadEnds() {
  std::vector<std::pair<std::string, PathEnd>> ends;
  for (const std::string& text : SplitList(FLAGS_to, ';')) {
    const std::string name(Trimmed(text));
    const PathEnd to = OrFail(ParsePathEnd("--to", name, false));
    if (name.empty()) throw Error{"--to has an empty end; a person at rest upright is x=0,xd=0"};
    if (!ends.empty() && to.rates_held != ends.front().second.rates_held) {
      throw Error{
          "--to fixes velocities in some ends and leaves them free in others, so their "
          "probabilities cannot be compared; name a velocity in all ends or in none"};
    }
    ends.emplace_back(name, to);
  }
  Require("to", FLAGS_to, "give the final state, as in --to=x=0.5,xd=0");
  return ends;
}

int Run() {
  RequireModel();
  const PathEnd from = OrFail(ParsePathEnd("--from", FLAGS_from, true));
  const auto ends = ReadEnds();
  CheckRange("frames", FLAGS_frames, 6, 100000);
  CheckRange("fps", FLAGS_fps, 10, 10000);
  CheckRange("mass", FLAGS_mass, 5, 500);
  CheckRange("rod", FLAGS_rod, 0.2, 2);
  OrFail(CheckOutputFiles({FLAGS_out, FLAGS_json_out}));
  const IdentifiedModel model = LoadFlaggedModel();
  TextTable table = TextTable::OfNumbers({"end", "action", "of noise", "of divergence"});
  nlohmann::ordered_json json = ResultHead("pushid-path/1");
  std::string best_end;
  ProbablePath best;
  for (const auto& [end, to] : ends) {
    ProbablePath found =
        OrFail(PathBetween(model, {FLAGS_mass, FLAGS_rod, 0.0}, FLAGS_fps, from, to, FLAGS_frames));
    table.Add({end, Rounded(found.action(), 4), Rounded(found.noise_action, 4),
               Rounded(found.divergence_action, 4)});
    json["paths"].push_back({{"action", found.action()},
                             {"noise_action", found.noise_action},
                             {"divergence_action", found.divergence_action},
                             {"end", end}});
    if (best_end.empty() || found.action() < best.action()) {
      best_end = end, best = std::move(found);
    }
  }
  json["most_probable"] = best_end;
  std::printf("%s", table.ToString().c_str());
  if (ends.size() > 1) std::printf("most probable: %s\n", best_end.c_str());
  std::printf(
      "action: -log probability density of the path, up to a constant that depends on its "
      "frames\n");
  if (!FLAGS_out.empty()) {
    OrFail(WritePathCsv(FLAGS_out, best, 1.0 / FLAGS_fps));
    std::printf("%d frames written to %s\n", best.states.num_frames(), FLAGS_out.c_str());
  }
  WriteIfNamed(FLAGS_json_out, json);
  return kDone;
}

}  // namespace

int main(int argc, char** argv) {
  return pushid::RunApp(
      argc, argv,
      "pushid-path finds the most probable path between two states, by a model with process "
      "noise.\n"
      "  pushid-fit --recordings=recordings/manifest.json --likelihood=innovation "
      "--model_out=noise.json && "
      "pushid-path --model=noise.json --from=xd=0.5 --to=x=0.4,xd=0 --out=path.csv",
      Run);
}
