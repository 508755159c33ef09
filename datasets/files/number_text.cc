// datasets: numbers from and to text, independent of the locale.
#include "datasets/files/number_text.h"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace pushid {
namespace {

constexpr double kLargestPlain = 1e6;

char Lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

// std::from_chars takes a minus but no plus.
std::string_view WithoutPlus(std::string_view token) {
  if (token.size() > 1 && token[0] == '+' && token[1] != '-' && token[1] != '+') {
    token.remove_prefix(1);
  }
  return token;
}

}  // namespace

std::string_view Trimmed(std::string_view text) {
  while (!text.empty() && IsBlank(text.front())) text.remove_prefix(1);
  while (!text.empty() && IsBlank(text.back())) text.remove_suffix(1);
  return text;
}

std::string_view NextToken(std::string_view* text) {
  std::size_t begin = 0;
  while (begin < text->size() && IsBlank((*text)[begin])) ++begin;
  std::size_t end = begin;
  while (end < text->size() && !IsBlank((*text)[end])) ++end;
  const std::string_view token = text->substr(begin, end - begin);
  text->remove_prefix(end);
  return token;
}

bool EqualsIgnoringCase(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (Lower(a[i]) != Lower(b[i])) return false;
  }
  return true;
}

bool ParseDouble(std::string_view token, double* value) {
  token = WithoutPlus(token);
  const char* end = token.data() + token.size();
  const auto [parsed_to, error] = std::from_chars(token.data(), end, *value);
  return error == std::errc() && parsed_to == end && std::isfinite(*value);
}

bool ParseInteger(std::string_view token, std::int64_t* value) {
  token = WithoutPlus(token);
  const char* end = token.data() + token.size();
  const auto [parsed_to, error] = std::from_chars(token.data(), end, *value);
  return error == std::errc() && parsed_to == end;
}

std::string NumberProblem(std::string_view token) {
  const std::string quoted = Quoted(token);
  if (token.empty()) return "a number is missing";
  double value = 0.0;
  token = WithoutPlus(token);
  const char* end = token.data() + token.size();
  const auto [parsed_to, error] = std::from_chars(token.data(), end, value);
  if (parsed_to == end && error == std::errc::result_out_of_range) {
    return quoted + " does not fit in a double";
  }
  if (parsed_to == end && error == std::errc() && !std::isfinite(value)) {
    return quoted + " is not a finite number";
  }
  if (token.find(',') != std::string_view::npos) {
    return quoted + " is not a number (decimals take a point, not a comma)";
  }
  return quoted + " is not a number";
}

std::string Quoted(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  std::string quoted = "'";
  for (char c : text.substr(0, kLongest)) quoted += (c >= 0 && c < ' ') || c == 127 ? '?' : c;
  if (text.size() > kLongest) quoted += "...";
  return quoted + "'";
}

void AppendDouble(double value, std::string* out) {
  char buffer[32];
  if (value == 0.0) value = 0.0;  // no -0: it reads back equal and looks like a mistake
  const auto [end, error] = std::to_chars(buffer, buffer + sizeof(buffer), value);
  out->append(buffer, end);
}

std::string DoubleText(double value) {
  std::string text;
  AppendDouble(value, &text);
  return text;
}

std::string Rounded(double value, int digits) {
  char buffer[64];
  std::snprintf(buffer, sizeof(buffer), "%.*g", digits, value);
  // "1.05e+03" is hard to read: 1050.
  const bool exponent = std::strchr(buffer, 'e') != nullptr;
  if (exponent && std::fabs(value) >= 1.0 && std::fabs(value) < kLargestPlain) {
    std::snprintf(buffer, sizeof(buffer), "%.0f", std::strtod(buffer, nullptr));
  }
  return buffer;
}

}  // namespace pushid
