// datasets: files read in pieces, and hashed.
#include "datasets/files/input_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <utility>

#include "datasets/files/number_text.h"

namespace pushid {
namespace {

constexpr std::size_t kBufferSize = 1 << 18;    // fits a core's second-level cache
constexpr std::size_t kLongestLine = 64 << 20;  // beyond it the file is no text
constexpr std::size_t kTextShown = 512;         // bytes without a zero show a text

// The encoding of a text that is not UTF-8, by its byte order mark, or by the zeros beside its
// first characters; empty for other texts.
std::string_view OtherEncoding(std::string_view text) {
  using namespace std::string_view_literals;
  // UTF-32 before UTF-16, because its mark starts with that of UTF-16.
  constexpr std::pair<std::string_view, std::string_view> kMarks[] = {
      {"\xFF\xFE\0\0"sv, "UTF-32LE"},
      {"\0\0\xFE\xFF"sv, "UTF-32BE"},
      {"\xFF\xFE"sv, "UTF-16LE"},
      {"\xFE\xFF"sv, "UTF-16BE"}};
  for (const auto& [mark, name] : kMarks) {
    if (text.substr(0, mark.size()) == mark) return name;
  }
  std::string zeros;  // of the first four bytes: 0 where there is one, a where there is a character
  for (const char c : text.substr(0, 4)) {
    zeros += c == '\0' ? '0' : c == '\n' || IsBlank(c) || (c >= ' ' && c <= '~') ? 'a' : '?';
  }
  if (zeros == "a000") return "UTF-32LE";
  if (zeros == "000a") return "UTF-32BE";
  if (zeros == "a0a0") return "UTF-16LE";
  if (zeros == "0a0a") return "UTF-16BE";
  return "";
}

// The file that a path means which was written for another system: with \ for /, or in letters of
// another case; empty where there is none.
std::string FileMeant(std::string path) {
  namespace fs = std::filesystem;
  std::replace(path.begin(), path.end(), '\\', '/');
  std::error_code failed;
  fs::path found;
  for (const fs::path& part : fs::path(path)) {
    fs::path next = found / part;
    for (fs::directory_iterator at(found.empty() ? "." : found, failed), end;
         !fs::exists(next, failed) && at != end; at.increment(failed)) {
      const fs::path name = at->path().filename();
      if (EqualsIgnoringCase(name.string(), part.string())) next = found / name;
    }
    if (!fs::exists(next, failed)) return "";
    found = next;
  }
  return found.string();
}

Error NoSuchFile(const std::string& path) {
  std::string message = "there is no such file";
  const std::string meant = FileMeant(path);
  if (!meant.empty()) message += "; did you mean " + meant + "?";
  if (path.find('\\') != std::string::npos) message += "; folders are separated by /, not by \\";
  if (std::any_of(path.begin(), path.end(), [](char c) { return c >= 0 && c < ' '; })) {
    message += "; its name has a control character, which \\b, \\t, \\n, \\f and \\r mean in JSON";
  }
  return {message, path};
}

}  // namespace

MaybeError CheckEncoding(const std::string& path, std::string_view* text) {
  if (const std::string name(OtherEncoding(*text)); !name.empty()) {
    return Error{"this text is encoded as " + name +
                     ", not as UTF-8; save it as UTF-8, or convert it: iconv -f " + name +
                     " -t UTF-8",
                 path, 1};
  }
  const bool archive = text->substr(0, 4) == "PK\3\4";
  if (archive || text->substr(0, kTextShown).find('\0') != std::string_view::npos) {
    return Error{archive ? "this is no text, but a ZIP archive, as spreadsheets (.xlsx, .ods) are; "
                           "save the table as CSV"
                         : "this is no text, but a binary file",
                 path, 1};
  }
  if (text->substr(0, 3) == "\xEF\xBB\xBF") text->remove_prefix(3);
  return std::nullopt;
}

InputFile::InputFile(const std::string& path)
    : InputFile(path, path.empty() ? -1 : ::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
  if (path.empty()) throw Error{"the file name is empty"};
  if (descriptor_ < 0 && errno == ENOENT) throw NoSuchFile(path);
  if (descriptor_ < 0) throw Error{StrCat("cannot open it: ", std::strerror(errno)), path};
  struct stat info {};
  if (::fstat(descriptor_, &info) != 0) return;
  if (S_ISDIR(info.st_mode)) {
    const std::string manifest = path + "/manifest.json";
    const bool there = ::access(manifest.c_str(), R_OK) == 0;
    throw Error{"this is a folder, not a file" + (there ? "; give " + manifest : ""), path};
  }
  if (S_ISREG(info.st_mode)) size_ = info.st_size;
}

InputFile::~InputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

std::size_t InputFile::Read(char* buffer, std::size_t capacity) {
  while (true) {
    const ssize_t count = ::read(descriptor_, buffer, capacity);
    if (count >= 0) return static_cast<std::size_t>(count);
    if (errno != EINTR) throw Error{StrCat("cannot read it: ", std::strerror(errno)), path_};
  }
}

// A small file needs no large buffer; one byte more finds its end.
LineReader::LineReader(const std::string& path) : file_(path) {
  const auto size = static_cast<std::size_t>(file_.size());
  buffer_.resize(size > 0 && size < kBufferSize ? size + 1 : kBufferSize);
}

// Makes more of the file available behind the unread part; false when there is no more.
bool LineReader::Refill() {
  std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
  end_ -= std::exchange(begin_, 0);
  if (end_ == buffer_.size()) {
    if (buffer_.size() >= kLongestLine) {
      throw Error{"a line is longer than 64 MB: this is not a text file of the kind expected",
                  path(), line_number_ + 1};
    }
    buffer_.resize(2 * buffer_.size());
  }
  const std::size_t count = file_.Read(buffer_.data() + end_, buffer_.size() - end_);
  hash_.Add({buffer_.data() + end_, count});
  end_ += count;
  return count > 0;
}

bool LineReader::Next(std::string_view* line) {
  std::size_t length = std::string::npos;
  for (std::size_t searched = 0; length == std::string::npos;) {
    const std::string_view unread(buffer_.data() + begin_, end_ - begin_);
    length = unread.find('\n', searched);
    searched = unread.size();
    if (length == std::string::npos && !Refill()) break;
  }
  if (length == std::string::npos && begin_ == end_) return false;
  ended_in_newline_ = length != std::string::npos;
  *line = {buffer_.data() + begin_, ended_in_newline_ ? length : end_ - begin_};
  begin_ += line->size() + (ended_in_newline_ ? 1 : 0);
  if (!line->empty() && line->back() == '\r') line->remove_suffix(1);
  if (line_number_ == 0) OrThrow(CheckEncoding(path(), line));
  ++line_number_;
  return true;
}

bool LineReader::NextNonBlank(std::string_view* line) {
  while (Next(line)) {
    if (!Trimmed(*line).empty()) return true;
  }
  return false;
}

bool LineReader::NextRow(std::string_view* line) {
  while (NextNonBlank(line)) {
    if (Trimmed(*line).front() != '#') return true;
  }
  return false;
}

// Bytes; a manifest of a million recordings is smaller. /dev/zero would never end.
constexpr std::size_t kLargestText = std::size_t{1} << 28;

Result<std::string> ReadWholeFile(const std::string& path) {
  return Caught([&] {
    InputFile file(path);
    std::string text(file.size() > 0 ? static_cast<std::size_t>(file.size()) + 1 : 1 << 12, '\0');
    for (std::size_t used = 0; true;) {
      if (used >= kLargestText) throw Error{"the file is too large for a text of its kind", path};
      if (used == text.size()) text.resize(2 * text.size());
      const std::size_t count = file.Read(text.data() + used, text.size() - used);
      used += count;
      if (count > 0) continue;
      text.resize(used);
      return text;
    }
  });
}

ContentHash::ContentHash()
    : state_(XXH3_createState(), [](XXH3_state_s* state) { XXH3_freeState(state); }) {
  XXH3_128bits_reset(state_.get());
}

void ContentHash::Add(std::string_view bytes) {
  XXH3_128bits_update(state_.get(), bytes.data(), bytes.size());
}

std::string ContentHash::Hex() const {
  const XXH128_hash_t hash = XXH3_128bits_digest(state_.get());
  char hex[33];
  std::snprintf(hex, sizeof(hex), "%016llx%016llx", static_cast<unsigned long long>(hash.high64),
                static_cast<unsigned long long>(hash.low64));
  return hex;
}

Result<std::string> HashFile(const std::string& path) {
  return Caught([&] {
    InputFile file(path);
    ContentHash hash;
    std::string buffer(1 << 16, '\0');
    while (const std::size_t count = file.Read(buffer.data(), buffer.size())) {
      hash.Add({buffer.data(), count});
    }
    return hash.Hex();
  });
}

}  // namespace pushid
