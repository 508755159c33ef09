// ident: the states of people and of whole groups, frame by frame (Eq. 11 of Tanke et al., ICCV
// 2023, called SDM), at the rate of words and transitions, 60 Hz.
//
// People's states are annotated (datasets/loading/state_csv.h) or follow from the motion as a
// StateFunction has them. The symbol of a whole group depends on how many of its people are in
// which state, never on who they are: "1 speak + 2 listen", or what annotators call that most
// often.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "models/restoration/group_motion.h"

namespace pushid {

struct GroupMotion {
  std::vector<BodyMotion> people;
  double dt = 1.0 / 60.0;
  int pushed_person = 0;
  int first_frame = 1;  // that counts; everybody knows frame 0
  // As annotated, a value per frame of `people`; empty: not annotated.
  std::vector<Symbols> states = {};            // [person], of the names of a StateFunction
  std::vector<std::string> group_states = {};  // of the whole group
};

// Transitions and words are those of 60 frames a second.
std::vector<BodyMotion> AtWordRate(const GroupMotion& group);
// At the words' rate: the frame at which the first step that counts begins.
std::ptrdiff_t FirstStep(const GroupMotion& group);

// Of all frames, [person].
std::vector<Symbols> StatesOfPeople(const GroupMotion& group, const StateFunction& states);
// Those that count, and before them the first of them again, as at frame 0.
Symbols Counted(const GroupMotion& group, const Symbols& symbols);

// Everybody's frames whose steps count.
std::vector<BodyMotion> CountedMotions(const std::vector<GroupMotion>& groups);

// The symbols of whole groups, as recorded groups have them. What no recorded group does together
// is "other".
class GroupVocabulary {
 public:
  GroupVocabulary(const std::vector<GroupMotion>& recorded, const StateFunction& states);

  // The last is kOther.
  const std::vector<std::string>& names() const { return names_; }
  // Of all frames.
  Symbols Of(const GroupMotion& group, const StateFunction& states) const;

  // "2 stand + 1 step", in the order of the states; people: everybody's symbol at a frame.
  static std::string NameOf(std::vector<int> people, const StateFunction& states);

 private:
  std::vector<std::string> names_;
  std::map<std::string, int> symbols_;  // by name
  std::map<std::string, int> of_;       // by what people do
};
inline constexpr char kOther[] = "other";

}  // namespace pushid
