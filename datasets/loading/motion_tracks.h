// datasets: tracks of positions: gaps, low-pass and frame rate of a motion between the file and the
// fit, whether it can be a person at all, and a recording straight from tracks in memory, with the
// checks of one from files.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "datasets/files/error.h"
#include "datasets/manifest/recording.h"

namespace pushid {

struct PreparationOptions {
  // Gaps of up to this long are interpolated; frames of longer ones get weight 0. 0: none is.
  double max_gap_s = 0.1;
  // Zero-phase low-pass of all positions (LowPass), Hz; 0: none. 6 to 10 Hz is usual for trunk
  // and ankles; it also rounds off the first frames of the reaction to a push.
  double lowpass_hz = 0.0;
  // The rate at which the motion is rolled out and compared, frames per second; 0: the recording's.
  // Lower rates make fits cheaper and the discretization coarser.
  double resample_fps = 0.0;
};

MaybeError CheckPreparation(const PreparationOptions& options);

// Filters and resamples a recording whose gaps are filled. Errors: a cut-off that the recording's
// rate cannot have, a rate lower by more than a twentieth without a low-pass of at most half of it,
// fewer than three frames left.
MaybeError PrepareMotion(const PreparationOptions& options, Recording* recording);

// Checks whether positions read from a file can be a person at all: a fit to wrong units or axes
// succeeds, and is wrong. The distance from the ankles' midpoint to the hip at frame 0 (in people
// about 0.7 to 1.1 m) must be 0.12 to 3 m, its direction within 1 rad of up, and every position
// within 100 km of the origin; three frames are needed. `unit` is what the file was read in.
MaybeError CheckMotion(const RecordedPerson& person, double metres_per_unit);

// Single tracks of positions.

struct GapCount {
  int gaps = 0;
  int excluded_frames =
      0;  // in gaps that are too long, and before the first and after the last frame seen
};

// Fills every gap (positions that are not finite) of `track`: gaps of up to max_gap frames inside
// by a cubic through the two frames on either side (Hermite, slopes by differences); longer ones by
// a straight line, and the ends by the nearest position, where `weight` (one per frame) becomes 0.
// A track that was never seen stays as it is, with all weights 0.
GapCount FillGaps(int max_gap, std::vector<Eigen::Vector3d>* track, std::vector<double>* weight);

// The tracks that say where a person is (hip, ankles), all with as many frames, with their gaps
// filled.
struct FilledTracks {
  std::vector<double> weight;  // one per frame
  int gaps = 0;
  int interpolated_frames = 0;
  int excluded_frames = 0;  // of weight 0
  bool many = false;        // interpolated frames

  bool AllCount() const { return excluded_frames == 0 && !many; }
  // "has 3 gaps in hip and ankles; ..."; empty where nothing was missing.
  std::string Warning(double max_gap_s) const;
};

// FillGaps of each. Where more than a tenth of the frames is interpolated, these count by the share
// of those that were seen: they repeat what their neighbours say, and an interval that counted them
// fully would be as narrow as if all had been measured.
FilledTracks FillTracks(int max_gap, const std::vector<std::vector<Eigen::Vector3d>*>& tracks);

// Zero-phase low-pass filtering, as gait laboratories do it: a second-order Butterworth
// filter over the track and back again, which cancels its delay and makes it of fourth order.
//
// Bilinear transform with pre-warping; `cutoff` is where the two passes together have lost 3 dB, so
// the single pass is designed for cutoff / (sqrt(2) - 1)^(1/4) (Winter's correction). Before both
// passes the track is continued at either end by its point reflection, and the filter starts from
// its steady state, so that ends do not ring.

// cutoff in (0, rate / 2) after the correction, see HighestCutoff; leaves tracks of fewer than
// three frames alone. Every position must be finite.
void LowPass(double cutoff_hz, double rate_hz, std::vector<Eigen::Vector3d>* track);

// The highest cut-off that LowPass can make at this rate, Hz.
double HighestCutoff(double rate_hz);

// Recordings at another frame rate.

// The frames of a track of `frames` frames that fit between its first and last at the other rate.
int ResampledFrames(int frames, double from_hz, double to_hz);

// The track at to_hz: cubic through the four nearest frames (Lagrange), the first frame as it is.
// Nothing is low-passed: that comes first where the rate goes down.
std::vector<Eigen::Vector3d> ResampleTrack(const std::vector<Eigen::Vector3d>& track,
                                           double from_hz, double to_hz);

// The weight of each new frame: the least of the frames that it is interpolated from.
std::vector<double> ResampleWeights(const std::vector<double>& weight, double from_hz,
                                    double to_hz);

// Rows are means over their frame, and so are the new ones: the impulse stays.
Push ResamplePush(const Push& push, double from_hz, double to_hz);

// A recording of tracks in memory, NaN where something was not seen, whose ground counts from
// anywhere. Gaps are filled as those of files are, and the motion filtered and resampled; unusual
// things that are no error are appended to `warnings`. Errors: a mass not in (0, 400] kg, a rate
// not in [1, 10000], people with different numbers of frames or fewer than three, a first frame
// that is not seen, those of CheckMotion, pushes on nobody or beyond the motion; ground or
// platforms with other frames than the motion, with numbers that are not finite, or together with
// another rate; ground that moves at frame 0, and platforms that do not measure the person's
// weight.
Result<Recording> RecordingFromTracks(Recording tracks, const PreparationOptions& preparation = {},
                                      Warnings* warnings = nullptr);

// Appends "recording 'id': what"; of_many: the sentence about several, unless it is `what` too.
// warnings: null where nobody reads them.
void WarnOf(const std::string& id, const std::string& what, Warnings* warnings,
            const std::string& of_many = "");

// The height of a push: a fraction of the way from the ankles to the hip, or metres above the
// ground at its first frame.
struct PushHeight {
  double fraction = 1.0;
  std::optional<double> metres;
};

// Fraction of the rod at which a horizontal plane `height` metres up crosses it.
double HeightFraction(const Body& body, const Vector4<double>& q, double height);

// Forces on a person from frame `start` on, as generalized forces at the recorded poses.
std::vector<Eigen::Vector4d> PushAtHeight(const RecordedPerson& person, int start,
                                          const std::vector<Eigen::Vector3d>& forces,
                                          const PushHeight& height);

// The mean of some tracks, frame by frame: not finite where one of them is not. chosen: empty where
// there is no such track.
std::vector<Eigen::Vector3d> MeanTrack(const std::vector<std::vector<Eigen::Vector3d>>& tracks,
                                       const std::vector<int>& chosen);

// [joint][frame] as [frame][joint], and the other way.
std::vector<std::vector<Eigen::Vector3d>> Transposed(
    const std::vector<std::vector<Eigen::Vector3d>>& rows);

// Values at even times: cubic through the four nearest samples (Lagrange; of fewer, through all).
// at: in samples, from 0.
Eigen::Vector3d ValueBetween(const std::vector<Eigen::Vector3d>& track, double at);

}  // namespace pushid
