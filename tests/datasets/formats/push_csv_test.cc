#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "datasets/formats/force_csv.h"
#include "tests/test_support.h"

namespace pushid {
namespace {

using PushCsvTest = TempDirTest;

TEST_F(PushCsvTest, Reads) {
  for (const char* text :
       {"frame,fx,fy,ftheta,fphi\n0,1,-2.5,3e1,4\n1,0,0,0,-0.25\n",
        "\xEF\xBB\xBF"
        "frame, fx, fy, ftheta, fphi\r\n0, 1, -2.5, 30, +4\r\n\r\n1,0,0,0,-.25"}) {
    const auto read = Unwrapped(ReadPushCsv(WriteText("push.csv", text))).force;
    ASSERT_EQ(read.size(), 2u);
    EXPECT_EQ(read[0], Eigen::Vector4d(1, -2.5, 30, 4));
    EXPECT_EQ(read[1], Eigen::Vector4d(0, 0, 0, -0.25));
  }
}

TEST_F(PushCsvTest, ReadsWhatIsPlain) {
  for (const char* text :
       {"Frame,Fx,Fy,Ftheta,Fphi\n0,1,-2.5,30,4\n", "FRAME;FX;FY;FTHETA;FPHI\n0;1;-2.5;30;4\n",
        "frame\tfx\tfy\tftheta\tfphi\n0\t1\t-2.5\t30\t4\n",
        "\"frame\",\"fx\",\"fy\",\"ftheta\",\"fphi\"\n\"0\",\"1\",\"-2.5\",\"30\",\"4\"\n",
        "frame,fx (N),fy (N),ftheta (N m),fphi (N m)\n0,1,-2.5,30,4\n",
        "frame,fx_N,fy_N,ftheta_Nm,fphi_Nm\n0,1,-2.5,30,4\n",
        "# by hand\nframe,fx,fy,ftheta,fphi\n0.0,1,-2.5,30,4\n",
        "frame,fx[N],fy[N],ftheta[N.m],fphi[N.m],\n0,1,-2.5,30,4,\n"}) {
    EXPECT_EQ(Unwrapped(ReadPushCsv(WriteText("push.csv", text))).force,
              std::vector<Eigen::Vector4d>{Eigen::Vector4d(1, -2.5, 30, 4)})
        << text;
  }
}

TEST_F(PushCsvTest, TorquesMayBeLeftOut) {
  const PushRows read = Unwrapped(ReadPushCsv(WriteText("push.csv", "frame,fx,fy\n0,1,-2.5\n")));
  EXPECT_FALSE(read.has_torques);
  EXPECT_EQ(read.force, std::vector<Eigen::Vector4d>{Eigen::Vector4d(1, -2.5, 0, 0)});
  EXPECT_TRUE(Contains(ProblemOf(ReadPushCsv(WriteText("push.csv", "frame,fx,fy\n0,1,2,3\n"))),
                       "more than the 3 values"));
  EXPECT_FALSE(ReadPushCsv(WriteText("push.csv", "frame,fx,fy,ftheta\n0,1,2,3\n")).ok());
}

TEST_F(PushCsvTest, WrittenPushReadsBackBitForBit) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0.0, 100.0);
  std::vector<Eigen::Vector4d> force(50);
  for (auto& row : force) {
    for (int i = 0; i < 4; ++i)
      row[i] = normal(random) * std::pow(10.0, 30 * normal(random) / 100.0);
  }
  ASSERT_FALSE(WritePushCsv(Path("push.csv"), force));
  const auto read = Unwrapped(ReadPushCsv(Path("push.csv"))).force;
  EXPECT_EQ(read, force);
}

TEST_F(PushCsvTest, RefusesToWriteNonsense) {
  EXPECT_TRUE(WritePushCsv(Path("push.csv"), {}));
  EXPECT_TRUE(WritePushCsv(Path("push.csv"), {Eigen::Vector4d(0, NAN, 0, 0)}));
  EXPECT_EQ(CountFiles(), 0);
}

TEST_F(PushCsvTest, EveryDamageIsNamedWithItsLine) {
  const std::string header = "frame,fx,fy,ftheta,fphi\n";
  const struct {
    std::string text;
    const char* place;
    const char* says;
  } cases[] = {
      {"", "", "it is empty"},
      {"time;Force\n", ":1: ", "pushid-push --sensor makes such a push of it"},
      {"frame,fx (kN),fy (kN),ftheta,fphi\n", ":1: ", "the header is 'frame, fx (kN)"},
      {"frame,fy,fx,ftheta,fphi\n", ":1: ", "not frame,fx,fy,ftheta,fphi"},
      {"frame,fx,fy,ftheta\n0,1,2,3\n", ":1: ", "the header is 'frame, fx, fy, ftheta'"},
      {"0,1,2,3,4\n", ":1: ", "the first line must hold the names"},
      {header, ":1: ", "has no rows"},
      {header + "0,1,2,3,4\n2,1,2,3,4\n", ":3: ", "frame is 2 where 1 was expected"},
      {header + "1,1,2,3,4\n", ":2: ", "frame is 1 where 0 was expected; rows must count"},
      {header + "0,1,2,3,4\n0,1,2,3,4\n", ":3: ", "without gaps"},
      {header + "0.5,1,2,3,4\n", ":2: ", "frame is 0.5 where 0 was expected"},
      {header + "0,1,2,3\n", ":2: ", "the row has 4 values, not 5"},
      {header + "0,1,2,3,4,5\n", ":2: ", "more than the 5 values"},
      {header + "0,1,2,3,\n", ":2: ", "fphi is missing"},
      {header + "0,abc,2,3,4\n", ":2: ", "fx: 'abc' is not a number"},
      {header + "0,1,nan,3,4\n", ":2: ", "fy is missing"},
      {header + "0,1,2,inf,4\n", ":2: ", "ftheta: 'inf' is not a finite number"},
      {header + "0,1,2,3,1e999\n", ":2: ", "fphi: '1e999' does not fit"},
      {header + "0,1 2,2,3,4\n", ":2: ", "fx: '1 2' is not a number"},
  };
  for (const auto& c : cases) {
    const std::string path = WriteText("push.csv", c.text);
    const std::string read = ProblemOf(ReadPushCsv(path));
    EXPECT_TRUE(Contains(read, path + c.place)) << c.text;
    EXPECT_TRUE(Contains(read, c.says)) << c.text;
  }
  EXPECT_FALSE(ReadPushCsv(Path("missing.csv")).ok());
}

}  // namespace
}  // namespace pushid
