// Warnings about many recordings: once, with a count.
#include <gtest/gtest.h>

#include "datasets/loading/load_recordings.h"

namespace pushid {
namespace {

using Texts = std::vector<std::string>;

TEST(RecordingWarningsTest, WhatDiffersOnlyInTheRecordingIsSaidOnce) {
  EXPECT_EQ(GroupedWarnings({"recording 'a': a.bvh has gaps", "mu is at its bound",
                             "recording 'b': runs/b.bvh has gaps", "recording 'c': c.bvh is long"}),
            Texts({"in 2 recordings (a, b): the file has gaps", "mu is at its bound",
                   "recording 'c': c.bvh is long"}));
  Texts many;
  for (const char* id : {"a", "b", "c", "d"})
    many.push_back(std::string("recording ") + id + ": no");
  EXPECT_EQ(GroupedWarnings(many), Texts({"in 4 recordings (a, b, c, ...): no"}));
}

TEST(RecordingWarningsTest, KeysOfAManifestHaveNoColon) {
  EXPECT_EQ(GroupedWarnings({"recording 'a' has the key 'x'", "recording 'b' has the key 'x'"}),
            Texts({"in 2 recordings (a, b): has the key 'x'"}));
}

TEST(RecordingWarningsTest, EqualOnesAreCounted) {
  EXPECT_EQ(GroupedWarnings({"low", "low", "recording 'a': a.bvh x", "recording 'a': b.bvh x"}),
            Texts({"low (2 times)", "recording 'a': a.bvh x (2 times)"}));
}

TEST(RecordingWarningsTest, OneAloneStaysAsItIs) {
  const Texts odd = {"recording 'a", "recording ", "", "recording x: y"};
  EXPECT_EQ(GroupedWarnings(odd), odd);
}

}  // namespace
}  // namespace pushid
