// C3D files put together byte by byte, after the public description of the format (c3d.org), for
// what it allows and the project's writer does not make: offsets and unsigned samples, a general
// scale, more frames or channels than their counts hold.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "datasets/formats/c3d.h"
#include "tests/datasets/c3d_writer.h"

namespace pushid {

// One point whose raw x is its frame from 0, modulo 1000; one sample of each channel in a frame.
class HandmadeC3d {
 public:
  explicit HandmadeC3d(C3dProcessor processor = C3dProcessor::kIntel) : processor_(processor) {
    Group("POINT");
    Integers("USED", {1}, {});
  }

  int frames = 3;         // in the data
  int last_frame = 3;     // as the header says, from 1
  std::vector<int> raw;   // the sample of each channel, as 16 bits hold it
  bool floating = false;  // raw samples as floats
  int points = 1;         // 0: none
  std::string behind;     // from the block behind the data on

  // Parameters belong to the group before them.
  void Group(const std::string& name) {
    ++group_;
    Record(name, -group_, std::string(1, '\0'));
  }
  void Integers(const std::string& name, const std::vector<int>& values,
                const std::vector<int>& dimensions) {
    std::string data;
    for (int value : values) Word(value, &data);
    Parameter(name, C3dType::kInteger, dimensions, data);
  }
  void Counts(const std::string& name, const std::vector<int>& values) {  // bytes
    Parameter(name, C3dType::kByte, {static_cast<int>(values.size())},
              std::string(values.begin(), values.end()));
  }
  void Reals(const std::string& name, const std::vector<double>& values,
             const std::vector<int>& dimensions) {
    std::string data;
    for (double value : values) AppendC3dReal(value, processor_, &data);
    Parameter(name, C3dType::kReal, dimensions, data);
  }
  void Texts(const std::string& name, const std::vector<std::string>& texts, int length) {
    std::string data;
    for (std::string text : texts) {
      text.resize(length, ' ');
      data += text;
    }
    Parameter(name, C3dType::kText, {length, static_cast<int>(texts.size())}, data);
  }
  void Text(const std::string& name, const std::string& text) {
    Parameter(name, C3dType::kText, {static_cast<int>(text.size())}, text);
  }

  std::string Bytes() const {
    std::string parameters("\1\x50\0", 3);
    parameters += static_cast<char>(processor_);
    parameters += parameters_ + std::string(2, '\0');
    parameters.resize((parameters.size() + 511) / 512 * 512, '\0');
    parameters[2] = static_cast<char>(parameters.size() / 512);
    return Header(parameters.size() / 512) + parameters + Data();
  }

 private:
  void Word(int value, std::string* out) const {
    AppendC3dWord(static_cast<std::uint16_t>(value & 0xffff), processor_, out);
  }

  void Record(const std::string& name, int group, const std::string& rest) {
    parameters_ += static_cast<char>(name.size());
    parameters_ += static_cast<char>(group);
    parameters_ += name;
    Word(2 + static_cast<int>(rest.size()), &parameters_);
    parameters_ += rest;
  }

  void Parameter(const std::string& name, C3dType type, const std::vector<int>& dimensions,
                 const std::string& data) {
    std::string rest;
    rest += static_cast<char>(type);
    rest += static_cast<char>(dimensions.size());
    for (int dimension : dimensions) rest += static_cast<char>(dimension);
    Record(name, group_, rest + data + '\0');
  }

  // Words from 1: 2 points, 3 samples in a frame, 4 and 5 first and last frame, 7 scale of the
  // points, 9 block of the data, 10 samples of a channel in a frame, 11 frames per second.
  std::string Header(std::size_t parameter_blocks) const {
    std::string header = "\2\x50";
    for (int word : {points, static_cast<int>(raw.size()), 1, last_frame, 0}) Word(word, &header);
    AppendC3dReal(floating ? -1.0 : 1.0, processor_, &header);
    Word(2 + static_cast<int>(parameter_blocks), &header);
    Word(1, &header);
    AppendC3dReal(100.0, processor_, &header);
    header.resize(512, '\0');
    return header;
  }

  std::string Data() const {
    std::string data;
    const auto append = [&](int value) {
      if (floating) {
        AppendC3dReal(value, processor_, &data);
      } else {
        Word(value, &data);
      }
    };
    for (int frame = 0; frame < frames; ++frame) {
      for (int value : {frame % 1000, 200, 300, 0}) {
        if (points > 0) append(value);
      }
      for (int value : raw) append(value);
    }
    data.resize((data.size() + 511) / 512 * 512, '\0');
    return data + behind;
  }

  const C3dProcessor processor_;
  int group_ = 0;
  std::string parameters_;
};

// The raw sample (32868) is beyond a signed integer, and so is the offset (32768): 100 raw, 200 N.
inline HandmadeC3d UnsignedC3d(C3dProcessor processor = C3dProcessor::kIntel) {
  HandmadeC3d file(processor);
  file.raw = {32868};
  file.Group("ANALOG");
  file.Text("FORMAT", "UNSIGNED");
  file.Reals("GEN_SCALE", {4.0}, {});
  file.Reals("SCALE", {0.5}, {1});
  file.Integers("OFFSET", {-32768}, {1});
  return file;
}

// An analog offset at the end of the signed range, without a word of the format.
inline HandmadeC3d UnsaidUnsignedC3d(C3dProcessor processor = C3dProcessor::kIntel) {
  HandmadeC3d file(processor);
  file.raw = {32668, 32868};
  file.Group("ANALOG");
  file.Integers("OFFSET", {-32768, -32768}, {2});
  return file;
}

// Two channels, 300 N and -900 N.
inline HandmadeC3d OffsetC3d(C3dProcessor processor = C3dProcessor::kIntel) {
  HandmadeC3d file(processor);
  file.raw = {300, -300};
  file.Group("ANALOG");
  file.Reals("GEN_SCALE", {3.0}, {});
  file.Reals("SCALE", {0.5, 1.5}, {2});
  file.Integers("OFFSET", {100, -100}, {2});
  return file;
}

// The header's count is at its end; two words of TRIAL say how many frames there are.
inline HandmadeC3d TrialC3d(int frames, C3dProcessor processor = C3dProcessor::kIntel) {
  HandmadeC3d file(processor);
  file.frames = frames;
  file.last_frame = 65535;
  file.Group("TRIAL");
  file.Integers("ACTUAL_START_FIELD", {1, 0}, {2});
  file.Integers("ACTUAL_END_FIELD", {frames & 0xffff, frames >> 16}, {2});
  return file;
}

// The number of frames by POINT:LONG_FRAMES.
inline HandmadeC3d LongFramesC3d(int frames, C3dProcessor processor = C3dProcessor::kIntel) {
  HandmadeC3d file(processor);
  file.frames = frames;
  file.last_frame = 65535;
  file.Integers("FRAMES", {65535}, {});
  file.Reals("LONG_FRAMES", {static_cast<double>(frames)}, {});
  return file;
}

// 300 channels of 100 N each, all by an offset of 100 and a scale of 0.01.
inline HandmadeC3d ManyChannelsC3d(C3dProcessor processor = C3dProcessor::kIntel) {
  HandmadeC3d file(processor);
  file.raw.assign(300, 10100);
  file.Group("ANALOG");
  for (const auto& [part, count] : {std::pair("", 255), std::pair("2", 45)}) {
    file.Reals(std::string("SCALE") + part, std::vector<double>(count, 0.01), {count});
    file.Integers(std::string("OFFSET") + part, std::vector<int>(count, 100), {count});
  }
  return file;
}

}  // namespace pushid
