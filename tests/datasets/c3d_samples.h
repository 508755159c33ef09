// A small C3D file for tests.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "datasets/formats/c3d.h"

namespace pushid {

// The index of a point by its name.
inline int FindPoint(const C3dFile& file, const std::string& name) {
  const auto found = std::find(file.point_names.begin(), file.point_names.end(), name);
  return static_cast<int>(found - file.point_names.begin());
}

// A person of three markers, mm, ten frames at 100 Hz, one marker hidden in two frames; a platform
// of type 2 with ten samples per frame and a spare channel.
inline C3dFile SampleC3d() {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  constexpr int kFrames = 10, kPerFrame = 10;
  C3dFile file;
  file.first_frame = 5;
  file.point_rate_hz = 100.0;
  file.analog_rate_hz = 1000.0;
  file.point_unit = "mm";
  file.screen_x = "+X";
  file.screen_y = "+Z";
  file.point_names = {"Anna:HIP", "Anna:LANK", "Anna:RANK"};
  file.points.resize(3);
  for (int frame = 0; frame < kFrames; ++frame) {
    file.points[0].push_back({2.5 * frame, 1.25, 950.0});
    file.points[1].push_back({-10.0, 100.0, 80.0});
    file.points[2].push_back(frame == 3 || frame == 4 ? Eigen::Vector3d::Constant(kNaN)
                                                      : Eigen::Vector3d(10.0, -100.0, 80.5));
  }
  const double load[6] = {20.0, -10.0, -700.0, 14000.0, 21000.0, 500.0};  // N, N mm
  const char* names[7] = {"Fx1", "Fy1", "Fz1", "Mx1", "My1", "Mz1", "rod"};
  for (int c = 0; c < 7; ++c) {
    C3dAnalogChannel channel;
    channel.name = names[c];
    channel.unit = c < 3 || c == 6 ? "N" : "Nmm";
    for (int i = 0; i < kFrames * kPerFrame; ++i) {
      channel.samples.push_back(c < 6 ? load[c] : 40.0 * std::sin(0.05 * i));
    }
    file.analog.push_back(channel);
  }
  C3dPlatform platform;
  platform.type = 2;
  platform.channels = {0, 1, 2, 3, 4, 5};
  platform.corners << 600.0, 0.0, 0.0, 600.0,  // x of corners 1 to 4: +x is the world's x
      -200.0, -200.0, 200.0, 200.0,            // y: +y is the world's -y
      0.0, 0.0, 0.0, 0.0;
  platform.origin = {0.0, 0.0, -40.0};
  file.platforms = {platform};
  return file;
}

}  // namespace pushid
