// ident: a restoration in a folder: restoration.json (what it is, how it was trained) and
// weights.npy (its numbers, float32). Both load without the training code and without LibTorch.
// tensor_folder.h has the layout.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/files/json_file.h"
#include "ident/bodies/body_recording.h"
#include "models/restoration/cvae_restoration.h"
#include "models/restoration/dense_network.h"
#include "models/restoration/restoration.h"
#include "residuals/cost_functions/body_residual.h"

namespace pushid {

inline constexpr int kRestorationFormat = 1;
// In RestorationFile::settings: a name of RestorationView (of kWindow and kCvae), of
// CvaeCoordinates, whether the body has two networks, whether samplers kept their sigma, and a name
// of CvaeTraining (of kCvae). Files of before have none of them.
inline constexpr char kViewKey[] = "sees";
inline constexpr char kCvaeCoordinatesKey[] = "coordinates";
inline constexpr char kCvaeHalvesKey[] = "halves";
inline constexpr char kCvaeSigmaKey[] = "sigma";
inline constexpr char kCvaeTrainingKey[] = "training";

// In RestorationFile::training: the most people of one recording that it learned from.
inline constexpr char kMostPeopleKey[] = "most_people";

struct RestorationFile {
  RestorationKind kind = RestorationKind::kWindow;
  KeptJson settings{};  // of the kind
  KeptJson training{};  // provenance
  TensorList tensors;
};

std::string RestorationJsonFile(const std::string& folder);

// The JSON comes last: without it the folder is no restoration.
MaybeError WriteRestorationFile(const std::string& folder, const RestorationFile& file);

// Errors: no such folder, a newer format, weights that are not those of the JSON (by their hash).
// flag: which names the folder, for messages.
Result<RestorationFile> ReadRestorationFile(const std::string& folder,
                                            const char* flag = "--restoration");

// The restoration a file describes. Errors: a kind that is no restoration, missing or misshapen
// tensors by name.
Result<std::unique_ptr<Restoration>> MakeRestoration(const RestorationFile& file,
                                                     const std::string& folder);

// Whether it learned from people alone; such bodies stay on tiptoe when others push them on. false
// where the file does not say.
Result<bool> LearnedAlone(const std::string& folder);

// Both. "rigid" needs no folder: the name is enough.
Result<std::unique_ptr<Restoration>> LoadRestoration(const std::string& folder,
                                                     const char* flag = "--restoration");

// How z of a `cvae` is chosen (models/restoration/cvae_restoration.h).
struct LatentChoice {
  CvaeLatent latent = CvaeLatent::kMean;
  uint64_t seed = 1;  // of kDraw
};
// Errors: kDraw of another kind, without samplers, or with samplers whose sigma was not kept.
MaybeError ChooseLatent(const LatentChoice& choice, Restoration* restoration);

// The bodies of a fit with body_weight (FitOptions). Errors: a restoration that is no `window` or
// `cvae` of the pendulum alone, whose Jacobian is not known. Of a `cvae`, z is the sampler's mean.
Result<std::shared_ptr<const BodyData>> MakeBodyData(const Restoration& restoration,
                                                     const std::vector<BodyRecording>& recordings);

// The same from a restoration's folder, which `flag` names, and loaded recordings with all joints.
Result<std::shared_ptr<const BodyData>> LoadBodyData(const std::string& folder, const char* flag,
                                                     const std::vector<Recording>& recordings,
                                                     SkeletonMapping mapping);

}  // namespace pushid
