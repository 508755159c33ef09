// datasets: HIERARCHY, Frames: and Frame Time: of a BVH file.
#include "datasets/formats/bvh_header.h"

#include <algorithm>
#include <limits>
#include <unordered_set>

#include "datasets/files/number_text.h"
#include "datasets/formats/units.h"

namespace pushid {
namespace {

bool IsBrace(char c) { return c == '{' || c == '}'; }

constexpr int kEndSite = -2;  // on the stack of open braces, in place of a joint index

// Reads tokens across lines, with a stack of open braces, which no depth of nesting overflows.
class HierarchyParser {
 public:
  explicit HierarchyParser(LineReader* reader) : reader_(*reader) {}

  Result<BvhSkeleton> Parse() {
    if (!EqualsIgnoringCase(Next(), "HIERARCHY")) {
      if (reader_.error()) return *reader_.error();
      return reader_.ErrorHere("this is not a BVH file: it does not start with HIERARCHY");
    }
    while (true) {
      const std::string_view token = Next();
      MaybeError failed;
      if (token.empty()) {
        if (reader_.error()) return *reader_.error();
        return reader_.ErrorHere(
            "the file ends inside the hierarchy, before MOTION: it is truncated");
      } else if (EqualsIgnoringCase(token, "MOTION")) {
        failed = CheckComplete();
        if (failed) return *failed;
        return std::move(skeleton_);
      } else if (EqualsIgnoringCase(token, "ROOT") || EqualsIgnoringCase(token, "JOINT")) {
        failed = OpenJoint(EqualsIgnoringCase(token, "ROOT"));
      } else if (EqualsIgnoringCase(token, "End")) {
        failed = OpenEndSite();
      } else if (EqualsIgnoringCase(token, "OFFSET")) {
        failed = ParseOffset();
      } else if (EqualsIgnoringCase(token, "CHANNELS")) {
        failed = ParseChannels();
      } else if (token == "}") {
        failed = Close();
      } else {
        return reader_.ErrorHere(
            Quoted(token) +
            " is not expected in the hierarchy (ROOT, JOINT, End Site, OFFSET, CHANNELS, {, }, "
            "MOTION are)");
      }
      if (failed) return *failed;
    }
  }

 private:
  // The next token of the file, a brace being one of its own; empty at the end.
  std::string_view Next() {
    while (true) {
      while (!rest_.empty() && IsBlank(rest_.front())) rest_.remove_prefix(1);
      if (!rest_.empty()) break;
      if (!reader_.Next(&rest_)) return {};
    }
    std::size_t length = 0;
    while (length < rest_.size() && !IsBlank(rest_[length]) && !IsBrace(rest_[length])) ++length;
    const std::string_view token = rest_.substr(0, std::max<std::size_t>(length, 1));
    rest_.remove_prefix(token.size());
    return token;
  }

  MaybeError ExpectOpeningBrace(const std::string& what) {
    const std::string_view token = Next();
    if (token == "{") return std::nullopt;
    return reader_.ErrorHere(
        "a { must follow " + what +
        (token.empty() ? "; the file is truncated" : ", not " + Quoted(token)));
  }

  MaybeError OpenJoint(bool root) {
    const std::size_t brace = rest_.find_first_of("{}");
    const std::string name(Trimmed(rest_.substr(0, brace)));
    rest_ = brace == std::string_view::npos ? std::string_view() : rest_.substr(brace);
    if (name.empty()) return reader_.ErrorHere("a joint has no name");
    if (root != open_.empty()) {
      return reader_.ErrorHere(root ? "ROOT " + name + " is inside another joint; is a } missing?"
                                    : "JOINT " + name + " is outside of any ROOT");
    }
    if (!root && open_.back() == kEndSite) {
      return reader_.ErrorHere("JOINT " + name + " is inside an End Site");
    }
    if (!names_.insert(name).second) {
      return reader_.ErrorHere("two joints are called " + Quoted(name) + "; names must be unique");
    }
    BvhJoint joint;
    joint.name = name;
    joint.parent = root ? -1 : open_.back();
    open_.push_back(static_cast<int>(skeleton_.joints.size()));
    skeleton_.joints.push_back(std::move(joint));
    has_offset_.push_back(false);
    has_channels_.push_back(false);
    return ExpectOpeningBrace("the joint's name");
  }

  MaybeError OpenEndSite() {
    if (!EqualsIgnoringCase(Next(), "Site")) return reader_.ErrorHere("Site must follow End");
    if (open_.empty() || open_.back() == kEndSite) {
      return reader_.ErrorHere("an End Site is outside of any joint");
    }
    open_.push_back(kEndSite);
    end_site_has_offset_ = false;
    return ExpectOpeningBrace("End Site");
  }

  MaybeError ParseOffset() {
    if (open_.empty()) return reader_.ErrorHere("an OFFSET is outside of any joint");
    Eigen::Vector3d offset;
    for (int axis = 0; axis < 3; ++axis) {
      const std::string_view token = Next();
      if (!ParseDouble(token, &offset[axis])) {
        return reader_.ErrorHere("OFFSET takes three numbers: " + NumberProblem(token));
      }
    }
    const bool end_site = open_.back() == kEndSite;
    if (end_site ? end_site_has_offset_ : has_offset_[open_.back()]) {
      return reader_.ErrorHere("a second OFFSET for the same joint");
    }
    if (end_site) {
      skeleton_.joints[open_[open_.size() - 2]].end_sites.push_back(offset);
      end_site_has_offset_ = true;
    } else {
      skeleton_.joints[open_.back()].offset = offset;
      has_offset_[open_.back()] = true;
    }
    return std::nullopt;
  }

  MaybeError ParseChannels() {
    if (open_.empty() || open_.back() == kEndSite) {
      return reader_.ErrorHere("CHANNELS are outside of any joint");
    }
    BvhJoint& joint = skeleton_.joints[open_.back()];
    if (has_channels_[open_.back()])
      return reader_.ErrorHere("a second CHANNELS for the same joint");
    has_channels_[open_.back()] = true;
    const std::string_view count_token = Next();
    std::int64_t count = 0;
    if (!ParseInteger(count_token, &count) || count < 0 || count > 6) {
      return reader_.ErrorHere("CHANNELS takes a number from 0 to 6 first, not " +
                               Quoted(count_token));
    }
    for (std::int64_t i = 0; i < count; ++i) {
      const std::string_view token = Next();
      bool known = false;
      for (const auto& [name, channel] : Names(BvhChannel{})) {
        if (!EqualsIgnoringCase(token, name)) continue;
        known = true;
        for (BvhChannel earlier : joint.channels) {
          if (earlier == channel) {
            return reader_.ErrorHere("joint " + Quoted(joint.name) + " lists " + name + " twice");
          }
        }
        joint.channels.push_back(channel);
      }
      if (!known) {
        return reader_.ErrorHere("joint " + Quoted(joint.name) + ": " + Quoted(token) +
                                 " is not a channel; " + std::to_string(count) +
                                 " of Xposition, Yposition, Zposition, Xrotation, Yrotation, "
                                 "Zrotation must follow");
      }
    }
    return std::nullopt;
  }

  MaybeError Close() {
    if (open_.empty()) return reader_.ErrorHere("a } has no matching {");
    const int closed = open_.back();
    open_.pop_back();
    if (closed == kEndSite ? !end_site_has_offset_ : !has_offset_[closed]) {
      return reader_.ErrorHere(
          (closed == kEndSite ? "an End Site" : "joint " + Quoted(skeleton_.joints[closed].name)) +
          " has no OFFSET");
    }
    return std::nullopt;
  }

  MaybeError CheckComplete() {
    if (!open_.empty()) {
      return reader_.ErrorHere("MOTION is inside the hierarchy: " + std::to_string(open_.size()) +
                               " closing } missing");
    }
    if (skeleton_.joints.empty()) return reader_.ErrorHere("the hierarchy has no ROOT");
    if (skeleton_.num_channels() == 0) return reader_.ErrorHere("no joint has any channels");
    if (!Trimmed(rest_).empty()) {
      return reader_.ErrorHere(Quoted(Trimmed(rest_)) + " follows MOTION");
    }
    return std::nullopt;
  }

  LineReader& reader_;
  std::string_view rest_;  // what is left of the current line
  BvhSkeleton skeleton_;
  std::vector<int> open_;
  std::vector<bool> has_offset_, has_channels_;  // per joint
  bool end_site_has_offset_ = false;
  std::unordered_set<std::string> names_;
};

// A line "<words>: <value>"; an Error when the words differ.
Result<std::string> ReadField(LineReader* reader, const std::string& words) {
  std::string_view line;
  if (!reader->NextNonBlank(&line)) {
    if (reader->error()) return *reader->error();
    return reader->ErrorHere("the file ends where '" + words + ":' should be: it is truncated");
  }
  const std::size_t colon = line.find(':');
  std::string key;
  for (std::string_view rest = line.substr(0, colon); !(rest = Trimmed(rest)).empty();) {
    if (!key.empty()) key += ' ';
    key += NextToken(&rest);
  }
  if (colon == std::string_view::npos || !EqualsIgnoringCase(key, words)) {
    return reader->ErrorHere("'" + words + ":' is expected here, not " + Quoted(Trimmed(line)));
  }
  return std::string(Trimmed(line.substr(colon + 1)));
}

}  // namespace

std::string FrameTimeProblem(double frame_time_s) {
  // A relative hair of slack: 0.0001 s is 10000 Hz whichever way it rounds.
  constexpr double kSlack = 1e-9;
  if (frame_time_s >= (1.0 - kSlack) / kMaxFramesPerSecond &&
      frame_time_s <= (1.0 + kSlack) / kMinFramesPerSecond) {
    return "";
  }
  return "the frame time is " + Rounded(frame_time_s) + " s; accepted are " +
         Rounded(1.0 / kMaxFramesPerSecond) + " s to " + Rounded(1.0 / kMinFramesPerSecond) +
         " s, that is " + Rounded(kMaxFramesPerSecond) + " to " + Rounded(kMinFramesPerSecond) +
         " frames per second";
}

Result<BvhHeader> ReadBvhHeader(LineReader* reader) {
  Result<BvhSkeleton> skeleton = HierarchyParser(reader).Parse();
  if (!skeleton.ok()) return skeleton.error();
  BvhHeader header;
  header.skeleton = std::move(skeleton.value());

  Result<std::string> frames = ReadField(reader, "Frames");
  if (!frames.ok()) return frames.error();
  if (!ParseInteger(frames.value(), &header.num_frames) || header.num_frames < 1 ||
      header.num_frames > std::numeric_limits<int>::max()) {
    return reader->ErrorHere("Frames: must be a whole number of 1 or more, not " +
                             Quoted(frames.value()));
  }
  Result<std::string> frame_time = ReadField(reader, "Frame Time");
  if (!frame_time.ok()) return frame_time.error();
  if (!ParseDouble(frame_time.value(), &header.frame_time_s)) {
    return reader->ErrorHere("Frame Time: " + NumberProblem(frame_time.value()));
  }
  const std::string problem = FrameTimeProblem(header.frame_time_s);
  if (!problem.empty()) return reader->ErrorHere(problem);
  return header;
}

}  // namespace pushid
