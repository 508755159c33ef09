// Warnings about many recordings: once, with a count.
#include "datasets/files/error.h"

#include <gtest/gtest.h>

namespace pushid {
namespace {

using Texts = std::vector<std::string>;

Warning Of(const std::string& id, const std::string& file, const std::string& what) {
  return {"recording '" + id + "': " + file + " " + what, id, "the file " + what};
}

TEST(WarningTest, WhatSeveralRecordingsShareIsSaidOnce) {
  EXPECT_EQ(GroupedWarnings({Of("a", "a.bvh", "has gaps"), Warning("mu is at its bound"),
                             Of("b", "runs/b.bvh", "has gaps"), Of("c", "c.bvh", "is long")}),
            Texts({"in 2 recordings (a, b): the file has gaps", "mu is at its bound",
                   "recording 'c': c.bvh is long"}));
  Warnings many;
  for (const char* id : {"a", "b", "c", "d"}) many.push_back(Of(id, "x", "is odd"));
  EXPECT_EQ(GroupedWarnings(many), Texts({"in 4 recordings (a, b, c, ...): the file is odd"}));
}

TEST(WarningTest, EqualOnesAreCounted) {
  EXPECT_EQ(GroupedWarnings(
                {Warning("low"), Warning("low"), Of("a", "a.bvh", "x"), Of("a", "b.bvh", "x")}),
            Texts({"low (2 times)", "recording 'a': a.bvh x (2 times)"}));
}

// The words of a sentence decide nothing: not even that it reads like one of a recording.
TEST(WarningTest, SentencesAreNotRead) {
  EXPECT_EQ(GroupedWarnings({Warning("recording a: no"), Warning("recording b: no"),
                             Warning("same", "a", "same"), Warning("same")}),
            Texts({"recording a: no", "recording b: no", "same", "same"}));
}

}  // namespace
}  // namespace pushid
