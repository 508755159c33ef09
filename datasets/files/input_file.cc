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
#include <new>
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

InputFile::~InputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

MaybeError InputFile::Open(const std::string& path) {
  path_ = path;
  if (path.empty()) return Error{"the file name is empty", "", 0};
  descriptor_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor_ < 0) {
    if (errno == ENOENT) return NoSuchFile(path);
    return Error{std::string("cannot open it: ") + std::strerror(errno), path, 0};
  }
  struct stat info {};
  if (::fstat(descriptor_, &info) == 0) {
    if (S_ISDIR(info.st_mode)) {
      const std::string manifest = path + "/manifest.json";
      const bool there = ::access(manifest.c_str(), R_OK) == 0;
      return Error{"this is a folder, not a file" + (there ? "; give " + manifest : ""), path, 0};
    }
    if (S_ISREG(info.st_mode)) size_ = info.st_size;
  }
  return std::nullopt;
}

Result<std::size_t> InputFile::Read(char* buffer, std::size_t capacity) {
  while (true) {
    const ssize_t count = ::read(descriptor_, buffer, capacity);
    if (count >= 0) return static_cast<std::size_t>(count);
    if (errno != EINTR) {
      return Error{std::string("cannot read it: ") + std::strerror(errno), path_, 0};
    }
  }
}

MaybeError LineReader::Open(const std::string& path) {
  error_ = file_.Open(path);
  if (error_) return error_;
  // A small file needs no large buffer; one byte more finds its end.
  const std::int64_t size = file_.size();
  buffer_.resize(size > 0 && size < static_cast<std::int64_t>(kBufferSize)
                     ? static_cast<std::size_t>(size) + 1
                     : kBufferSize);
  return error_;
}

// Makes more of the file available behind the unread part; false when there is no more.
bool LineReader::Refill() {
  if (at_end_ || error_) return false;
  if (begin_ > 0) {
    std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
    end_ -= begin_;
    begin_ = 0;
  }
  if (end_ == buffer_.size()) {
    if (buffer_.size() >= kLongestLine) {
      error_ = Error{"a line is longer than 64 MB: this is not a text file of the kind expected",
                     path(), line_number_ + 1};
      return false;
    }
    buffer_.resize(2 * buffer_.size());
  }
  Result<std::size_t> count = file_.Read(buffer_.data() + end_, buffer_.size() - end_);
  if (!count.ok()) {
    error_ = count.error();
    return false;
  }
  if (count.value() == 0) {
    at_end_ = true;
    return false;
  }
  hash_.Add({buffer_.data() + end_, count.value()});
  end_ += count.value();
  return true;
}

bool LineReader::Next(std::string_view* line) {
  std::size_t searched = 0;  // bytes of the unread part known to hold no newline
  while (true) {
    const char* start = buffer_.data() + begin_;
    const std::size_t available = end_ - begin_;
    const void* newline =
        available > searched ? std::memchr(start + searched, '\n', available - searched) : nullptr;
    if (newline != nullptr) {
      const std::size_t length = static_cast<const char*>(newline) - start;
      *line = {start, length};
      begin_ += length + 1;
      ended_in_newline_ = true;
      break;
    }
    searched = available;
    if (!Refill()) {
      if (error_ || begin_ == end_) return false;
      *line = {buffer_.data() + begin_, end_ - begin_};  // a last line without its newline
      begin_ = end_;
      ended_in_newline_ = false;
      break;
    }
  }
  if (!line->empty() && line->back() == '\r') line->remove_suffix(1);
  if (line_number_ == 0) error_ = CheckEncoding(path(), line);
  if (error_) return false;
  ++line_number_;
  return true;
}

bool LineReader::NextNonBlank(std::string_view* line) {
  while (Next(line)) {
    if (!Trimmed(*line).empty()) return true;
  }
  return false;
}

// Bytes; a manifest of a million recordings is smaller. /dev/zero would never end.
constexpr std::size_t kLargestText = std::size_t{1} << 30;

Result<std::string> ReadWholeFile(const std::string& path) {
  InputFile file;
  if (MaybeError failed = file.Open(path)) return *std::move(failed);
  std::string text;
  std::size_t used = 0;
  text.resize(file.size() > 0 ? static_cast<std::size_t>(file.size()) + 1 : 1 << 12);
  while (true) {
    if (used >= kLargestText) return Error{"the file is too large for a text of its kind", path, 0};
    if (used == text.size()) text.resize(2 * text.size());
    Result<std::size_t> count = file.Read(text.data() + used, text.size() - used);
    if (!count.ok()) return count.error();
    if (count.value() == 0) break;
    used += count.value();
  }
  text.resize(used);
  return text;
}

struct ContentHash::State {
  XXH3_state_t* xxh = XXH3_createState();
  State() {
    if (xxh == nullptr) throw std::bad_alloc();
    XXH3_128bits_reset(xxh);
  }
  ~State() { XXH3_freeState(xxh); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
};

ContentHash::ContentHash() : state_(std::make_unique<State>()) {}
ContentHash::~ContentHash() = default;

void ContentHash::Add(std::string_view bytes) {
  XXH3_128bits_update(state_->xxh, bytes.data(), bytes.size());
}

std::string ContentHash::Hex() const {
  const XXH128_hash_t hash = XXH3_128bits_digest(state_->xxh);
  char hex[33];
  std::snprintf(hex, sizeof(hex), "%016llx%016llx", static_cast<unsigned long long>(hash.high64),
                static_cast<unsigned long long>(hash.low64));
  return hex;
}

Result<std::string> HashFile(const std::string& path) {
  InputFile file;
  if (MaybeError failed = file.Open(path)) return *std::move(failed);
  ContentHash hash;
  std::string buffer(1 << 16, '\0');
  while (true) {
    Result<std::size_t> count = file.Read(buffer.data(), buffer.size());
    if (!count.ok()) return count.error();
    if (count.value() == 0) return hash.Hex();
    hash.Add({buffer.data(), count.value()});
  }
}

}  // namespace pushid
