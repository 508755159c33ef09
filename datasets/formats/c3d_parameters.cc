// datasets: the parameter section of a C3D file.
//
// A record: length of the name (negative when locked), id of the group (negative: this is the group
// itself), the name, the distance to the next record counted from where the distance stands, and
// then for a parameter type, number of dimensions, dimensions and data; a description follows. The
// last record has distance 0, or a name of length 0 stands behind it.
#include "datasets/formats/c3d_parameters.h"

#include <cmath>
#include <cstring>
#include <map>

#include "datasets/files/number_text.h"

namespace pushid {
namespace {

// Fixed-length strings, filled up with blanks or zeros.
std::string WithoutPadding(std::string_view text) {
  text = text.substr(0, text.find('\0'));
  return std::string(Trimmed(text));
}

class ParameterReader {
 public:
  ParameterReader(const std::string& path, const C3dBytes& bytes) : path_(path), bytes_(bytes) {}

  Result<C3dParameters> Read(std::size_t at) {
    while (true) {
      if (!bytes_.Has(at, 2)) return Cut(at);
      const int name_length = std::abs(static_cast<int>(bytes_.Signed(at)));
      const int group = bytes_.Signed(at + 1);
      if (name_length == 0) break;
      const std::size_t distance_at = at + 2 + name_length;
      if (!bytes_.Has(distance_at, 2)) return Cut(distance_at);
      const std::string name = WithoutPadding(bytes_.Text(at + 2, name_length));
      if (group < 0) {
        group_names_[-group] = name;
      } else if (MaybeError failed = ReadParameter(name, group, distance_at + 2)) {
        return *std::move(failed);
      }
      const std::size_t distance = bytes_.Word(distance_at);
      if (distance == 0) break;
      if (distance < 2) {
        return C3dError(
            path_, distance_at,
            "the next parameter begins inside this one (" + name + "): the file is damaged");
      }
      at = distance_at + distance;
    }
    for (std::size_t i = 0; i < parameters_.size(); ++i) {
      const auto found = group_names_.find(groups_[i]);
      if (found == group_names_.end()) {
        return Error{"parameter " + Quoted(parameters_[i].name) + " belongs to group " +
                         std::to_string(groups_[i]) + ", which the file does not have",
                     path_};
      }
      parameters_[i].group = found->second;
    }
    return C3dParameters{std::move(parameters_)};
  }

 private:
  Error Cut(std::size_t at) const {
    return C3dError(path_, at, "the file ends inside its parameters: it is truncated or damaged");
  }

  MaybeError ReadParameter(const std::string& name, int group, std::size_t at) {
    if (!bytes_.Has(at, 2)) return Cut(at);
    C3dParameter parameter;
    parameter.name = name;
    const int type = bytes_.Signed(at);
    if (type != -1 && type != 1 && type != 2 && type != 4) {
      return C3dError(path_, at,
                      "parameter " + Quoted(name) + " has the type " + std::to_string(type) +
                          "; -1, 1, 2 and 4 are known");
    }
    parameter.type = static_cast<C3dType>(type);
    const int num_dimensions = bytes_.Byte(at + 1);
    at += 2;
    if (!bytes_.Has(at, num_dimensions)) return Cut(at);
    std::size_t count = 1;
    for (int i = 0; i < num_dimensions; ++i) {
      parameter.dimensions.push_back(bytes_.Byte(at + i));
      count *= bytes_.Byte(at + i);
      if (count > bytes_.size()) return Cut(at);
    }
    at += num_dimensions;
    if (!bytes_.Has(at, count * std::abs(type))) return Cut(at);
    ReadValues(at, count, &parameter);
    parameters_.push_back(std::move(parameter));
    groups_.push_back(group);
    return std::nullopt;
  }

  void ReadValues(std::size_t at, std::size_t count, C3dParameter* parameter) const {
    if (parameter->type == C3dType::kText) {
      const std::size_t length = parameter->dimensions.empty() ? 1 : parameter->dimensions[0];
      for (std::size_t i = 0; length > 0 && i < count / length; ++i) {
        parameter->texts.push_back(WithoutPadding(bytes_.Text(at + i * length, length)));
      }
      return;
    }
    for (std::size_t i = 0; i < count; ++i) {
      switch (parameter->type) {
        case C3dType::kByte:
          parameter->numbers.push_back(bytes_.Signed(at + i));
          break;
        case C3dType::kInteger:
          parameter->numbers.push_back(bytes_.Integer(at + 2 * i));
          break;
        default:
          parameter->numbers.push_back(bytes_.Real(at + 4 * i));
      }
    }
  }

  const std::string& path_;
  const C3dBytes& bytes_;
  std::map<int, std::string> group_names_;
  std::vector<int> groups_;  // of each parameter; a group may be named after its parameters
  std::vector<C3dParameter> parameters_;
};

// The entries of NAME, NAME2, ... up to the first that is not there.
template <typename Entry>
std::vector<Entry> Joined(const C3dParameters& parameters, std::string_view group,
                          const std::string& name, std::vector<Entry> C3dParameter::*entries) {
  std::vector<Entry> joined;
  for (int number = 1;; ++number) {
    const C3dParameter* parameter =
        parameters.Find(group, number == 1 ? name : name + std::to_string(number));
    if (parameter == nullptr) return joined;
    const std::vector<Entry>& part = parameter->*entries;
    joined.insert(joined.end(), part.begin(), part.end());
  }
}

double FromIeee(std::uint32_t bits) {
  float value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

double FromVax(std::uint32_t bits) {
  const int exponent = static_cast<int>(bits >> 23 & 0xff);
  if (exponent == 0) return 0.0;
  const double fraction = static_cast<double>((bits & 0x7fffff) | 0x800000);
  const double size = std::ldexp(fraction, exponent - kVaxBias - kFractionBits);
  return (bits >> 31) != 0 ? -size : size;
}

}  // namespace

Error C3dError(const std::string& path, std::size_t at, const std::string& message) {
  return {"at byte " + std::to_string(at) + ": " + message, path};
}

Result<C3dParameters> ReadC3dParameters(const std::string& path, const C3dBytes& bytes,
                                        std::size_t begin) {
  return ParameterReader(path, bytes).Read(begin);
}

const C3dParameter* C3dParameters::Find(std::string_view group, std::string_view name) const {
  for (const C3dParameter& parameter : list) {
    if (EqualsIgnoringCase(parameter.group, group) && EqualsIgnoringCase(parameter.name, name)) {
      return &parameter;
    }
  }
  return nullptr;
}

double C3dParameters::Number(std::string_view group, std::string_view name, std::size_t index,
                             double fallback) const {
  const C3dParameter* parameter = Find(group, name);
  if (parameter == nullptr || index >= parameter->numbers.size()) return fallback;
  return parameter->numbers[index];
}

int C3dParameters::Whole(std::string_view group, std::string_view name, std::size_t index,
                         int lowest, int highest, int fallback) const {
  const double value = Number(group, name, index, fallback);
  // Written so that NaN fails.
  return value >= lowest && value <= highest ? static_cast<int>(value) : fallback;
}

std::vector<double> C3dParameters::Numbers(std::string_view group, const std::string& name) const {
  return Joined(*this, group, name, &C3dParameter::numbers);
}

std::vector<std::string> C3dParameters::Texts(std::string_view group,
                                              const std::string& name) const {
  return Joined(*this, group, name, &C3dParameter::texts);
}

std::uint16_t C3dBytes::Word(std::size_t at) const {
  const std::uint16_t first = Byte(at), second = Byte(at + 1);
  return static_cast<std::uint16_t>(processor_ == C3dProcessor::kMips ? first << 8 | second
                                                                      : second << 8 | first);
}

double C3dBytes::Real(std::size_t at) const {
  const std::uint32_t first = Word(at), second = Word(at + 2);
  switch (processor_) {
    case C3dProcessor::kDec:
      return FromVax(first << 16 | second);
    case C3dProcessor::kMips:
      return FromIeee(first << 16 | second);
    case C3dProcessor::kIntel:
      break;
  }
  return FromIeee(second << 16 | first);
}

}  // namespace pushid
