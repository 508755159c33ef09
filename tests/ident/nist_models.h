// The 27 nonlinear models of the NIST Statistical Reference Datasets, and a reader for their files.
#pragma once

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace pushid {

struct NistSet {
  std::string name;
  std::vector<double> start[2];
  std::vector<double> certified, certified_error;
  double residual_sum = 0.0;              // certified
  std::vector<std::vector<double>> rows;  // response, then predictors
};

// Files name the lines of their parts: "Starting Values   (lines 41 to 42)".
inline std::vector<std::string> LinesOfPart(const std::vector<std::string>& lines,
                                            const std::string& part) {
  for (const std::string& line : lines) {
    const size_t at = line.find(part);
    const size_t open = line.find("(lines", at == std::string::npos ? 0 : at);
    if (at == std::string::npos || open == std::string::npos) continue;
    int first = 0, last = 0;
    std::sscanf(line.c_str() + open, "(lines %d to %d)", &first, &last);
    return {lines.begin() + first - 1, lines.begin() + last};
  }
  return {};
}

inline NistSet ReadNistSet(const std::string& path, const std::string& name) {
  NistSet set;
  set.name = name;
  std::vector<std::string> lines;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  for (const std::string& line : LinesOfPart(lines, "Starting Values")) {
    std::istringstream words(line);
    std::string label, equals;
    double first, second, value, error;
    words >> label >> equals >> first >> second >> value >> error;
    set.start[0].push_back(first);
    set.start[1].push_back(second);
    set.certified.push_back(value);
    set.certified_error.push_back(error);
  }
  for (const std::string& line : lines) {
    std::sscanf(line.c_str(), "Residual Sum of Squares: %lf", &set.residual_sum);
  }
  for (const std::string& line : LinesOfPart(lines, "Data  ")) {
    std::istringstream words(line);
    std::vector<double> row;
    for (double value; words >> value;) row.push_back(value);
    if (!row.empty()) set.rows.push_back(row);
  }
  return set;
}

// Response minus model. One functor for all, so that Ceres differentiates it by itself.
struct NistResidual {
  const std::string* name;
  const std::vector<double>* row;

  template <typename T>
  bool operator()(T const* const* blocks, T* residual) const {
    using std::isfinite;
    using std::log;
    const double y = (*row)[0];
    const double response = *name == "Nelson" ? log(y) : y;
    residual[0] = response - Model<T>(blocks[0], row->data() + 1);
    return isfinite(residual[0]);  // a step too far: the solver shortens it
  }

  template <typename T>
  T Model(const T* b, const double* predictors) const {
    using std::atan;
    using std::cos;
    using std::exp;
    using std::pow;
    using std::sin;
    const double x = predictors[0];
    const std::string& n = *name;
    if (n == "Bennett5") return b[0] * pow(b[1] + x, -1.0 / b[2]);
    if (n == "BoxBOD" || n == "Misra1a") return b[0] * (1.0 - exp(-b[1] * x));
    if (n == "Chwirut1" || n == "Chwirut2") return exp(-b[0] * x) / (b[1] + b[2] * x);
    if (n == "DanWood") return b[0] * pow(T(x), b[1]);
    if (n == "ENSO") {
      const auto wave = [x](const T& period, const T& c, const T& s) {
        return c * cos(2.0 * M_PI * x / period) + s * sin(2.0 * M_PI * x / period);
      };
      return b[0] + wave(T(12.0), b[1], b[2]) + wave(b[3], b[4], b[5]) + wave(b[6], b[7], b[8]);
    }
    if (n == "Eckerle4") {
      const T z = (x - b[2]) / b[1];
      return b[0] / b[1] * exp(-0.5 * z * z);
    }
    if (n.rfind("Gauss", 0) == 0) {
      const T first = (x - b[3]) / b[4], second = (x - b[6]) / b[7];
      return b[0] * exp(-b[1] * x) + b[2] * exp(-first * first) + b[5] * exp(-second * second);
    }
    if (n == "Hahn1" || n == "Thurber") {
      return (b[0] + x * (b[1] + x * (b[2] + x * b[3]))) /
             (1.0 + x * (b[4] + x * (b[5] + x * b[6])));
    }
    if (n == "Kirby2") return (b[0] + x * (b[1] + x * b[2])) / (1.0 + x * (b[3] + x * b[4]));
    if (n.rfind("Lanczos", 0) == 0) {
      return b[0] * exp(-b[1] * x) + b[2] * exp(-b[3] * x) + b[4] * exp(-b[5] * x);
    }
    if (n == "MGH09") return b[0] * (x * x + x * b[1]) / (x * x + x * b[2] + b[3]);
    if (n == "MGH10") return b[0] * exp(b[1] / (x + b[2]));
    if (n == "MGH17") return b[0] + b[1] * exp(-x * b[3]) + b[2] * exp(-x * b[4]);
    if (n == "Misra1b")
      return b[0] * (1.0 - 1.0 / ((1.0 + b[1] * x / 2.0) * (1.0 + b[1] * x / 2.0)));
    if (n == "Misra1c") return b[0] * (1.0 - pow(1.0 + 2.0 * b[1] * x, -0.5));
    if (n == "Misra1d") return b[0] * b[1] * x / (1.0 + b[1] * x);
    if (n == "Nelson") return b[0] - b[1] * x * exp(-b[2] * predictors[1]);
    if (n == "Rat42") return b[0] / (1.0 + exp(b[1] - b[2] * x));
    if (n == "Rat43") return b[0] / pow(1.0 + exp(b[1] - b[2] * x), 1.0 / b[3]);
    if (n == "Roszman1") return b[0] - b[1] * x - atan(b[2] / (x - b[3])) / M_PI;
    return T(std::nan(""));
  }
};

inline const std::vector<std::string>& NistNames() {
  static const std::vector<std::string> names = {
      "Bennett5", "BoxBOD", "Chwirut1", "Chwirut2", "DanWood",  "ENSO",     "Eckerle4",
      "Gauss1",   "Gauss2", "Gauss3",   "Hahn1",    "Kirby2",   "Lanczos1", "Lanczos2",
      "Lanczos3", "MGH09",  "MGH10",    "MGH17",    "Misra1a",  "Misra1b",  "Misra1c",
      "Misra1d",  "Nelson", "Rat42",    "Rat43",    "Roszman1", "Thurber"};
  return names;
}

}  // namespace pushid
